"""States that nobody chose, and some next to the separatrix, end where fifty digits say."""

import numpy as np
import pytest

from tests.motion.free import Case, Rows, cases, flow, share_of
from tests.motion.integrated import integrated

pytestmark = pytest.mark.long

RANDOM = 4
EDGES = (1e-3, 1e-6, 1e-9, 1e-13)  # relative distance from the separatrix


def test_any_state_ends_where_a_taylor_series_of_fifty_digits_ends() -> None:
    bodies, states = drawn()
    kappas = conditions(bodies, states)
    for tensor, state, kappa in zip(bodies, states, kappas, strict=True):
        end = integrated(tensor, state)
        case = Case("", tuple(tensor), tuple(state), end, kappa, exact_in_float=False)
        assert share_of(case, np.float64, flow("general")) <= 1


def drawn() -> tuple[Rows, Rows]:
    """Return tensors and states: some of any kind, then some next to the separatrix."""
    dice = np.random.default_rng(11)
    count = RANDOM + len(EDGES)
    bodies, states = np.zeros((count, 6)), dice.normal(size=(count, 8))
    states[:, :4] = 1, 0, 0, 0
    states[:, 7] = dice.uniform(-6, 6, count)
    for n in range(count):
        i1, i2, i3 = np.sort(dice.uniform(1, 3, 3))
        if n >= RANDOM:
            ratio = np.sqrt(i1 * (i2 - i1) / (i3 * (i3 - i2)))  # omega_3 over omega_1 on it
            states[n, 6] = states[n, 4] * ratio * (1 + EDGES[n - RANDOM])
            bodies[n, :3] = i1, i2, i3
            continue
        frame = np.linalg.qr(dice.normal(size=(3, 3)))[0]
        full = frame @ np.diag((i1, i2, i3)) @ frame.T
        bodies[n] = *np.diag(full), full[0, 1], full[0, 2], full[1, 2]
    return bodies, states


def conditions(bodies: Rows, states: Rows) -> list[tuple[float, float]]:
    """Return the conditions of attitude and rates, from differences of the motion itself."""
    step = 2.0**-24
    plain = flow("general").ends(np.float64, bodies, states)
    found = np.zeros((len(states), 2))
    for place in range(10):
        changed, moved = bodies.copy(), states.copy()
        if place < 6:
            changed[:, place] *= 1 + step
        else:
            moved[:, place - 2] *= 1 + step
        ends = flow("general").ends(np.float64, changed, moved)
        found[:, 0] += 2 * np.linalg.norm(ends[:, :4] - plain[:, :4], axis=1) / step
        wrong = np.linalg.norm(ends[:, 4:] - plain[:, 4:], axis=1)
        found[:, 1] += wrong / np.linalg.norm(plain[:, 4:], axis=1) / step
    return [(float(a), float(b)) for a, b in found]


def test_the_integration_that_judges_gives_the_reference_values() -> None:
    case = next(c for c in cases() if c.name == "tiny_scale_f32")
    found = integrated(case.tensor, case.state)
    assert max(abs(a - b) for a, b in zip(found, case.end, strict=True)) < 1e-38
