"""States without a phase, a frame or a scale of their own move as they must; none is NaN."""

from itertools import permutations, product

import numpy as np
import pytest

from tests.made import thinned
from tests.motion.free import Rows, flow

PRECISIONS = (np.float64, np.float32)
U = {np.float64: 2.0**-53, np.float32: 2.0**-24}
SCALES = {np.float64: (1.0, 2.0**300, 2.0**-300), np.float32: (1.0, 2.0**60, 2.0**-60)}
TINY = 2.0**-30
BODIES = sorted(
    {
        *permutations((1.0, 2.0, 3.0)),
        *permutations((3.0, 4.0, 6.0)),
        *permutations((1.0, 1.0, 2.0)),
        *permutations((1.0, 2.0, 2.0)),
        (2.0, 2.0, 2.0),
        (1.0, 1.5, 5.0),
        (1.0, 1.0 + 2.0**-20, 2.0**-22),
        (1.0, 1.0, 2.0**-22),
    }
)
RATES = tuple(product((0.0, -2.0, TINY), repeat=3))
TIMES = (0.0, -7.0, 1000.0)


def every_state(scale: float, rate: float = 1.0) -> tuple[Rows, Rows]:
    """Return each body at each rate after each time."""
    rows = list(product(BODIES, RATES, TIMES))
    tensors = np.array([[*body, 0, 0, 0] for body, _, _ in rows]) * scale
    states = np.array([[1, 0, 0, 0, *w, t] for _, w, t in rows])
    states[:, 4:7] *= rate
    states[:, 7] /= rate
    return tensors, states


@pytest.mark.long
@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("kind", thinned(["general", "principal"], 2))
def test_no_state_of_no_body_ends_in_nan(kind: str, dtype: type) -> None:
    for scale in SCALES[dtype]:
        tensors, states = every_state(scale)
        ends = flow(kind).ends(dtype, tensors, states).astype(float)
        assert np.all(np.isfinite(ends))
        lengths = np.linalg.norm(ends[:, :4], axis=1)
        assert np.max(np.abs(lengths - 1)) < 8 * U[dtype]  # a product, its root and a division


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("kind", ["principal", "general"])
def test_a_spin_about_a_principal_axis_goes_on_for_ever(kind: str, dtype: type) -> None:
    tensors, states = every_state(1.0)
    pure = np.count_nonzero(states[:, 4:7], axis=1) == 1
    tensors, states = tensors[pure], states[pure]
    ends = flow(kind).ends(dtype, tensors, states).astype(float)
    assert np.max(np.abs(ends[:, 4:] - states[:, 4:7])) <= 8 * U[dtype]
    rate = np.linalg.norm(states[:, 4:7], axis=1)
    half = rate * states[:, 7] / 2
    axis = states[:, 4:7] / rate[:, None]
    spun = np.column_stack([np.cos(half), np.sin(half)[:, None] * axis])
    allowed = U[dtype] * (8 + 4 * np.abs(half))  # the condition of an angle is 2 |half|
    assert np.all(np.max(np.abs(ends[:, :4] - spun), axis=1) <= allowed)


@pytest.mark.parametrize("kind", ["principal", "general", "axisymmetric", "spherical"])
def test_a_body_at_rest_and_a_time_of_zero_leave_all_as_it_is(kind: str) -> None:
    tensors, states = every_state(1.0)
    states[:, :4] = 0.5, -0.5, 0.5, 0.5
    still = ~np.any(states[:, 4:7], axis=1)
    ends = flow(kind).ends(np.float64, tensors, states)
    assert np.array_equal(ends[still], states[still, :7])
    now = states[:, 7] == 0
    assert np.max(np.abs(ends[now] - states[now, :7])) <= 8 * U[np.float64]


@pytest.mark.parametrize("power", [-20, -60, -200, -480])
def test_a_spin_about_the_middle_axis_flips_however_little_it_is_disturbed(power: int) -> None:
    """From m_c = 0 it takes two quarter periods, K = log(4 / k') to order k'^2, to turn over."""
    small = 2.0**power
    moments = np.array((1.0, 2.0, 3.0))
    high = 2 * np.sqrt(1 / 4)  # A = |m_b| sqrt(I_a (I_c - I_b) / (I_b (I_c - I_a)))
    rate = high * np.sqrt(3 / 4) * 2 / 3  # of the phase
    complement = small / high
    flip = 2 * np.log(4 / complement) / rate
    state = np.array([[1, 0, 0, 0, small, 1, 0, flip]])
    end = flow("principal").ends(np.float64, np.array([[*moments, 0, 0, 0]]), state)[0]
    assert abs(end[5] + 1) < 16 * U[np.float64]
    # of log(4 / k') the last place is lost, and the small rate grows as exp(phase) around it
    assert abs(end[4] / small - 1) < 1e-9
    assert abs(end[6]) < 1e-6


@pytest.mark.parametrize("dtype", PRECISIONS)
def test_energy_and_momentum_stay_what_they_are(dtype: type) -> None:
    dice = np.random.default_rng(3)
    count = 400
    tensors, states = np.zeros((count, 6)), np.zeros((count, 8))
    tensors[:, :3] = 10 ** dice.uniform(-2, 2, (count, 3))
    states[:, 0], states[:, 4:] = 1, dice.normal(size=(count, 4))
    states[:, 7] *= 50
    tensors, states = tensors.astype(dtype).astype(float), states.astype(dtype).astype(float)
    ends = flow("principal").ends(dtype, tensors, states).astype(float)
    before, after = invariants(tensors, states[:, 4:7]), invariants(tensors, ends[:, 4:])
    assert np.max(np.abs(after / before - 1)) < 40 * U[dtype]  # squares of sums of three products


def invariants(tensors: Rows, omega: Rows) -> Rows:
    """Return twice the energy and |m|^2, a row each."""
    m = tensors[:, :3] * omega
    return np.array([np.sum(m * omega, axis=1), np.sum(m * m, axis=1)])
