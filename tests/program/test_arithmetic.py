"""Pairs of floats hold twice the working precision, whatever cancels."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from derive.program.arithmetic import MANTISSA, extended, power_of_two, rounded

# A pair operation errs by a few squares of u (Joldes, Muller and Popescu 2017): 3 for a sum, less
# than 10 for a product, 15 for the quotient as it is done here.
SQUARES_OF_U = {"add": 3, "sub": 3, "mul": 10, "div": 15}

doubles = st.floats(min_value=-1e60, max_value=1e60, width=64).filter(
    lambda x: x == 0 or abs(x) > 1e-60
)
singles = st.floats(min_value=-1e6, max_value=1e6, width=32).filter(
    lambda x: x == 0 or abs(x) > 1e-6
)


def exact(pair) -> Fraction:
    return Fraction(float(pair[0])) + Fraction(float(pair[1]))


def within(operator: str, dtype: type, a, b) -> bool:
    """Tell whether an operation on two products of floats is within its bound."""
    table = extended(dtype)
    x, y = (table["mul"]((dtype(v), dtype(0)), (dtype(w), dtype(0))) for v, w in (a, b))
    truth = {
        "add": exact(x) + exact(y),
        "sub": exact(x) - exact(y),
        "mul": exact(x) * exact(y),
        "div": exact(x) / exact(y) if exact(y) else Fraction(0),
    }[operator]
    if operator == "div" and not exact(y):
        return True
    u = Fraction(1, 2 ** MANTISSA[dtype])
    return abs(exact(table[operator](x, y)) - truth) <= SQUARES_OF_U[operator] * u**2 * abs(truth)


@pytest.mark.parametrize("operator", SQUARES_OF_U)
@given(st.tuples(doubles, doubles), st.tuples(doubles, doubles))
def test_a_pair_of_doubles_keeps_its_bound(operator, a, b):
    assert within(operator, np.float64, a, b)


@pytest.mark.parametrize("operator", SQUARES_OF_U)
@given(st.tuples(singles, singles), st.tuples(singles, singles))
def test_a_pair_of_singles_keeps_its_bound(operator, a, b):
    assert within(operator, np.float32, a, b)


@given(st.tuples(doubles, doubles))
def test_a_sum_keeps_its_bound_when_everything_cancels(a):
    near = (np.nextafter(a[0], np.inf), a[1])
    assert within("sub", np.float64, a, near)


def test_the_bound_would_notice_a_sum_that_drops_the_low_parts():
    table = extended(np.float64)
    x = table["mul"]((np.float64(1 / 3), np.float64(0)), (np.float64(1 / 7), np.float64(0)))
    sloppy = (x[0] + x[0], np.float64(0))
    assert abs(exact(sloppy) - 2 * exact(x)) > 3 * Fraction(1, 2**106) * abs(2 * exact(x))


@given(st.floats(min_value=1e-30, max_value=1e30, width=64))
def test_the_power_of_two_is_one_and_is_near(x):
    p = power_of_two(np.float64(x), np.float64)
    assert np.frexp(p)[0] == 0.5
    assert 0.5 <= x / p <= 2


@given(st.fractions(min_value=-100, max_value=100, max_denominator=10**9))
def test_a_fraction_is_rounded_once_to_single(q):
    found = rounded(q, np.float32)
    neighbours = [np.nextafter(found, np.float32(s)) for s in (-np.inf, np.inf)]
    error = abs(Fraction(float(found)) - q)
    assert all(error <= abs(Fraction(float(n)) - q) for n in neighbours)
