"""Problems in which the length of a step, or parameters, are sought with compiled steps."""

from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
import pytest

N, OWN, LIMIT = 20, [1.4, 1.6, 1.8], 0.4
Steps = Callable[..., Any]


@pytest.fixture(scope="module")
def compiled(module: ModuleType, workshop: Path) -> Steps:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(workshop / "solved"))
        return module.external(N)


def by_casadi(module: ModuleType) -> Steps:
    step = module.step()
    return lambda x, u, h, p: ca.horzcat(*(step(x[:, k], u[:, k], h, p) for k in range(N)))


def solved(opti: ca.Opti) -> tuple[Any, int]:
    opti.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes"})
    found = opti.solve()
    assert found.stats()["return_status"] == "Solve_Succeeded"
    return found, found.stats()["iter_count"]


def shortest(steps: Steps) -> tuple[float, int]:
    """Return the least time for a turn by 2 rad about (1, 2, 2) / 3, and the iterations."""
    opti = ca.Opti()
    x, u, whole = opti.variable(7, N + 1), opti.variable(3, N), opti.variable()
    opti.minimize(whole + 1e-3 * ca.sumsqr(u) / N)
    opti.subject_to(x[:, 1:] == steps(x[:, :-1], u, whole / N, OWN))
    opti.subject_to(x[:, 0] == [1, 0, 0, 0, 0, 0, 0])
    opti.subject_to(x[1:, N] == ca.vertcat(np.sin(1) * ca.DM([1, 2, 2]) / 3, 0, 0, 0))
    opti.subject_to(opti.bounded(-LIMIT, ca.vec(u), LIMIT))
    opti.subject_to(opti.bounded(0.5, whole, 20))
    opti.set_initial(x, ca.repmat([1, 0, 0, 0, 0, 0, 0], 1, N + 1))
    opti.set_initial(whole, 5)
    opti.set_initial(u, 0.01)
    found, iterations = solved(opti)
    return float(found.value(whole)), iterations


@pytest.mark.long
def test_minimum_time_is_found_as_with_casadis_own_derivatives(
    module: ModuleType, compiled: Steps
) -> None:
    (ours, ours_took), (theirs, theirs_took) = shortest(compiled), shortest(by_casadi(module))
    assert ours == pytest.approx(theirs, rel=1e-9)
    assert ours_took == theirs_took
    quickest = 2 * np.sqrt(2 * min(OWN) / (LIMIT * np.sqrt(3)))  # all three moments in line
    assert quickest < ours < 6


@pytest.mark.long
def test_moments_of_inertia_are_found_from_a_motion(module: ModuleType, compiled: Steps) -> None:
    dice = np.random.default_rng(3)
    u, start = dice.uniform(-1, 1, size=(3, N)), np.array([1, 0, 0, 0, 0.3, -0.2, 0.5])
    seen, step = [start], module.step()
    for k in range(N):
        seen.append(np.array(step(seen[-1], u[:, k], 0.1, OWN))[:, 0])
    motion = np.array(seen).T
    opti = ca.Opti()
    x, p = opti.variable(7, N + 1), opti.variable(3)
    opti.minimize(ca.sumsqr(x - motion))
    opti.subject_to(x[:, 1:] == compiled(x[:, :-1], u, 0.1, p))
    opti.set_initial(x, motion)
    opti.set_initial(p, [1.5, 1.5, 1.7])
    opti.subject_to(opti.bounded(1, p, 2))
    found, _ = solved(opti)
    assert np.allclose(found.value(p), OWN, atol=1e-6)
