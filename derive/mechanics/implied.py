"""What slopes of solved unknowns follow from, no solution differentiated: A x' = (b - A x)'.

On the right x is held. The factors of A serve again. Where what is left changes with absolute
angles and speeds of links, its slopes by these are told, and what links have in common that one
link carries is summed once.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from sympy import Expr, Integer, Symbol

from derive.mechanics.links import Drift, Links
from derive.mechanics.mass_matrix import Factors, MassMatrix
from derive.mechanics.recursion import Recursion


@dataclass(frozen=True)
class Turned:
    """An angle of a link on its parent, or its rate; what changes with the absolute one, by what.

    unknown : the acceleration of the angle     parent : its place, below 0 for the base
    """

    unknown: Symbol
    value: Expr
    slopes: Mapping[Symbol, Expr]
    parent: int


@dataclass(frozen=True)
class Implied:
    """The equations that unknowns solve, less what solves them.

    solved : each unknown of the system, as it was found
    left   : b - A x by unknown, made of ``definitions`` and of what is on the way to ``solved``
    angles : of links, parents first, and their rates
    plain  : whether no body makes its factors divide by nothing, whatever way is taken for values
    """

    solved: Mapping[Symbol, Expr]
    left: Mapping[Symbol, Expr]
    factors: Factors
    definitions: Mapping[Symbol, Expr]
    angles: tuple[Turned, ...] = ()
    rates: tuple[Turned, ...] = ()
    plain: bool = True

    def expressions(self) -> tuple[Expr, ...]:
        """Return all that is not on the way to what is solved."""
        turned = (t.value for t in (*self.angles, *self.rates))
        return (*self.left.values(), *self.definitions.values(), *turned)

    def xreplace(self, known: Mapping[Symbol, Expr]) -> "Implied":
        """Return it with symbols replaced."""

        def put(values: Mapping[Symbol, Expr]) -> dict[Symbol, Expr]:
            return {s: e.xreplace(known) for s, e in values.items()}

        angles, rates = (tuple(replace(t, value=t.value.xreplace(known)) for t in kind)
                         for kind in (self.angles, self.rates))  # fmt: skip
        of = self.factors
        below = {pair: e.xreplace(known) for pair, e in of.below.items()}
        factors = Factors(of.order, below, put(of.inverses))
        return Implied(put(self.solved), put(self.left), factors, put(self.definitions),
                       angles, rates, self.plain)  # fmt: skip


def by_passes(machine: Links, own: MassMatrix, found: Mapping[Symbol, Expr]) -> Implied:
    """Return what slopes follow from by the passes of ``recursion``, what was found put in."""
    definitions = dict(own.definitions)
    system = Recursion(_as_found(machine, found), MassMatrix(definitions)).acted()
    fresh = {s: e for s, e in definitions.items() if s not in own.definitions}
    assert own.factors is not None  # noqa: S101
    return Implied(found, system.right, own.factors, fresh)


def _as_found(machine: Links, found: Mapping[Symbol, Expr]) -> Links:
    """Return links that are known to move as was found."""

    def known(drift: Drift) -> Drift:
        rest = drift.rest
        for u, d in drift.slopes.items():
            rest += found[u] * d
        return replace(drift, rest=rest)

    each = tuple(
        replace(k, turning=known(k.turning), drift=known(k.drift) if k.drift else None)
        for k in machine.links
    )
    carried = tuple((m, known(drift)) for m, drift in machine.carried)
    wheels = tuple(replace(w, spinning=known(w.spinning)) for w in machine.wheels)
    return replace(machine, links=each, carried=carried, wheels=wheels)


def by_rows(system: MassMatrix, own: MassMatrix, found: Mapping[Symbol, Expr]) -> Implied:
    """Return the same by the rows of a mass matrix."""
    left = {}
    for u in found:
        row = [e * found[v] for (w, v), e in system.entries.items() if w == u]
        left[u] = system.right.get(u, Integer(0)) - sum(row, Integer(0))
    assert own.factors is not None  # noqa: S101
    return Implied(found, left, own.factors, {})
