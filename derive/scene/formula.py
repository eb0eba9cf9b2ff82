"""A formula of a scene: an exact tree that only ``derive.scene.grammar.parse`` makes from text.

Constants fold and zeros vanish while the tree is built, so that ``0`` is always the number 0 and
nothing downstream has to guess. Python never evaluates a formula's text.
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from mpmath import mp, mpf

from derive.scene.functions import FUNCTIONS, PLAIN

LARGEST_EXPONENT = 16
LARGEST_NUMBER_BITS = 4096

Arithmetic = Mapping[str, Callable[..., Any]]


class FormulaError(ValueError):
    """A text that is no formula, or a formula that has no value."""


@dataclass(frozen=True)
class Formula:
    """A number, a symbol or an operator on formulas; ``power`` has its exponent in ``number``.

    written : its text in the scene, "" if it does not stand there; formulas are the same without
    """

    operator: str
    operands: tuple[Formula, ...] = ()
    name: str = ""
    number: Fraction = Fraction(0)
    written: str = field(default="", compare=False)

    def __str__(self) -> str:
        return _text(self)[0]

    @property
    def as_written(self) -> str:
        """Return its text as the user wrote it, where it stands in the scene."""
        return self.written or str(self)

    def __add__(self, other: Formula) -> Formula:
        if self == ZERO or other == ZERO:
            return other if self == ZERO else self
        if _numbers(self, other):
            return number(self.number + other.number)
        return Formula("add", (self, other))

    def __sub__(self, other: Formula) -> Formula:
        if self == ZERO or other == ZERO:
            return -other if self == ZERO else self
        if _numbers(self, other):
            return number(self.number - other.number)
        return Formula("sub", (self, other))

    def __neg__(self) -> Formula:
        if self.operator == "number":
            return number(-self.number)
        return self.operands[0] if self.operator == "neg" else Formula("neg", (self,))

    def __mul__(self, other: Formula) -> Formula:
        if ZERO in (self, other):
            return ZERO
        if ONE in (self, other):
            return other if self == ONE else self
        if _numbers(self, other):
            return number(self.number * other.number)
        return Formula("mul", (self, other))

    def __truediv__(self, other: Formula) -> Formula:
        if other == ZERO:
            raise FormulaError("divides by zero")
        if self == ZERO or other == ONE:
            return self
        if _numbers(self, other):
            return number(self.number / other.number)
        return Formula("div", (self, other))

    def __pow__(self, exponent: int) -> Formula:
        if abs(exponent) > LARGEST_EXPONENT:
            raise FormulaError(f"exponent {exponent} is beyond {LARGEST_EXPONENT}")
        if exponent == 0 or (self == ZERO and exponent < 0):
            if self == ZERO:
                raise FormulaError(f"0^{exponent} has no value")
            return ONE
        if exponent == 1 or self in (ZERO, ONE):
            return self
        if self.operator == "number":
            return number(self.number**exponent)
        return Formula("power", (self,), number=Fraction(exponent))


def number(value: int | Fraction) -> Formula:
    """Return an exact number as a formula."""
    exact = Fraction(value)
    if max(exact.numerator.bit_length(), exact.denominator.bit_length()) > LARGEST_NUMBER_BITS:
        raise FormulaError(f"a number has more than {LARGEST_NUMBER_BITS} bits")
    return Formula("number", number=exact)


def symbol(name: str) -> Formula:
    """Return a symbol as a formula."""
    return Formula("symbol", name=name)


def apply(function: str, operand: Formula) -> Formula:
    """Return a function of a formula; its value at 0 and exact square roots fold."""
    if operand == ZERO:
        return number(FUNCTIONS[function].at_zero)
    if function == "sqrt" and operand.operator == "number":
        root = _exact_root(operand.number)
        return Formula("sqrt", (operand,)) if root is None else number(root)
    return Formula(function, (operand,))


def _exact_root(value: Fraction) -> Fraction | None:
    if value < 0:
        raise FormulaError(f"the square root of {value} has no value")
    root = Fraction(math.isqrt(value.numerator), math.isqrt(value.denominator))
    return root if root**2 == value else None


def _numbers(left: Formula, right: Formula) -> bool:
    return left.operator == right.operator == "number"


PI = Fraction(
    "3.14159265358979323846264338327950288419716939937510"
    "58209749445923078164062862089986280348253421170679"
)
ZERO = Formula("number")
ONE = Formula("number", number=Fraction(1))


def symbols(formula: Formula) -> tuple[str, ...]:
    """Return the names of a formula's symbols, in order of first appearance."""
    if formula.operator == "symbol":
        return (formula.name,)
    return tuple(dict.fromkeys(name for part in formula.operands for name in symbols(part)))


