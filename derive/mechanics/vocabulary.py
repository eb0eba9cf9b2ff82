"""What a scene's quantities are called: parameters, states, inputs and outputs, in canonical order.

Every component has a SymPy symbol named by its place, not by the user's word for it, so nothing
that SymPy does can depend on how the user calls things.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import sympy
from sympy import Abs, Expr, Matrix, Rational, Symbol, pi

from derive.program.program import Quantity
from derive.scene import SceneError
from derive.scene.escape import brief
from derive.scene.formula import Formula
from derive.scene.functions import FUNCTIONS, PLAIN

LARGEST_FLOAT = (2 - 2.0**-23) * 2.0**127


@dataclass(frozen=True)
class Vocabulary:
    """The quantities of a scene by role; an input of one function may be an output of another."""

    parameters: tuple[Quantity, ...]
    states: tuple[Quantity, ...]
    inputs: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    numbers: Mapping[str, Fraction]
    symbols: Mapping[str, Symbol] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Quantity:
        for q in self.every():
            if q.name == name:
                return q
        raise KeyError(f"no quantity of the scene is called '{name}'")

    def __contains__(self, name: str) -> bool:
        return any(q.name == name for q in self.every())

    def every(self) -> tuple[Quantity, ...]:
        """Return all quantities, parameters first."""
        return self.given() + self.outputs

    def given(self) -> tuple[Quantity, ...]:
        """Return the quantities that a function may be given: parameters, states, inputs."""
        return self.parameters + self.states + self.inputs

    def fixed(self) -> frozenset[Symbol]:
        """Return the symbols of all parameters."""
        return frozenset(self.symbols[c] for q in self.parameters for c in q.components)

    def column(self, name: str) -> Matrix:
        """Return the symbols of a quantity's components as a column."""
        return Matrix([self.symbols[c] for c in self[name].components])

    def expression(self, formula: Formula) -> Expr:
        """Return a scene's formula in these symbols."""
        if formula.operator == "symbol" and formula.name == "pi":
            return pi
        if formula.operator == "symbol":
            number = self.numbers.get(formula.name)
            return self.symbols[formula.name] if number is None else rational(number)
        if formula.operator == "number":
            return rational(formula.number)
        if formula.operator == "power":
            return self.expression(formula.operands[0]) ** rational(formula.number)
        found = _OPERATORS[formula.operator](*map(self.expression, formula.operands))
        if formula.operator == "sqrt" and found.has(Abs):
            rule = "is of a square, so that its sign is lost and its slope jumps"
            raise SceneError(f"the root '{brief(formula)}' {rule}; write it without the root")
        return found


def require_floats(quantities: Iterable[Quantity]) -> None:
    """Refuse a range whose ends are beyond the smaller of the float types."""
    for q in quantities:
        end = max(abs(float(q.low or 0)), abs(float(q.high or 0)))
        if end > LARGEST_FLOAT:
            rule = f"must fit a float, up to 3.4e38, not {end:.3g}"
            raise SceneError(f"the range of '{q.name}' {rule}")


def rational(value: Fraction) -> Rational:
    """Return an exact number as SymPy's."""
    return Rational(value.numerator, value.denominator)


_OPERATORS: Mapping[str, Any] = {
    **PLAIN,
    **{name: getattr(sympy, name) for name in FUNCTIONS},
}
"""SymPy calls its functions as a formula does."""
