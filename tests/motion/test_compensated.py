"""A sum that keeps its rounding remainder is a sum of twice the digits."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from derive.motion.compensated import compensated_add
from derive.program.arithmetic import MANTISSA, working
from derive.program.operations import splitter
from derive.program.pairs import two_product
from derive.program.program import Program, Quantity
from derive.program.recorded import needed
from derive.program.run import run
from derive.program.tape import Tape, number

PRECISIONS = (np.float64, np.float32)
STATES = st.floats(min_value=0.5, max_value=2, width=32)
PARTS = st.floats(min_value=-0.25, max_value=0.25, width=16)
# A remainder is at most half a unit in the last place of a state below two.
LEFT = st.integers(min_value=-(2**20), max_value=2**20)


def program(names: str, results) -> Program:
    """Return the program of a formula of named numbers."""
    tape = Tape("t", below=Tape("p"))
    ends = tuple(number(x).operand for x in results(tape, *map(tape.input, names)))
    given_ = tuple(Quantity(name, (name,), (), "", "", None, None, "") for name in names)
    return Program("f", "", given_, (), needed(tape.ops, ends), ends)


ADD = program("xdr", lambda _, x, d, r: compensated_add(x, d, r))
PRODUCT = program("ab", lambda tape, a, b: two_product(a, b, splitter(tape)))


def exact(x) -> Fraction:
    return Fraction(float(x))


@given(STATES, PARTS, LEFT)
def test_nothing_is_lost_but_a_rounding_of_the_increment(x: float, d: float, left: int) -> None:
    for dtype in PRECISIONS:
        u = 2.0 ** -MANTISSA[dtype]
        values = [dtype(x), dtype(d), dtype(left * 2.0**-20 * u)]
        after, rest = run(ADD, working(dtype), values)
        lost = exact(after) + exact(rest) - sum(map(exact, values))
        assert abs(lost) <= u * (abs(exact(d)) + exact(2 * u))
        assert abs(rest) <= 2 * u * (abs(after) + 1)


@pytest.mark.long
@pytest.mark.parametrize("dtype", PRECISIONS)
def test_a_hundred_thousand_increments_add_up_and_plainly_do_not(dtype: type) -> None:
    step, count = dtype(1e-5) / dtype(3), 10**5
    table, u = working(dtype), 2.0 ** -MANTISSA[dtype]
    state, rest, plain = dtype(1), dtype(0), dtype(1)
    for _ in range(count):
        state, rest = run(ADD, table, [state, step, rest])
        plain = plain + step
    true = 1 + count * exact(step)
    assert abs(exact(state) + exact(rest) - true) <= 2 * u
    assert abs(exact(plain) - true) > 100 * u


def test_an_increment_that_is_nothing_costs_nothing() -> None:
    tape = Tape("t", below=Tape("p"))
    x, r = tape.input("x"), tape.input("r")
    assert compensated_add(x, number(0), r) == (x, r)
    assert tape.ops == []


@given(STATES, STATES)
def test_a_product_and_its_error_are_exact(a: float, b: float) -> None:
    for dtype in PRECISIONS:
        high, low = run(PRODUCT, working(dtype), [dtype(a), dtype(b)])
        assert exact(high) + exact(low) == exact(dtype(a)) * exact(dtype(b))


def test_a_product_in_one_float_is_not() -> None:
    a = np.float32(1.1)
    assert exact(a * a) != exact(a) * exact(a)


def test_the_order_of_a_sum_is_kept() -> None:
    """Reassociated, (after - state) is the increment, and nothing is ever left."""
    subtractions = [op.operands for op in ADD.ops if op.operator == "sub"]
    assert len(subtractions) == 2
