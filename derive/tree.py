"""Expressions taken apart and put together: their names, renaming, and the sum of terms they are."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from itertools import product

from derive.vectors import Expression, number, zero

Term = tuple[Fraction, Expression]
_ADDITIVE = ("add", "negate")
_MULTILINEAR = (
    *("scale", "dot", "cross", "apply", "outer", "cross_tensor", "transpose", "trace", "axial"),
    *("component", "quantity", "sum", "others"),
)


def symbols(expression: Expression) -> tuple[str, ...]:
    """Return the names of the symbols of ``expression``, each once, in reading order.

    >>> from derive.vectors import cross, vector
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


def terms(expression: Expression) -> list[Term]:
    """Return the terms that ``expression`` is the sum of, every product multiplied out."""
    if expression.operator == "zero":
        return []
    if expression.operator == "number":
        return [(expression.number, number(1))]
    if expression.operator == "add":
        return [term for operand in expression.operands for term in terms(operand)]
    if expression.operator == "negate":
        return [(-factor, term) for factor, term in terms(expression.operands[0])]
    if expression.operator not in _MULTILINEAR:
        return [(Fraction(1), expression)]
    return [
        _ordered(expression, chosen) for chosen in product(*map(terms, expression.operands))
    ]


def _ordered(expression: Expression, chosen: tuple[Term, ...]) -> Term:
    """Return one term of a product; its factors stand in one order, so that equal terms look equal."""
    factor = Fraction(1)
    for each, _ in chosen:
        factor *= each
    operands = tuple(term for _, term in chosen)
    if expression.operator == "scale" and number(1) in operands:
        return factor, operands[0] if operands[1] == number(1) else operands[1]
    if expression.operator in ("cross", "dot") and repr(operands[1]) < repr(operands[0]):
        operands = operands[::-1]
        factor = -factor if expression.operator == "cross" else factor
    if expression.operator == "cross" and operands[0] == operands[1]:
        factor = Fraction(0)
    return factor, Expression(expression.operator, operands, expression.shape, expression.name)


def collected(expression: Expression) -> Expression:
    """Return ``expression`` as a sum of different terms; what cancels is gone.

    >>> from derive.vectors import cross, vector
    >>> a, b = vector("a"), vector("b")
    >>> collected(cross(a, b) + cross(b, a)).operator
    'zero'
    """
    factors: dict[Expression, Fraction] = {}
    for factor, term in terms(expression):
        factors[term] = factors.get(term, Fraction(0)) + factor
    kept = [(factor, term) for term, factor in factors.items() if factor]
    return summed([_times(factor, term) for factor, term in kept], expression.shape)


def summed(parts: list[Expression], shape: tuple[int, ...]) -> Expression:
    """Return the sum of ``parts``, the zero of ``shape`` if there are none."""
    if not parts:
        return zero(*shape)
    first, *rest = parts
    for part in rest:
        first = first + part
    return first


def _times(factor: Fraction, term: Expression) -> Expression:
    if abs(factor) != 1:
        term = number(abs(factor)) * term
    return -term if factor < 0 else term
