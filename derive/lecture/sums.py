"""A sum over particles is a linear map: one generic particle proves a step for every body.

Two summands that are equal as polynomials in what differs from particle to particle have equal
sums. So ``reading`` writes a sum in its values on the monomials, symbols such as
``sum_body(dm_i*rho_i_x)``: mass, first and second moments are such values.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from sympy import Add, Expr, Matrix, Symbol, expand

from derive.lecture.vectors import AXES, Expression, combine, components

# What belongs to one particle carries its index; j is another particle, ij and ji a pair.
_OF_A_PARTICLE = re.compile(r"_(i|j|ij|ji)(_|$)")
_SWAP = {"i": "j", "j": "i", "ij": "ji", "ji": "ij"}
# What belongs to one wheel of a gyrostat; no index, since a wheel is most often spoken of alone.
_WHEEL = ("a", "d", "C", "A_w", "s", "u", "l_w", "I_w", "K_w", "h_w", "T_w", "D")
_ENDINGS = ("", *(f"_{axis}" for axis in AXES), *(f"_{p}{q}" for p in AXES for q in AXES))
_OF_A_WHEEL = frozenset(
    f"{name}{dots}{end}"
    for name in _WHEEL
    for dots in ("", "_dot", "_ddot", "_N_dot")
    for end in _ENDINGS
)
_OTHERS = Symbol("others")


def others(summand: Expression) -> Expression:
    """Return the sum of ``summand`` over every particle j other than i."""
    return Expression("others", (summand,), summand.shape)


def reading(expression: Expression, bindings: Mapping[str, Any] | None = None) -> Any:
    """Return the components of ``expression``, its sums over particles read as linear maps.

    >>> from derive.lecture.vectors import number, scalar, total
    >>> reading(total(number(3) * scalar("dm_i") + scalar("dm_i")))
    4*sum_body(dm_i)
    """
    bound = bindings or {}
    if not expression.operands:
        return components(expression, bound)
    if expression.operator == "sum":
        return _sum(expression, bound)
    operands = [reading(operand, bound) for operand in expression.operands]
    if expression.operator == "others":
        return _OTHERS * operands[0]
    return combine(expression, operands)


def _sum(expression: Expression, bound: Mapping[str, Any]) -> Any:
    """Read a sum; what is summed over the others too becomes a sum over pairs i < j."""
    over, summand = expression.name, expression.operands[0]
    read = reading(summand, bound)
    if not expanded(read).has(_OTHERS):
        return each(read, lambda entry: linear_map(entry, over))
    swapped = reading(swap(summand), bound)
    alone = each(read, lambda entry: linear_map(entry.coeff(_OTHERS, 0), over))
    pair = each(read, _with_others) + each(swapped, _with_others)
    return alone + each(pair, lambda entry: linear_map(entry, "pairs"))


def _with_others(entry: Expr) -> Expr:
    if entry.coeff(_OTHERS, 2) != 0:
        raise TypeError(f"a product of two sums over the other particles cannot be read: {entry}")
    return entry.coeff(_OTHERS, 1)


def linear_map(summand: Expr, over: str) -> Expr:
    """Return the sum of ``summand`` over ``over``, written in its values on the monomials."""
    parts = []
    for term in Add.make_args(expand(summand)):
        varying = sorted(filter(lambda s: varies(s.name, over), term.free_symbols), key=str)
        outside, monomial = term.as_independent(*varying, as_Add=False)
        parts.append(outside * Symbol(f"sum_{over}({monomial})", real=True))
    return Add(*parts) if expand(summand) != 0 else summand * 0


def varies(name: str, over: str) -> bool:
    """Return whether a symbol differs between the members of ``over``.

    >>> varies("rho_i_x", "body"), varies("m", "body"), varies("sum_wheel(dm_i)", "wheels")
    (True, False, True)
    """
    if over == "wheels":
        return name in _OF_A_WHEEL or name.startswith("sum_wheel(")
    return not name.startswith("sum_") and bool(_OF_A_PARTICLE.search(name))


def swap(expression: Expression) -> Expression:
    """Return ``expression`` with the particles i and j exchanged."""
    name = _OF_A_PARTICLE.sub(lambda found: f"_{_SWAP[found[1]]}{found[2]}", expression.name)
    operands = tuple(swap(operand) for operand in expression.operands)
    return Expression(expression.operator, operands, expression.shape, name, expression.number)


def each(value: Any, change: Any) -> Any:
    """Apply ``change`` to every expanded entry of a scalar, column or matrix."""
    if isinstance(value, Expr):
        return change(expand(value))
    return value.applyfunc(lambda entry: change(expand(entry)))


def expanded(value: Any) -> Any:
    """Return a scalar, column or matrix with every entry multiplied out."""
    return each(value, lambda entry: entry)


def flattened(value: Any) -> list[Expr]:
    """Return the entries of a scalar, column or matrix, row by row."""
    return list(value) if isinstance(value, Matrix) else [value]
