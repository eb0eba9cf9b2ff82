"""Expressions taken apart and put together: their names, and the sum of terms that they are."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product

from derive.lecture.vectors import IDENTITY, Expression, number, zero

_MULTILINEAR = (
    *("scale", "dot", "cross", "apply", "outer", "cross_tensor", "transpose", "trace", "axial"),
    *("component", "quantity", "sum", "others"),
)


@dataclass(frozen=True)
class Summand:
    """``factor`` times ``ordered``, alike for equal terms, or times ``written``, as it was."""

    factor: Fraction
    ordered: Expression
    written: Expression


def symbols(expression: Expression) -> tuple[str, ...]:
    """Return the names of the symbols of ``expression``, each once, in reading order.

    >>> from derive.lecture.vectors import cross, vector
    >>> symbols(cross(vector("omega"), vector("l")) + vector("l"))
    ('omega', 'l')
    """
    if expression.operator in ("symbol", "inertia"):
        return (expression.name,)
    return tuple(dict.fromkeys(name for each in expression.operands for name in symbols(each)))


def rebuilt(expression: Expression, change: Callable[[Expression], Expression]) -> Expression:
    """Return ``expression`` with every operand changed."""
    operands = tuple(change(operand) for operand in expression.operands)
    if operands == expression.operands:
        return expression
    return Expression(
        expression.operator, operands, expression.shape, expression.name, expression.number
    )


def renamed(expression: Expression, names: Mapping[str, str]) -> Expression:
    """Return ``expression`` with symbols, and what sums run over, renamed."""
    inside = rebuilt(expression, lambda operand: renamed(operand, names))
    if expression.operator not in ("symbol", "inertia", "sum"):
        return inside
    name = names.get(expression.name, expression.name)
    return Expression(inside.operator, inside.operands, inside.shape, name, inside.number)


def terms(expression: Expression) -> list[Summand]:
    """Return the terms that ``expression`` is the sum of, every product multiplied out."""
    if expression.operator == "zero":
        return []
    if expression.operator == "number":
        return [Summand(expression.number, number(1), number(1))]
    if expression.operator == "add":
        return [term for operand in expression.operands for term in terms(operand)]
    if expression.operator == "negate":
        return [replace(term, factor=-term.factor) for term in terms(expression.operands[0])]
    if expression.operator not in _MULTILINEAR:
        return [Summand(Fraction(1), expression, expression)]
    products = product(*map(terms, expression.operands))
    return [term for chosen in products if (term := _product(expression, chosen)).factor]


def _product(expression: Expression, chosen: tuple[Summand, ...]) -> Summand:
    """Return one term of a product, as it is written and with its factors in one order."""
    factor, sign = Fraction(1), 1
    for each in chosen:
        factor *= each.factor
        sign *= -1 if each.written.operator == "negate" else 1
    operands = tuple(each.ordered for each in chosen)
    if expression.operator in ("cross", "dot") and repr(operands[1]) < repr(operands[0]):
        operands = operands[::-1]
        if expression.operator == "cross":
            factor, sign = -factor, -sign
    if expression.operator == "cross" and operands[0] == operands[1]:
        factor = Fraction(0)
    written = _without_one(expression, tuple(_positive(each.written) for each in chosen))
    return Summand(factor, _without_one(expression, operands), -written if sign < 0 else written)


def _positive(written: Expression) -> Expression:
    return written.operands[0] if written.operator == "negate" else written


def _without_one(expression: Expression, operands: tuple[Expression, ...]) -> Expression:
    """Return a product without the factor 1."""
    if expression.operator == "scale" and number(1) in operands:
        return operands[0] if operands[1] == number(1) else operands[1]
    if expression.operator == "apply" and operands[0] == IDENTITY:
        return operands[1]
    return Expression(expression.operator, operands, expression.shape, expression.name)


def collected(expression: Expression) -> Expression:
    """Return ``expression`` as a sum of different terms; what cancels is gone.

    >>> from derive.lecture.vectors import cross, vector
    >>> a, b = vector("a"), vector("b")
    >>> collected(cross(a, b) + cross(b, a)).operator
    'zero'
    """
    factors: dict[Expression, Fraction] = {}
    written: dict[Expression, Expression] = {}
    for term in terms(expression):
        factors[term.ordered] = factors.get(term.ordered, Fraction(0)) + term.factor
        written.setdefault(term.ordered, term.written)
    kept = [_times(factor, written[term]) for term, factor in factors.items() if factor]
    return summed(kept, expression.shape)


def size(expression: Expression) -> int:
    """Return how many symbols and operators ``expression`` is made of."""
    return 1 + sum(map(size, expression.operands))


def summed(parts: list[Expression], shape: tuple[int, ...]) -> Expression:
    """Return the sum of ``parts``, the zero of ``shape`` if there are none."""
    if not parts:
        return zero(*shape)
    first, *rest = parts
    for part in rest:
        first = first + part
    return first


def _times(factor: Fraction, term: Expression) -> Expression:
    """Return a multiple of a term; a minus inside the term is taken out."""
    if term.operator == "negate":
        factor, term = -factor, term.operands[0]
    if abs(factor) != 1:
        term = number(abs(factor)) * term
    return -term if factor < 0 else term
