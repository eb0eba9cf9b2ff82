"""What is told of a trajectory can fail: one that is not the cheapest, inputs that miss the end."""

from dataclasses import replace

import numpy as np
import pytest

import derive
from derive.control.conditions import conditions, missed
from derive.control.plant import plant
from derive.control.structure import Arc, arcs_of
from derive.control.task import task
from tests.control.crafts import craft, inertia

LIMITS = {"moment": 0.8}
TURN = "1,2,2 120deg"


@pytest.fixture(scope="module")
def trajectory() -> derive.Trajectory:
    return derive.steer(craft(), inertia((1, 2, 3)), TURN, limits=LIMITS, starts=2)


def posed():
    own, given = plant(craft().scene, inertia((1, 2, 3)))
    return own, task(own, given, TURN, {}, LIMITS, (), {"time": 1}, None)


@pytest.mark.long
def test_the_cheapest_way_satisfies_what_is_necessary(trajectory: derive.Trajectory) -> None:
    assert trajectory.conditions is not None
    assert trajectory.conditions.worst < 1e-7
    assert trajectory.missed < 1e-9


@pytest.mark.long
def test_an_input_at_the_other_limit_is_seen(trajectory: derive.Trajectory) -> None:
    own, asked = posed()
    assert trajectory.refined is not None
    first, *others = trajectory.refined.arcs
    for place in range(3):
        stays = tuple(-s if k == place else s for k, s in enumerate(first.stays))
        turned = replace(trajectory.refined, arcs=(Arc(stays, first.lasts), *others))
        assert conditions(own, asked, turned).worst > 1e-2


def test_arcs_that_end_at_other_times_cost_more_or_miss(trajectory: derive.Trajectory) -> None:
    own, asked = posed()
    assert trajectory.refined is not None
    lasts = trajectory.refined.lasts.copy()
    lasts[0] += 1e-6
    lasts[-1] -= 1e-6
    assert missed(own, asked, replace(trajectory.refined, lasts=lasts)) > 1e-8


@pytest.mark.parametrize("place", range(3))
def test_inputs_that_are_off_by_little_are_seen_to_miss(
    trajectory: derive.Trajectory, place: int
) -> None:
    own, asked = posed()
    assert trajectory.refined is not None
    u = trajectory.refined.u.copy()
    u[place] *= 1 + 1e-6
    assert missed(own, asked, replace(trajectory.refined, u=u)) > 1e-7


def test_a_multiplier_of_another_sign_is_seen(trajectory: derive.Trajectory) -> None:
    own, asked = posed()
    assert trajectory.refined is not None
    turned = trajectory.refined.adjoint * np.array([1, 1, 1, 1, 1, -1, 1])[:, None]
    assert conditions(own, asked, replace(trajectory.refined, adjoint=turned)).worst > 0.1


def test_switches_are_read_from_steps_in_which_an_input_is_in_between(
    trajectory: derive.Trajectory,
) -> None:
    u = np.array([[1.0, 1, 0.5, -1, -1, -1, 0.2, 0.4, 1, 1]])
    grid = replace(trajectory.grid, u=u, until=10.0)
    lasts = [arc.lasts for arc in arcs_of(grid, np.array([-1.0]), np.array([1.0]), 2)]
    assert lasts == pytest.approx([2.75, 3.95, 3.3])


@pytest.mark.long
@pytest.mark.parametrize("by", [("collocation", "ipopt"), ("shooting", "fatrop")])
def test_other_methods_and_solvers_find_the_same(
    trajectory: derive.Trajectory, by: tuple[str, str]
) -> None:
    values = inertia((1, 2, 3))
    other = derive.steer(craft(), values, TURN, limits=LIMITS, starts=2, method=by[0], solver=by[1])
    assert other.cost == pytest.approx(trajectory.cost, rel=1e-10)


@pytest.mark.long
def test_a_trajectory_from_before_is_a_start(trajectory: derive.Trajectory) -> None:
    """Straight, this start leads to the turn about one axis, which takes longer."""
    turn, values = "z 180deg", inertia((1, 1, 1))
    given = {"limits": {"moment": 1}, "starts": 1, "steps": 40}
    straight = derive.steer(craft(), values, turn, **given)
    better = derive.steer(craft(), values, turn, **given | {"starts": 2})
    again = derive.steer(craft(), inertia((1, 1, 1.01)), turn, guess=better, **given)
    assert better.cost < again.cost < 1.01 * better.cost < straight.cost
    for wrong in (values, replace(trajectory, u=("F",))):
        with pytest.raises(derive.DeriveError, match=r"^(guess|scene 'craft': guess) must be"):
            derive.steer(craft(), values, turn, guess=wrong, **given)
