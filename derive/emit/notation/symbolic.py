"""From a SymPy expression to its layout, in an order that depends on nothing but the symbols."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from sympy import Add, Expr, Mul, Pow, Rational, S, Symbol

from derive.emit.notation.layout import Layout, added, multiplied, name, negative, number, operand
from derive.emit.notation.text import plain
from derive.emit.notation.tree import NotationError
from derive.scene.functions import FUNCTIONS

Names = Mapping[Symbol, str]
Counted = tuple[tuple[str, int], ...]
"""A text as words, and the whole numbers behind them."""
PARTS = re.compile(r"([^0-9]*)([0-9]+|$)")


@dataclass(frozen=True)
class _Writing:
    """How symbols are written, and what has been arranged: terms are sorted by how they read."""

    names: Names
    layouts: dict[Expr, Layout] = field(default_factory=dict)


def symbolic_layout(expression: Expr, names: Names) -> Layout:
    """Return how ``expression`` is written; a symbol without a name keeps its own."""
    return _layout(expression, _Writing(names))


def _layout(expression: Expr, by: _Writing) -> Layout:
    if expression not in by.layouts:
        by.layouts[expression] = _arranged(expression, by)
    return by.layouts[expression]


def _arranged(expression: Expr, by: _Writing) -> Layout:
    if isinstance(expression, Symbol):
        return name(by.names.get(expression, expression.name), "scalar")
    if isinstance(expression, Rational):
        return number(Fraction(expression.p, expression.q))
    if expression is S.Pi:
        return name("pi", "scalar")
    if isinstance(expression, Add):
        return _sum(expression, by)
    if isinstance(expression, Mul | Pow):
        return _product(expression, by)
    if expression.func.__name__ in FUNCTIONS:
        inside = _layout(expression.args[0], by)
        return Layout("call", (inside,), expression.func.__name__)
    known = ", ".join(FUNCTIONS)
    raise NotationError(f"the notation reads sums, products, powers, {known}; not '{expression}'")


def _sum(expression: Add, by: _Writing) -> Layout:
    """Return the terms, short ones first, beginning with one that has no minus."""
    terms = sorted(expression.args, key=lambda term: _term_key(term, by))
    parts = [_layout(term, by) for term in terms]
    first = next((i for i, part in enumerate(parts) if part.kind != "negative"), 0)
    return added([parts[first], *parts[:first], *parts[first + 1 :]])


def _term_key(term: Expr, by: _Writing) -> tuple[int, list[Counted], Counted]:
    factors = [f for f in Mul.make_args(term) if not isinstance(f, Rational)]
    text = plain(_layout(term, by))
    return sum(map(_degree, factors)), sorted(counted(_first(f)) for f in factors), counted(text)


def counted(text: str) -> Counted:
    """Return what a text is ordered by: digits in it as the numbers that they are.

    >>> sorted(["k10", "k9", "k"], key=counted)
    ['k', 'k9', 'k10']
    """
    return tuple((words, int(digits or 0)) for words, digits in PARTS.findall(text))


def _degree(factor: Expr) -> int:
    """Return how many symbols and functions a factor multiplies; of a sum, the most of any term."""
    if isinstance(factor, Add):
        return max(sum(map(_degree, Mul.make_args(term))) for term in factor.args)
    if isinstance(factor, Pow) and factor.exp.is_Integer:
        return _degree(factor.base) * abs(int(factor.exp))
    return 0 if isinstance(factor, Rational) else 1


def _first(factor: Expr) -> str:
    return min((symbol.name for symbol in factor.free_symbols), default="")


def _product(expression: Expr, by: _Writing) -> Layout:
    """Return numbers, then symbols, then functions; what has a negative exponent stands below."""
    coefficient, rest = expression.as_coeff_Mul()
    above: list[Layout] = []
    below: list[Layout] = []
    for factor in sorted(Mul.make_args(rest), key=lambda f: _factor_key(f, by)):
        sign, base, exponent = _turned(factor)
        coefficient *= sign
        under = exponent.is_Rational and exponent < 0
        power = _power(base, -exponent if under else exponent, by)
        (below if under else above).append(power)
    value = Fraction(coefficient.p, coefficient.q)
    if not below:
        return multiplied([number(value), *above])
    top = multiplied([number(Fraction(abs(value.numerator))), *above])
    bottom = multiplied([number(Fraction(value.denominator)), *below])
    whole = Layout("fraction", (top, bottom))
    return negative(whole) if value < 0 else whole


def _factor_key(factor: Expr, by: _Writing) -> tuple[bool, Counted, Counted]:
    base, exponent = factor.as_base_exp()
    size = abs(exponent) if exponent.is_Rational else exponent
    text = plain(_power(base, size, by))
    return base.func.__name__ in FUNCTIONS, counted(_first(factor)), counted(text)


def _turned(factor: Expr) -> tuple[int, Expr, Expr]:
    """Return sign, base and exponent of a factor; of a sum of minus signs only, with plus signs."""
    base, exponent = factor.as_base_exp()
    whole = isinstance(base, Add) and exponent.is_Integer
    if whole and all(term.as_coeff_Mul()[0] < 0 for term in base.args):
        return -1 if exponent.is_odd else 1, -base, exponent
    return 1, base, exponent


def _power(base: Expr, exponent: Expr, by: _Writing) -> Layout:
    inside = _layout(base, by)
    if exponent == 1:
        return inside
    if exponent == S.Half:
        return Layout("call", (inside,), "sqrt")
    if not exponent.is_Rational:
        raise NotationError(f"the notation reads powers of a number, not '{base}**{exponent}'")
    return Layout("power", (operand(inside), _layout(exponent, by)))
