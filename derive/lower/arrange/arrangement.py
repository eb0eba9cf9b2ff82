"""Definitions as they are found: what is computed on the way, each with a name."""

from dataclasses import dataclass, field

from sympy import Expr, Symbol

from derive.mechanics.implied import Implied as Implied

BY_BALANCES = "balances"
"""The way that stays where no other takes fewer operations."""


@dataclass(frozen=True)
class Definition:
    """One named value: a let may be multiplied out by its users, a cut may not.

    family : what components of one vector or tensor share, in words of this program's own; a value
             that has none is a family of its own, whatever a scene calls it
    """

    kind: str
    symbol: Symbol
    value: Expr
    family: str = ""


@dataclass(frozen=True)
class Arrangement:
    """Definitions in order, and the output components.

    by      : the way that they were found
    implied : what slopes of solved unknowns follow from, if that is known
    """

    definitions: tuple[Definition, ...]
    outputs: tuple[Expr, ...]
    by: str = BY_BALANCES
    implied: Implied | None = field(default=None, compare=False)
