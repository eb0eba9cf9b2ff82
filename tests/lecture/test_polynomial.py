"""Expressions are multiplied out as SymPy does it, whatever they hold."""

from collections.abc import Sequence
from functools import reduce
from operator import add, mul

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import Expr, Pow, Rational, cos, expand, sin, sqrt, srepr, symbols

from derive.lecture import polynomial
from derive.lecture.polynomial import without_brackets
from derive.lecture.turning import reduced

A, B = symbols("a b")
WAVES = (sin(A), cos(A), sin(A + B), cos(A - B / 2), sin(B))
LEAVES = (A, B, *WAVES, Rational(2, 3), Rational(-3))


def combined(each: st.SearchStrategy[Expr]) -> st.SearchStrategy[Expr]:
    """Return sums, products and powers of expressions."""
    several = st.lists(each, min_size=2, max_size=3)
    return st.one_of(
        several.map(lambda x: reduce(add, x)),
        several.map(lambda x: reduce(mul, x)),
        st.tuples(each, st.integers(2, 3)).map(lambda x: x[0] ** x[1]),
    )


EXPRESSIONS = st.recursive(st.sampled_from(LEAVES), combined, max_leaves=7)


def by_rules(expression: Expr) -> Expr:
    """Return an expression multiplied out with sin^2 = 1 - cos^2, by SymPy's rules alone."""
    lowered = expand(expression).replace(
        lambda e: isinstance(e, Pow) and isinstance(e.base, sin) and e.exp > 1,
        lambda e: (1 - cos(e.base.args[0]) ** 2) ** (e.exp // 2) * e.base ** (e.exp % 2),
    )
    return expand(lowered)


@settings(deadline=None, max_examples=60)
@given(EXPRESSIONS)
def test_polynomials_are_multiplied_out_as_by_rules(expression: Expr) -> None:
    assert srepr(without_brackets(expression)) == srepr(expand(expression))
    assert srepr(reduced(expression)) == srepr(by_rules(expression))


@pytest.mark.parametrize(
    "expression",
    [(A + B) * (A - 1) / (1 + A), sqrt(A) * (A + 1), sin(A * (B + 1)) * (A + 1), A**B * (1 + A)],
    ids=str,
)
def test_what_is_no_polynomial_is_left_to_rules(expression: Expr) -> None:
    assert without_brackets(expression) == expand(expression)


def test_more_terms_than_are_asked_for_are_not_written() -> None:
    value = (A + B) * (1 + sin(A)) * (1 - sin(A))
    assert reduced(value, 2) == A * cos(A) ** 2 + B * cos(A) ** 2
    assert reduced(value, 1) == value


def test_a_product_that_forgets_terms_would_be_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = polynomial._product

    def forgets(each: Sequence[polynomial.WithoutBrackets]) -> polynomial.WithoutBrackets:
        return dict([*whole(each).items()][1:])

    monkeypatch.setattr(polynomial, "_product", forgets)
    assert without_brackets((A + B) ** 2) != expand((A + B) ** 2)
