"""The exact motion of a free body ends where forty digits say, whatever the body and the state."""

from dataclasses import replace
from fractions import Fraction
from itertools import permutations
from typing import Literal

import numpy as np
import pytest

from derive.motion.exact.inertia import Inertia
from derive.program.tape import Number, number
from tests.made import thinned
from tests.motion.free import Case, cases, flow, recorded, share, share_of

PRECISIONS = (np.float64, np.float32)
TWICE = 2.0  # two motions that may each use up the error allowed
# In the middle of a flip a rounding is u |omega|: far more than u of what decides the next one.
NO_FLIP = [case for case in cases() if not case.name.startswith("dzhanibekov")]
BITS = {np.float64: (300, 100), np.float32: (60, 20)}  # of scales: of inertia, of rates


def can_be_given(case: Case, dtype: type) -> bool:
    return dtype is np.float64 or case.exact_in_float


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("case", thinned(cases(), 4), ids=lambda c: c.name)
def test_a_reference_case_ends_within_its_condition(case: Case, dtype: type) -> None:
    if can_be_given(case, dtype):
        assert share_of(case, dtype, flow(case.kind)) <= 1
        assert share_of(case, dtype, flow("general")) <= 1


def test_a_motion_costs_four_functions_of_libm_and_less_than_900_operations() -> None:
    count = flow("general").function.count
    assert count["sin"] == count["cos"] == 2
    assert "atan2" not in count
    assert sum(count.values()) < 900


@pytest.mark.parametrize("dtype", PRECISIONS)
def test_a_body_of_revolution_and_a_sphere_need_sines_and_cosines_only(dtype: type) -> None:
    by_name = {case.name: case for case in cases()}
    size = len(flow("principal").function.ops)
    for kind, name in (("axisymmetric", "oblate_exact"), ("spherical", "sphere")):
        special = flow(kind)
        assert share_of(by_name[name], dtype, special) <= 1
        assert len(special.function.ops) < size / 5
    assert share_of(by_name["sphere"], dtype, flow("axisymmetric")) <= 1
    assert share_of(by_name["asym_ii_generic"], dtype, flow("axisymmetric")) > 1


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_a_body_of_revolution_has_its_axis_along_any_of_three(axis: Literal["x", "y", "z"]) -> None:
    place = "xyz".index(axis)

    def body(t: list[Number]) -> Inertia:
        along, across = t[place], t[(place + 1) % 3]
        x, y, z = (along if i == place else across for i in range(3))
        return Inertia((x, y, z, number(0), number(0), number(0)), "axisymmetric", axis)

    tensors = np.array([[2.0, 2.0, 2.0, 0, 0, 0]])
    tensors[0, place] = 3
    state = np.array([[0.5, -0.5, 0.5, 0.5, 0.3, -1.0, 0.7, 12.5]])
    found = recorded(body).ends(np.float64, tensors, state)
    whole = flow("principal").ends(np.float64, tensors, state)
    assert np.max(np.abs(found - whole)) < 100 * 2.0**-53  # two motions through 15 rad


@pytest.mark.parametrize(
    "name", ["asym_ii_generic", "separatrix_exact", "oblate_exact", "sphere", "full_tensor"]
)
def test_a_body_of_numbers_needs_no_set_up_and_moves_the_same(name: str) -> None:
    case = next(c for c in cases() if c.name == name)
    given = [number(Fraction(x)) for x in case.tensor]
    body = Inertia(tuple(given), case.kind, None)  # type: ignore[arg-type]
    made = recorded(lambda _: body)
    assert made.setup.ops == ()
    assert len(made.function.ops) <= len(flow(case.kind).function.ops)
    assert share_of(case, np.float64, made) <= 1


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("case", thinned(cases(), 4), ids=lambda c: c.name)
def test_other_names_for_the_axes_change_names_only(case: Case, dtype: type) -> None:
    if not can_be_given(case, dtype):
        return
    for order in permutations(range(3)):
        sign = np.linalg.det(np.eye(3)[list(order)])  # a mirror turns the sense of rotation
        renamed = relabelled(case, order, sign)
        found = flow(case.kind).ends(dtype, np.array([renamed.tensor]), np.array([renamed.state]))
        back = [*found[0, :1], *(sign * found[0, 1 + order.index(i)] for i in range(3))]
        back += [sign * found[0, 4 + order.index(i)] for i in range(3)]
        assert share(case, dtype, back) <= 1


