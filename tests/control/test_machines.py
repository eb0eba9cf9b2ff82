"""Machines steered: a pendulum on an arm swung up, a heavy top erected; energies tell."""

from pathlib import Path

import numpy as np
import pytest

import derive

SCENES = Path(__file__).parents[1] / "data" / "control"
TOP = {"m": 0.6, "l": 0.05, "A": 2e-3, "C": 5e-4, "g": 9.8}
ARM = {"J": 2e-3, "r": 0.2, "m": 0.1, "l": 0.15, "I": 1e-3, "I_3": 5e-5, "g": 9.8}


@pytest.mark.long
@pytest.mark.whole
def test_a_heavy_top_is_erected_by_two_moments() -> None:
    half = 1.0
    start = {"attitude_top_w": np.cos(half), "attitude_top_x": np.sin(half)}
    upright = {"attitude_top_w": 1, "w_x": 0, "w_y": 0}
    limits = {"u_x": 0.2, "u_y": 0.2}
    scene = derive.load(SCENES / "erected_top.toml")
    found = derive.steer(scene, TOP | start, end=upright, limits=limits, until=1, starts=4)
    assert found.missed < 1e-8
    assert found.conditions is not None
    assert found.conditions.worst < 1e-7
    assert np.abs(found.states["w_z"]).max() < 1e-9  # a symmetrical top keeps its spin
    times, inputs = found.inputs
    assert all(np.abs(u).max() <= 0.2 * (1 + 1e-9) for u in inputs.values())
    assert times[-1] < found.until


@pytest.mark.long
@pytest.mark.whole
def test_a_pendulum_on_a_driven_arm_is_swung_up_by_the_work_of_the_motor() -> None:
    scene = derive.load(SCENES / "furuta.toml")
    end = dict.fromkeys(("psi", "theta", "psi_dot", "theta_dot"), 0)
    found = derive.steer(
        scene, ARM | {"theta": np.pi}, end=end, cost={"energy": 1}, until=1.5, limits={"T": 0.2},
        starts=1, steps=200,
    )  # fmt: skip
    assert found.missed < 1e-5
    times, inputs = found.inputs
    rate = np.interp(times, found.times, found.states["psi_dot"])
    work = np.trapezoid(inputs["T"] * rate, times)
    gained = 2 * ARM["m"] * ARM["g"] * ARM["l"]
    assert work == pytest.approx(gained, rel=2e-2)  # psi_dot is straight between nodes here
