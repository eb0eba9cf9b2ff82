"""A measured order agrees with the claimed one, and a wrong claim is refused."""

import math

import pytest

from bench.motion.case import cases
from bench.report.orders import LARGEST, Order, measured, slope
from tests.bench.report.made_up import CASE

STEPS = [2.0**-n for n in range(1, 12)]


def errors(order: float, floor: float = 0.0) -> list[tuple[float, float]]:
    """Return the differences that one step of a stepper of this order makes."""
    return [(h, h ** (order + 1) + floor) for h in STEPS]


@pytest.mark.parametrize(("method", "order"), [("step_split2", 2), ("step_rk4", 4)])
def test_the_order_of_a_clean_curve_is_found(method: str, order: int) -> None:
    found = measured(method, cases()[CASE], errors(order))
    assert found.agrees
    assert abs(found.measured - order) < 1e-9


@pytest.mark.parametrize("wrong", [3.0, 3.5, 4.5, 5.0])
def test_a_wrong_order_is_refused(wrong: float) -> None:
    assert not measured("step_rk4", cases()[CASE], errors(wrong)).agrees


def test_rounding_and_coarse_steps_do_not_count() -> None:
    spoilt = [(2.0, 1.9), *errors(4, 1e-17)]
    found = measured("step_rk4", cases()[CASE], spoilt)
    assert found.agrees
    assert all(e > LARGEST for h, e in spoilt if h > 0.2)


def test_two_points_make_no_order() -> None:
    assert math.isnan(slope([1.0, 0.5], [1.0, 0.1]))
    assert not Order("step_rk4", CASE, 4, math.nan, 2).agrees
