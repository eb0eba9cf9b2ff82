"""No body and no state ends in NaN, or further off than rounding of the inputs excuses.

Nobody chose these: moments equal or nearly, rods, discs, bodies at the edge of the triangle
inequality and beyond, rates 2^-k of one another with k up to the type's end, or none.
"""

import numpy as np
import pytest

from tests.made import thinned
from tests.motion.free import Rows, apart, flow
from tests.motion.integrated import integrated
from tests.motion.wild import share_of_error, wild, without_lost_rates, without_rounding

PRECISIONS = (np.float64, np.float32)
KINDS = ("principal", "axisymmetric")
MANY, FEW = 1500, 24
FOUND = (  # by the search, or by others: float, moments, rates, time
    (np.float32, (1, 1, 2), (1, 2, 1e-20), 3),
    (np.float64, (1, 1, 2), (1, 2, 1e-151), 3),
    (np.float64, (1, 1, 2), (1, 2, 1e-160), 3),
    (np.float32, (1.671953e-6, 0.003926527, 0.3672), (107.734, -70.88847, 0.02389507), 0.06923423),
    (np.float32, (1, 2, 3), (1e-30, 1, 0), 150),  # it flips twice, after more than 75 rad
    (np.float64, (1, 2, 3), (1e-300, 1, 0), 1500),
    (np.float64, (11.643423609585216, 11.643423609585216, 16), (0.65, 0, 4e-161), -44.5),
    (np.float32, (2.79e-05, 1.5e-05, 1.26e-05), (-2.9e-26, -1697, 0), 0.36),
    (np.float64, (128, 128, 6.7e-80), (-3.1e-37, -1.9e-37, -1.4e-110), -2.2e39),
)


def ends(kind: str, dtype: type, tensors: Rows, states: Rows) -> Rows:
    return flow(kind).ends(dtype, tensors, states).astype(float)


def of_kind(kind: str, tensors: Rows) -> Rows:
    """Return tensors with equal moments across z for a body of revolution."""
    return tensors[:, [0, 0, *range(2, 6)]] if kind == "axisymmetric" else tensors


def shares(kind: str, dtype: type, tensors: Rows, states: Rows) -> list[float]:
    found = ends(kind, dtype, tensors, states)
    each = zip(tensors, states, found, strict=True)
    return [share_of_error(flow(kind), dtype, *one) for one in each]


def worst(kind: str, dtype: type, seed: int, many: int, few: int) -> float:
    """Return the largest share of its error that an end uses up, infinite where one is no number.

    many : of which every end must be finite        few : of which the errors are measured
    """
    tensors, states = wild(np.random.default_rng(seed), many, dtype)
    tensors = of_kind(kind, tensors)
    if not np.all(np.isfinite(ends(kind, dtype, tensors, states))):
        return float("inf")
    judged = without_lost_rates(dtype, tensors[:few], states[:few])
    return max(shares(kind, dtype, tensors[:few], judged))


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("kind", thinned(KINDS, 2))
def test_no_body_ends_in_nan_or_further_off_than_its_condition(kind: str, dtype: type) -> None:
    assert worst(kind, dtype, 1, MANY, FEW) <= 1


@pytest.mark.long
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("kind", KINDS)
def test_nor_do_many_more(kind: str, dtype: type, seed: int) -> None:
    assert worst(kind, dtype, 100 + seed, 20 * MANY, 40 * FEW) <= 1


@pytest.mark.parametrize("case", range(len(FOUND)))
def test_states_that_were_once_nan_or_wrong_are_right(case: int) -> None:
    dtype, moments, rates, time = FOUND[case]
    tensors = np.array([[*moments, 0, 0, 0]], dtype).astype(float)
    states = np.array([[1, 0, 0, 0, *rates, time]], dtype).astype(float)
    assert shares("principal", dtype, tensors, states)[0] <= 1


def test_a_body_of_revolution_moves_as_the_tumbling_one_that_it_is() -> None:
    """One is two steady turns, the other elliptic functions: they share no formula."""
    tensors, states = wild(np.random.default_rng(7), FEW, np.float64)
    for tensor, state in zip(of_kind("axisymmetric", tensors), states, strict=True):
        plain = without_rounding(flow("axisymmetric"), tensor, state)
        whole = without_rounding(flow("principal"), tensor, state)
        assert max(apart(whole, plain)) < 1e-30  # 2^-40 of the phase's 500 bits are left at 1e93


@pytest.mark.long
def test_states_of_every_make_end_where_a_taylor_series_ends() -> None:
    tensors, states = wild(np.random.default_rng(8), 400, np.float64)
    seen = 0
    for tensor, state in zip(tensors, states, strict=True):
        spread = max(tensor[:3]) / min(tensor[:3])
        if spread * np.max(np.abs(state[4:7])) * abs(state[7]) < 20:
            seen += 1
            true = without_rounding(flow("principal"), tensor, state)
            # of 69 digits, moments as unlike as 2^-81 may take 50
            assert max(apart(true, integrated(tensor, state))) < 1e-19
    assert seen > 50


def test_the_judge_sees_a_rate_that_is_lost() -> None:
    tensors = np.array([[1.0, 2, 3, 0, 0, 0]])
    states = np.array([[1, 0, 0, 0, 1e-30, 1, 0, 150.0]])
    lost = states.copy()
    lost[0, 4] = 0
    found = ends("principal", np.float64, tensors, lost)
    assert share_of_error(flow("principal"), np.float64, tensors[0], states[0], found[0]) > 1e6
