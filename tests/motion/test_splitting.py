"""Splittings have the order they claim, with a moment or none, and are exact where they can be."""

import json
from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from itertools import product
from typing import Any

import mpmath as mp
import numpy as np
import pytest

from derive.motion.splitting.schemes import NYSTROEM6, S6, S10, STRANG, Scheme
from derive.program.arithmetic import MANTISSA
from derive.program.tape import Number, number
from tests.motion.free import DATA, Case, cases
from tests.motion.stepped import (
    BITS,
    START,
    apart,
    invariants,
    measured_order,
    split,
    split_compensated,
)

pytestmark = pytest.mark.long

PRECISIONS = (np.float64, np.float32)
ORDERS = (2, 4, 6)
TENSORS = {
    "principal": (1, 2, 3, 0, 0, 0),
    "general": (2, 3, 4, -0.25, 0.125, -0.5),
    "axisymmetric": (2, 2, 3, 0, 0, 0),
    "spherical": (2, 2, 2, 0, 0, 0),
}
CLOSED = ("axisymmetric", "spherical")
# From steps of 1/16 s to 1/32 s; the next order's share is below this.
NEXT_ORDER = 0.1
# Conditions on coefficients of 45 digits, and on those of one wrong digit in the tenth place.
SOLVED, ONE_DIGIT = Fraction(1, 10**44), Fraction(1, 10**10)
# Where roundings of many steps add up, or grow: the largest error of omega or attitude, in double.
ENDS = {"dzhanibekov_2e-20": 5e-7, "fast_spin_pub": 1e-9, "separatrix_exact": 2e-8}
# Of u a step, the roundings of a step that is exact: three turns of some fifty operations.
ROUNDINGS = 4


def weight(attitude: list[Number]) -> Sequence[Number]:
    """Return the moment (N m, along body axes) of a weight of 3 N that hangs beside the point."""
    w, x, y, z = attitude
    down = (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))
    a, b, c = Fraction(-3, 10), Fraction(3, 5), number(-3)
    return [b * down[2] - c * down[1], c * down[0] - a * down[2], a * down[1] - b * down[0]]


def steady(_: list[Number]) -> Sequence[Number]:
    """Return the moment of the reference case that has one."""
    return [number(Fraction(x)) for x in TORQUED["M"]]


TORQUED = next(
    row
    for row in json.loads(DATA.read_text(encoding="utf-8"))["cases"]
    if row["id"] == "const_body_torque"
)


@cache
def half_a_second(kind: str, moment) -> list[Any]:
    return split(kind, 6, moment).moved(TENSORS[kind], START, Fraction(1, 128), 64)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("moment", [None, weight], ids=["free", "weight"])
@pytest.mark.parametrize("kind", TENSORS)
def test_the_order_is_the_one_claimed(kind: str, moment, order: int) -> None:
    if moment is None and kind in CLOSED:
        return
    true = half_a_second(kind, moment)
    steps = (8, 16) if order > 2 else (16, 32)
    found = measured_order(split(kind, order, moment), TENSORS[kind], true, steps)[0]
    assert abs(found - order) < NEXT_ORDER


@pytest.mark.parametrize(
    "moments", [(1, 2, 3), (3, 2, 1), (2, 1, 3), (3, 1, 2), (1, 3, 2), (2, 3, 1)]
)
def test_any_axis_may_be_the_intermediate_one(moments: tuple[int, ...]) -> None:
    tensor = (*moments, 0, 0, 0)
    true = split("general", 6).moved(tensor, START, Fraction(1, 128), 64)
    found = split("principal", 6).moved(tensor, START, Fraction(1, 32), 16)
    assert max(apart(found, true)) < 1e-11


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("kind", ["axisymmetric", "principal", "general"])
def test_a_body_of_revolution_is_moved_exactly(kind: str, order: int, dtype: type) -> None:
    true = split("axisymmetric", 2).moved(TENSORS["axisymmetric"], START, Fraction(1, 64), 64)
    found = split(kind, order).ran(dtype, TENSORS["axisymmetric"], START, 0.25, 4)
    assert max(apart(found, true)) < 4 * ROUNDINGS * 2.0 ** -MANTISSA[dtype]


def test_closed_forms_are_visibly_smaller() -> None:
    sizes = {kind: split(kind, 4).step.flops() for kind in TENSORS}
    assert sizes["spherical"] < sizes["axisymmetric"] < sizes["principal"] / 4


@pytest.mark.parametrize("case", cases(), ids=lambda c: c.name)
def test_a_reference_case_ends_where_it_should(case: Case) -> None:
    """Order 6 at 1/32 rad a step; the flip amplifies a rounding of a step by e^(lambda T)."""
    rate = max(abs(w) for w in case.state[4:7])
    h = float(2.0 ** np.floor(np.log2(1 / 32 / rate)))
    found = split(case.kind, 6).ran(
        np.float64, case.tensor, case.state[:7], h, round(case.state[7] / h)
    )
    true = [mp.mpf(x.mid().str(45, radius=False)) for x in case.end]
    bound = ENDS.get(case.name, 1e-11)
    u = 2.0**-53
    assert all(
        error < max(bound, 4 * kappa * u)
        for error, kappa in zip(apart(found, true), case.kappa, strict=True)
    )