def relabelled(case: Case, order: tuple[int, ...], sign: float) -> Case:
    """Return the case with ``order[i]`` called axis i; ``sign`` is -1 where that is a mirror."""
    moments, products = case.tensor[:3], case.tensor[3:]
    place = {frozenset(p): products[n] for n, p in enumerate(((0, 1), (0, 2), (1, 2)))}
    mixed = [place[frozenset((order[i], order[j]))] for i, j in ((0, 1), (0, 2), (1, 2))]
    scalar, *vector = case.state[:4]
    state = [scalar, *(sign * vector[i] for i in order)]
    state += [sign * case.state[4 + i] for i in order]
    tensor = (*(moments[i] for i in order), *mixed)
    return replace(case, tensor=tensor, state=(*state, case.state[7]))


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("case", thinned(NO_FLIP, 4), ids=lambda c: c.name)
def test_two_motions_in_a_row_are_one(case: Case, dtype: type) -> None:
    if not can_be_given(case, dtype):
        return
    tensors, motion = np.array([case.tensor]), flow(case.kind)
    for part in (0.375, -0.5, 1.0):  # of the time, so that both times are floats
        first = [*case.state[:7], part * case.state[7]]
        between = motion.ends(dtype, tensors, np.array([first]))
        rest = np.append(between[0], (1 - part) * case.state[7])
        end = motion.ends(dtype, tensors, rest[None, :])
        assert share(case, dtype, end[0]) <= TWICE


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("kind", ["general", "principal"])
def test_the_scale_of_inertia_and_of_rates_changes_no_bit(kind: str, dtype: type) -> None:
    chosen = [c for c in cases() if can_be_given(c, dtype) and max(c.tensor) > 1e-3]
    chosen = [c for c in chosen if kind == "general" or c.kind == kind]
    tensors, states = np.array([c.tensor for c in chosen]), np.array([c.state for c in chosen])
    plain = flow(kind).ends(dtype, tensors, states)
    inertia, rate = BITS[dtype]
    for power in (inertia, -inertia):
        assert np.array_equal(flow(kind).ends(dtype, tensors * 2.0**power, states), plain)
    for power in (rate, -rate):
        scaled = states.copy()
        scaled[:, 4:7] *= 2.0**power
        scaled[:, 7] *= 2.0**-power
        found = flow(kind).ends(dtype, tensors, scaled)
        found[:, 4:] *= dtype(2.0**-power)
        assert np.array_equal(found, plain)


def test_an_attitude_of_any_length_keeps_its_length() -> None:
    case = cases()[0]
    states = np.array([case.state] * 3)
    states[1, :4] *= 2.0**80
    states[2, :4] *= 2.0**-80
    ends = flow("principal").ends(np.float64, np.array([case.tensor] * 3), states)
    assert np.array_equal(ends[1, :4] * 2.0**-80, ends[0, :4])
    assert np.array_equal(ends[2, :4] * 2.0**80, ends[0, :4])


def test_the_textbook_modulus_fails_where_moments_or_motions_are_nearly_equal() -> None:
    flip = next(c for c in cases() if c.name == "dzhanibekov_2e-20")
    assert textbook_complement(flip, np.float32) == 0  # and then it never flips; 2^-40 is true
    rod = next(c for c in cases() if c.name == "thin_rod_f32")
    assert abs(textbook_complement(rod, np.float32) / ROD_COMPLEMENT - 1) > 500 * 2.0**-24
    sphere = next(c for c in cases() if c.name == "sphere")
    assert np.isnan(textbook_complement(sphere, np.float64))


ROD_COMPLEMENT = 0.9826989825649  # "kc2" of the reference data


def textbook_complement(case: Case, dtype: type) -> float:
    """Return k'^2 = 1 - k^2 with k from |m|^2 - 2 T I_j, as textbooks have it."""
    i, w = np.sort(np.array(case.tensor[:3], dtype)), np.array(case.state[4:7], dtype)
    w = w[np.argsort(np.array(case.tensor[:3]))]
    energy, square = np.sum(i * w * w), np.sum(i * w * (i * w))
    with np.errstate(invalid="ignore"):
        high = (i[1] - i[0]) * (i[2] * energy - square)
        k_squared = high / ((i[2] - i[1]) * (square - i[0] * energy))
    return float(1 - min(k_squared, 1 / k_squared))
