"""Stages as they are found: what is computed on the way, each with a name."""

from dataclasses import dataclass

from sympy import Expr, Matrix, Symbol

from derive.mechanics.specialise import Specialised


@dataclass(frozen=True)
class Stage:
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
    """Stages in order, and the output components."""

    stages: tuple[Stage, ...]
    outputs: tuple[Expr, ...]


@dataclass
class Draft:
    """Stages as they are found."""

    known: Specialised
    stages: list[Stage]

    def named(self, kind: str, name: str, value: Expr, family: str = "") -> Expr:
        """Return a symbol for ``value``, unless it is plain already; ``name`` is no scene's.

        family : what it shares with others, such as the vector whose component it is
        """
        if value.is_Symbol or value.is_Number or (-value).is_Symbol:
            return value
        symbol = Symbol(name, real=True)
        taken = {stage.symbol for stage in self.stages}
        while symbol in taken:
            symbol = Symbol(f"{symbol.name}'", real=True)
        self.stages.append(Stage(kind, symbol, value, family))
        return symbol

    def column(self, kind: str, name: str, values: Matrix) -> Matrix:
        """Return ``values`` with every component named."""
        labels = [f"{name}_{axis}" for axis in "xyz"]
        if values.shape == (3, 3):
            labels = [f"{name}_{a}{b}" for a in "xyz" for b in "xyz"]
        named = [
            self.named(kind, label, value, name)
            for label, value in zip(labels, values, strict=True)
        ]
        return Matrix(*values.shape, named)


def symmetric(draft: Draft, name: str, tensor: Matrix, family: str) -> Matrix:
    """Return a symmetric tensor with its six entries named, all of one family."""
    upper = {
        (i, k): draft.named("let", f"{name}_{'xyz'[i]}{'xyz'[k]}", tensor[i, k], family)
        for i in range(3)
        for k in range(i, 3)
    }
    return Matrix(3, 3, lambda i, k: upper[min(i, k), max(i, k)])