def test_one_radian_a_step_at_four_thousand_radians_a_second() -> None:
    case = next(c for c in cases() if c.name == "fast_spin_pub")
    true = [mp.mpf(x.mid().str(45, radius=False)) for x in case.end]
    found = split("principal", 6).ran(np.float64, case.tensor, case.state[:7], 2.0**-12, 8192)
    assert max(apart(found, true)) < 3e-9  # what three rotations a stage were measured to reach


def test_a_steady_moment_ends_where_forty_digits_say() -> None:
    tensor = [float(TORQUED["inertia"][i][i]) for i in range(3)] + [0.0] * 3
    start = [float(x) for x in (*TORQUED["q0"], *TORQUED["omega0"])]
    h, steps = 2.0**-6, round(float(TORQUED["T"]) * 64)
    with mp.workprec(BITS):
        true = [mp.mpf(x) for x in (*TORQUED["q_T"], *TORQUED["omega_T"])]
    for order, bound in ((2, 1e-2), (4, 1e-7), (6, 1e-10)):
        found = split("principal", order, steady).ran(np.float64, tensor, start, h, steps)
        assert max(apart(found, true)) < bound


@pytest.mark.parametrize("dtype", PRECISIONS)
def test_remainders_end_the_growth_of_rounding(dtype: type) -> None:
    given = TENSORS["principal"], START, float(dtype(0.01)), 10**5
    plain, kept = (make("principal", 4).ran(dtype, *given) for make in (split, split_compensated))
    assert max(momentum(kept)) < max(momentum(plain)) / 4
    assert max(momentum(kept)) < 2.0 ** -MANTISSA[dtype] * 32


def momentum(state) -> tuple[float, float]:
    """Return how far off are the length of the momentum and that of the attitude."""
    before = invariants(TENSORS["principal"], START)[1]
    after = invariants(TENSORS["principal"], state)[1]
    with mp.workprec(BITS):
        return float(abs(after / before - 1)), float(abs(sum(q * q for q in state[:4]) - 1))


Word = tuple[int, ...]
Words = dict[Word, Fraction]


def residuals(scheme: Scheme, order: int) -> list[Fraction]:
    """Return what is left of the order conditions: the logarithm of a step in words of A and B.

    A word's coefficients that belong to brackets are told by its Lyndon words (Reutenauer); even
    ones vanish, for a scheme reads the same from both ends.
    """
    total: Words = {(): Fraction(1)}
    parts = [(0, scheme.outer[0])]
    for inner, outer in zip(scheme.inner, scheme.outer[1:], strict=True):
        parts += [(1, inner), (0, outer)]
    for letter, part in parts:
        power, flow = Fraction(1), {(): Fraction(1)}
        for k in range(1, order):
            power *= part / k
            flow[(letter,) * k] = power
        total = times(total, flow, order - 1)
    logarithm, power_of = Words(), {(): Fraction(1)}
    rest = {word: x for word, x in total.items() if word}
    for k in range(1, order):
        power_of = times(power_of, rest, order - 1)
        for word, x in power_of.items():
            logarithm[word] = logarithm.get(word, Fraction(0)) - Fraction((-1) ** k, k) * x
    lyndon = [w for n in range(3, order, 2) for w in product((0, 1), repeat=n) if is_lyndon(w)]
    return [abs(logarithm[word]) for word in lyndon]


def times(p: Words, q: Words, longest: int) -> Words:
    """Return a product of sums of words, cut to a length and to digits enough."""
    found = Words()
    for (a, x), (b, y) in product(p.items(), q.items()):
        if len(a) + len(b) <= longest:
            found[a + b] = found.get(a + b, Fraction(0)) + x * y
    return {word: Fraction(round(x * 10**60), 10**60) for word, x in found.items()}


def is_lyndon(word: Word) -> bool:
    return all(word < word[i:] + word[:i] for i in range(1, len(word)))


@pytest.mark.parametrize(
    ("scheme", "order"), [(STRANG, 2), (S6, 4), (S10, 6), (NYSTROEM6, 4)], ids=str
)
def test_coefficients_meet_their_conditions_to_all_digits(scheme: Scheme, order: int) -> None:
    assert all(x < SOLVED for x in residuals(scheme, order))
    assert sum(scheme.outer) == sum(scheme.inner) == 1


def test_a_wrong_digit_is_noticed() -> None:
    """A list of these coefficients had ...0350... changed to ...0650... with a digit displaced."""
    wrong = list(S6.outer)
    for place in (2, 4):
        wrong[place] = Fraction("-0.0420650603577195")
    wrong[3] = 1 - 2 * sum(wrong[:3])
    assert max(residuals(Scheme(tuple(wrong), S6.inner), 4)) > ONE_DIGIT
