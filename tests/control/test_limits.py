"""Limits on the way: of speeds, of directions; scenes that are machines; and their plain words."""

import tomllib
from decimal import Decimal
from itertools import pairwise

import numpy as np
import pytest

import derive
from tests.control.crafts import craft, inertia

CART = {"M": 0.5, "m": 0.2, "l": 0.3, "I": 0.006, "b": 0.1, "g": 9.8}


@pytest.mark.long
def test_a_limit_of_a_speed_holds_and_costs() -> None:
    values = inertia((1, 2, 3))
    free = derive.steer(craft(), values, "x 2", limits={"moment": 0.8}, starts=1)
    trajectory = derive.steer(
        craft(), values, "x 2", limits={"moment": 0.8, "omega_x": 0.6}, starts=1
    )
    assert free.cost < trajectory.cost
    assert np.abs(trajectory.states["omega_x"]).max() <= 0.6 + 1e-7
    assert trajectory.refined is None
    assert trajectory.unrefined == "omega_x comes to its limit on the way"


@pytest.mark.long
@pytest.mark.whole
def test_a_limit_of_what_a_function_tells_holds_and_costs() -> None:
    """The craft wants no angular momentum for itself; what it has is told by its own moments."""
    moments = (1, 2, 3)
    values, limits = inertia(moments), {"moment": 0.8}
    free, slow, poor = (
        derive.steer(craft(), values, "1,2,2 2", limits=limits | more, starts=1)
        for more in ({}, {"angular_momentum": 0.9}, {"kinetic_energy": "0..0.3"})
    )
    omega = [np.array([one.states[f"omega_{c}"] for c in "xyz"]) for one in (free, slow, poor)]
    momenta = [np.abs(np.diag(moments) @ w).max() for w in omega]
    energies = [(np.diag(moments) @ w * w).sum(axis=0).max() / 2 for w in omega]
    assert momenta[0] > 1.2 > 0.9 + 1e-6 > momenta[1] > 0.9 - 1e-6
    assert energies[0] > 0.6 > 0.3 + 1e-6 > energies[2] > 0.3 - 1e-6
    assert free.cost < min(slow.cost, poor.cost)
    assert slow.unrefined == "angular_momentum_y comes to its limit on the way"


@pytest.mark.long
@pytest.mark.whole
def test_a_limit_of_a_force_holds_of_states_and_inputs() -> None:
    scene, spread, costs = derive.load("cart_pendulum"), [], []
    force = scene.function("rail", CART)
    for more in ({}, {"rail": "6.65..7.08"}):
        ends, limits = {"x": 1, "theta": 0, "x_dot": 0, "theta_dot": 0}, {"F": 10, **more}
        one = derive.steer(
            scene, CART, end=ends, limits=limits, cost={"energy": 1}, until=1.3, starts=1
        )
        told = force(*one.grid.x[1:, :-1], one.grid.u[0])
        spread.append((told.min(), told.max()))
        costs.append(one.cost)
    assert spread[0][0] < 6.63 < 7.09 < spread[0][1]
    assert 6.65 - 1e-6 < spread[1][0] < spread[1][1] < 7.08 + 1e-6
    assert costs[0] < costs[1]
    assert one.unrefined.startswith("rail comes to its limit")


@pytest.mark.long
@pytest.mark.whole
def test_an_axis_keeps_out_of_a_cone() -> None:
    values, limits = inertia((1, 1, 1)), {"moment": 1.0}
    free = derive.steer(craft(), values, "z 90deg", limits=limits, starts=2)
    trajectory = derive.steer(
        craft(), values, "z 90deg", limits=limits, starts=2, avoid=["x 1,1,0 20deg"]
    )
    assert free.cost < trajectory.cost
    w, x, y, z = (trajectory.states[f"attitude_{c}"] for c in "wxyz")
    seen = np.array([w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)])
    assert (np.array([1, 1, 0]) / np.sqrt(2) @ seen).max() <= np.cos(np.radians(20)) + 1e-7


@pytest.mark.long
def test_an_end_that_leaves_the_attitude_open_is_outside_of_the_cone() -> None:
    """To stop takes all the time that there is; without a cone the axis ends inside of this one."""
    values, avoid = {**inertia((1, 1, 1)), "omega_z": 1.0}, ["x 1,1,0 20deg"]
    given = {"end": {"omega": 0}, "cost": {"energy": 1}, "until": 1.6, "starts": 1}
    edge = np.cos(np.radians(20))
    for kept in ([], avoid):
        one = derive.steer(craft(), values, limits={"moment": 2.0}, avoid=kept, **given)
        w, x, y, z = (one.states[f"attitude_{c}"][-1] for c in "wxyz")
        towards = w * w + x * x - y * y - z * z + 2 * (x * y + w * z)
        assert (towards / np.sqrt(2) <= edge + 1e-7) == bool(kept)


TENSOR = np.array([[1.2, -0.02, -0.01], [-0.02, 1.5, 0.03], [-0.01, 0.03, 0.9]])
WHEEL = 0.002
WHEELS = {f"J_{a}{a}": TENSOR[k, k] for k, a in enumerate("xyz")} | {"I_w": WHEEL}
WHEELS |= {"J_xy": -TENSOR[0, 1], "J_xz": -TENSOR[0, 2], "J_yz": -TENSOR[1, 2]}