def substitute(formula: Formula, values: Mapping[str, Formula]) -> Formula:
    """Return the formula with symbols replaced by formulas; others stay as they are."""
    if formula.operator == "symbol":
        return values.get(formula.name, formula)
    return _build(formula, [substitute(part, values) for part in formula.operands])


def _build(formula: Formula, parts: list[Formula]) -> Formula:
    if formula.operator in FUNCTIONS:
        return apply(formula.operator, parts[0])
    if formula.operator == "power":
        return parts[0] ** int(formula.number)
    made: Formula = PLAIN[formula.operator](*parts) if parts else formula
    return made


def evaluate(formula: Formula, values: Mapping[str, Any], arithmetic: Arithmetic) -> Any:
    """Return the formula's value; ``arithmetic`` maps each operator, and "number", to a function.

    "number" takes the exact fraction, "power" the base and an int. ``FLOATS`` is one arithmetic.
    The symbol pi is that number to a hundred digits, if the values hold none that is better.

    >>> evaluate(symbol("x") ** 2 - number(1), {"x": 1.5}, FLOATS)
    1.25
    """
    if formula.operator == "symbol":
        known = formula.name in values or formula.name != "pi"
        return values[formula.name] if known else arithmetic["number"](PI)
    if formula.operator == "number":
        return arithmetic["number"](formula.number)
    parts = [evaluate(part, values, arithmetic) for part in formula.operands]
    if formula.operator == "power":
        return arithmetic["power"](parts[0], int(formula.number))
    return arithmetic[formula.operator](*parts)


FLOATS: Arithmetic = {
    "number": float,
    **PLAIN,
    "power": operator.pow,
    **{name: function.floats for name, function in FUNCTIONS.items()},
}

_WIDE: Arithmetic = {
    **FLOATS,
    "number": lambda exact: mpf(exact.numerator) / exact.denominator,
    "sqrt": lambda x: math.sqrt(x) if x < 0 else mp.sqrt(x),
}
"""Numbers of 53 bits and of any size, for what is beyond floats on the way to its value."""


def in_floats(formula: Formula, values: Mapping[str, float]) -> Any:
    """Return a formula's value, nan where it has none; beyond floats it is a number of mpmath's.

    >>> x, large = symbol("x"), number(10**300)
    >>> print(in_floats(x * large * large, {"x": 2.0}))
    2.0e+600
    """
    found = _tried(formula, values, FLOATS)
    if formula.operator != "number" and (found == 0 or not math.isfinite(found)):
        wide = _tried(formula, {name: mpf(x) for name, x in values.items()}, _WIDE)
        found = float(wide)
        return found if math.isfinite(found) and (found != 0) == (wide != 0) else wide
    return found


def _tried(formula: Formula, values: Mapping[str, Any], arithmetic: Arithmetic) -> Any:
    try:
        return evaluate(formula, values, arithmetic)
    except (ArithmeticError, ValueError):
        return math.nan


_LONG_TAIL = re.compile("(?<=[0-9])0{16,300}$")
_SUM, _PRODUCT, _SIGNED, _POWER, _ATOM = range(5)
_SIGNS = {
    "add": (" + ", _SUM),
    "sub": (" - ", _SUM),
    "mul": ("*", _PRODUCT),
    "div": ("/", _PRODUCT),
}


def _text(formula: Formula) -> tuple[str, int]:
    """Return the formula as text that ``parse`` reads back, and how tightly it binds."""
    if formula.operator == "number":
        value = formula.number
        binding = _SIGNED if value < 0 else _ATOM
        return _digits(value), binding if value.denominator == 1 else _PRODUCT
    if formula.operator == "symbol":
        return formula.name, _ATOM
    if formula.operator in FUNCTIONS:
        return f"{formula.operator}({formula.operands[0]})", _ATOM
    if formula.operator == "neg":
        return "-" + _wrapped(formula.operands[0], _SIGNED), _SIGNED
    if formula.operator == "power":
        return f"{_wrapped(formula.operands[0], _ATOM)}^{formula.number}", _POWER
    sign, binding = _SIGNS[formula.operator]
    left, right = formula.operands
    return _wrapped(left, binding) + sign + _wrapped(right, binding + 1), binding


def _digits(value: Fraction) -> str:
    """Return a number as ``parse`` reads it back, many zeros at its end as a power of ten."""
    parts = [str(value.numerator), str(value.denominator)][: 1 if value.denominator == 1 else 2]
    return "/".join(_LONG_TAIL.sub(lambda zeros: f"e{len(zeros[0])}", part) for part in parts)


def _wrapped(formula: Formula, binding: int) -> str:
    text, own = _text(formula)
    return text if own >= binding else f"({text})"
