"""Published optima, and those of others' programs, by the same call: nine digits and more."""

import json
from pathlib import Path

import numpy as np
import pytest

import derive
from tests.control.crafts import craft, inertia

KNOWN = json.loads(Path("tests/data/optimal_control.json").read_text())
SAME = 2e-10  # of the figure: all the digits that the references have
GRID = 2e-4  # of the figure, by 100 steps of held inputs
QUICK = "sym180"
SLEW = {
    name: pytest.param(name, marks=() if name == QUICK else pytest.mark.long)
    for name in KNOWN["min_time"]
}


def slewed(name: str, starts: int = 16) -> derive.Trajectory:
    case = KNOWN["min_time"][name]
    turn = f"{case['axis']} {case['degrees']}deg"
    limits = {"moment": case["umax"]}
    return derive.steer(craft(), inertia(case["inertia"]), turn, limits=limits, starts=starts)


@pytest.mark.long
@pytest.mark.parametrize("name", SLEW.values())
def test_a_slew_takes_the_time_that_is_known(name: str) -> None:
    trajectory, known = slewed(name, 3 if name == QUICK else 16), KNOWN["min_time"][name]
    assert trajectory.until == pytest.approx(known["t_f"], rel=SAME)
    assert trajectory.grid.cost == pytest.approx(known["t_f"], rel=GRID)
    assert trajectory.missed < 1e-9
    assert trajectory.conditions is not None
    assert trajectory.conditions.worst < 1e-8


@pytest.mark.long
def test_a_straight_start_ends_at_the_turn_about_one_axis_and_others_do_better() -> None:
    trajectory = slewed("sym180", 4)
    assert trajectory.found[0] == pytest.approx(
        KNOWN["min_time"]["sym180"]["eigenaxis_t_f"], rel=1e-5
    )
    assert min(c for c in trajectory.found[1:] if c is not None) < 3.25


@pytest.mark.long
@pytest.mark.parametrize("name", KNOWN["min_energy"])
def test_a_turn_costs_the_energy_that_is_known(name: str) -> None:
    case = KNOWN["min_energy"][name]
    turn = f"{case['axis']} {case['degrees']}deg"
    values, cost = inertia(case["inertia"]), {"energy": 1}
    trajectory = derive.steer(craft(), values, turn, cost=cost, until=case["T"], starts=1)
    assert trajectory.cost == pytest.approx(case["integral_u2"], rel=SAME)
    assert trajectory.conditions is not None
    assert trajectory.conditions.worst < 1e-8


@pytest.mark.long
@pytest.mark.parametrize(
    ("moments", "turn", "limit", "cost", "until"),
    [
        ((1, 1, 1), "1,1,1 2", 0.6, {"energy": 1}, 3),
        pytest.param((1, 2, 3), "1,2,2 2", 0.5, {"energy": 1}, 5, marks=pytest.mark.long),
        pytest.param(
            (1, 2, 2), "1,2,2 2", 0.4, {"energy": 0.1, "time": 1}, None, marks=pytest.mark.long
        ),
    ],
)
def test_a_cheap_turn_whose_inputs_come_to_their_limits_costs_what_grids_tend_to(
    moments, turn, limit, cost, until
) -> None:
    """Inputs held over a step cost more by the step's square; what is left of that by its cube."""
    given = {"limits": {"moment": limit}, "cost": cost, "until": until, "starts": 1}
    found, coarse = (
        derive.steer(craft(), inertia(moments), turn, steps=n, **given) for n in (160, 80)
    )
    assert any(where != "between" for _, _, where in found.switches)
    assert found.missed < 1e-9
    assert found.conditions is not None
    assert found.conditions.worst < 1e-8
    tends_to = (4 * found.grid.cost - coarse.grid.cost) / 3
    assert abs(found.cost - tends_to) < 0.1 * (found.grid.cost - tends_to)


@pytest.mark.long
def test_taylor_steps_lead_to_the_end() -> None:
    trajectory = slewed("sym180", 3)
    assert trajectory.refined is not None
    step = craft().function("step_taylor12", dict(inertia((1, 1, 1))))
    q, omega = np.array([1.0, 0, 0, 0]), np.zeros(3)
    for arc in trajectory.refined.arcs:
        for _ in range(4):
            q, omega, _ = step(q, omega, np.array(arc.stays, float), arc.lasts / 4)
    assert np.abs(omega).max() < 1e-9
    assert np.abs(q[:3]).max() < 1e-9