@pytest.mark.long
@pytest.mark.whole
def test_a_satellite_on_wheels_turns_later_where_a_wheel_comes_to_its_limit() -> None:
    text = derive.load("reaction_wheel_satellite").scene.text
    document = tomllib.loads(text, parse_float=Decimal)
    document["frames"]["hub"]["attitude"] = "quaternion"
    scene = derive.load(document | {"wanted": ["state_rate"]}, name="wheels")
    free, bound = (
        derive.steer(scene, WHEELS, "1,2,2 60deg", limits={"u_1": 0.05, **more}, starts=2)
        for more in ({}, {f"s_{k}": 100 for k in (1, 2, 3)})
    )
    assert free.missed < 1e-9
    assert free.conditions is not None
    assert free.conditions.worst < 1e-7
    assert max(np.abs(free.states[f"s_{k}"]).max() for k in (1, 2, 3)) > 101
    assert max(np.abs(bound.states[f"s_{k}"]).max() for k in (1, 2, 3)) <= 100 * (1 + 1e-7)
    assert free.until < bound.until < 1.01 * free.until
    for one in (free, bound):  # begun at rest, the whole keeps no angular momentum
        omega = np.array([one.states[f"w_{k}"] for k in "xyz"])
        spin = np.array([one.states[f"s_{k}"] for k in "123"])
        assert np.abs(TENSOR @ omega + WHEEL * spin).max() < 1e-8


@pytest.mark.long
@pytest.mark.whole
def test_a_cart_swings_its_pendulum_up() -> None:
    trajectory = derive.steer(
        derive.load("cart_pendulum"),
        {**CART, "theta": np.pi},
        end={"x": 0, "theta": 0, "x_dot": 0, "theta_dot": 0},
        limits={"F": 10, "x": 2},
        cost={"energy": 1},
        until=2.5,
        starts=2,
    )
    assert trajectory.cost == pytest.approx(10.47994, rel=1e-5)
    assert trajectory.missed < 1e-6
    assert trajectory.doubts[0].startswith("theta comes to 4.6")


@pytest.mark.long
def test_what_is_given_outside_of_its_range_is_told() -> None:
    told = derive.steer(craft(), inertia((0.4, 0.5, 0.6)), "x 1", limits={"moment": 1}, starts=1)
    assert told.doubts == (
        "I_x is 0.4, outside of its range, 0.5 to 9000, for which its errors are stated",
    )


@pytest.mark.long
def test_a_tumbling_body_is_stopped_in_the_time_that_its_moments_need() -> None:
    values = {**inertia((1, 2, 3)), "omega_x": 0.5}
    limits = {"moment": 0.8}
    found = derive.steer(craft(), values, end={"omega": 0}, limits=limits, starts=1)
    assert found.until == pytest.approx(0.5 / 0.8, rel=1e-6)


@pytest.mark.long
@pytest.mark.whole
def test_a_part_of_an_attitude_may_be_the_end() -> None:
    values = {**inertia((1, 2, 3)), "attitude_w": 0.6, "attitude_x": 0.8}
    end = {"attitude_x": 0, "attitude_y": 0, "omega": 0}
    found = derive.steer(craft(), values, end=end, limits={"moment": 0.8}, starts=3)
    assert abs(found.states["attitude_x"][-1]) + abs(found.states["attitude_y"][-1]) < 1e-9
    assert abs(found.states["attitude_z"][-1]) > 1e-3  # free, and used


@pytest.mark.long
@pytest.mark.parametrize("cost", [{"time": 1}, {"energy": 1}])
def test_inputs_held_from_row_to_row_of_the_table_lead_to_the_end(cost) -> None:
    values, until = inertia((1, 2, 3)), None if "time" in cost else 5
    found = derive.steer(
        craft(), values, "1,2,2 1.5", limits={"moment": 0.4}, cost=cost, until=until, starts=2
    )
    rows = np.array([[float(v) for v in row.split(",")] for row in found.table().split()[1:]])
    assert np.abs(rows[:, 8:]).max() <= 0.4 * (1 + 1e-7)
    step = craft().function("step_taylor12", dict(values))
    q, omega = rows[0, 1:5], rows[0, 5:8]
    for row, after in pairwise(rows):
        q, omega, _ = step(q, omega, row[8:], after[0] - row[0])
    assert np.abs(np.array([*q, *omega]) - rows[-1, 1:8]).max() < 1e-6


@pytest.mark.long
def test_a_table_and_a_plot_show_the_way() -> None:
    trajectory = derive.steer(craft(), inertia((1, 2, 3)), "x 1", limits={"moment": 1}, starts=1)
    head, first, *_, last = trajectory.table().splitlines()
    states = [f"attitude_{c}" for c in "wxyz"] + [f"omega_{c}" for c in "xyz"]
    assert head.split(",") == ["time", *states, *(f"moment_{c}" for c in "xyz")]
    assert [float(v) for v in first.split(",")][:5] == [0, 1, 0, 0, 0]
    assert float(last.split(",")[0]) == pytest.approx(trajectory.until)
    assert trajectory.plot().count("<polyline") == 13


@pytest.mark.long
def test_a_finer_grid_that_leads_elsewhere_is_left_and_what_misses_the_end_is_said() -> None:
    """From 40 steps a cart is there in 6.8 s; 200 steps once led to 19.8 s and 0.13 beside it."""
    limits, end = {"F": 10, "rail": "6..9"}, {"x": 1}
    found = derive.steer(
        derive.load("cart_pendulum"), {**CART, "g": 9.81}, end=end, limits=limits, until=1, starts=1
    )
    assert found.cost < 1.05 * min(c for c in found.found if c is not None)
    told = [doubt for doubt in found.doubts if "miss the end" in doubt]
    assert bool(told) == (found.missed > 1e-4)
    assert np.abs(found.inputs[1]["F"]).max() <= 10
