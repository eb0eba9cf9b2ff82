"""Wheels relieved by the gravity gradient; flown again by angular momentum in the inertial frame.

What is flown shares no algebra with the scene: it carries the attitude in the inertial frame, the
whole angular momentum there and that of each wheel along its axis, and knows no frame of the orbit.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import derive

SCENE = Path(__file__).parents[1] / "data" / "control" / "dumping.toml"
CRAFT = {"A": 600, "B": 700, "C": 250, "I_w": 0.05, "n": 0.0011}
WHEELS = {"s_x": 6, "s_y": 20, "s_z": -4}
MOMENTS, RATE = np.array([600, 700, 250]), CRAFT["n"]
UNTIL = 3000.0  # s, about half an orbit
SUBSTEPS = 100  # of an element
CLOSE = 1e-7  # of the attitude, of the rates, of the fastest wheel
Array = np.ndarray


@pytest.fixture(scope="module")
def found() -> derive.Trajectory:
    """Return the turn to and fro that leaves the wheels at rest, by the least of their motors."""
    end = {"attitude_hub_w": 1} | dict.fromkeys(("w_x", "w_y", "w_z", *WHEELS), 0)
    cost = {"energy": 1}
    scene = derive.load(SCENE)
    return derive.steer(scene, CRAFT | WHEELS, end=end, cost=cost, until=UNTIL, starts=2)


@pytest.mark.long
def test_the_momentum_of_wheels_is_taken_out_by_attitude_alone(found: derive.Trajectory) -> None:
    assert found.missed < 1e-8
    assert found.conditions is not None
    assert found.conditions.worst < 1e-6
    assert found.cost == pytest.approx(1.3377276e-3, rel=1e-7)
    leans = [np.abs(found.states[f"attitude_hub_{c}"]).max() for c in "xyz"]
    assert max(leans) > 0.2  # it must lean to be turned by the gradient
    assert all(abs(found.states[name][-1]) < 1e-8 for name in WHEELS)


@pytest.mark.long
@pytest.mark.parametrize("field", [1.0, 0.0], ids=["in the field", "without it"])
def test_the_inputs_flown_in_the_inertial_frame_lead_there_if_there_is_a_field(
    field: float, found: derive.Trajectory
) -> None:
    state = np.array([1, 0, 0, 0, *(MOMENTS * [0, -RATE, 0]), 0, 0, 0])
    spins = CRAFT["I_w"] * np.array([*WHEELS.values()])
    state[4:7] += spins
    state[7:] = CRAFT["I_w"] * np.array([0, -RATE, 0]) + spins
    for begin, lasts in zip(found.times, np.diff(found.times), strict=False):
        state = flown(state, begin, lasts, field, lambda t: found._inputs_at(t))
    turned = rotation(state[:4])
    omega = (turned.T @ state[4:7] - state[7:]) / (MOMENTS - CRAFT["I_w"])
    half = -RATE * UNTIL / 2
    orbit = rotation(np.array([np.cos(half), 0, np.sin(half), 0]))
    wheels = np.abs(state[7:] / CRAFT["I_w"] - omega).max()
    astray = max(np.abs(turned - orbit).max(), np.abs(omega - [0, -RATE, 0]).max() / RATE)
    assert (astray < CLOSE) == (wheels < CLOSE * WHEELS["s_y"]) == bool(field)


def flown(state: Array, begin: float, lasts: float, field: float, inputs: Callable) -> Array:
    """Return the state after an element, by classic steps."""
    step = lasts / SUBSTEPS
    for k in range(SUBSTEPS):
        t = begin + k * step
        u = [inputs(min(t + part * step, (begin + lasts) * (1 - 1e-12))) for part in (0, 0.5, 1)]
        a = rate(state, t, u[0], field)
        b = rate(state + step / 2 * a, t + step / 2, u[1], field)
        c = rate(state + step / 2 * b, t + step / 2, u[1], field)
        state = state + step / 6 * (
            a + 2 * b + 2 * c + rate(state + step * c, t + step, u[2], field)
        )
    return state


def rate(state: Array, time: float, u: Array, field: float) -> Array:
    """Return the rate of attitude, of the momentum in the inertial frame and of that of wheels."""
    q, momentum, wheels = np.split(state, [4, 7])
    turned = rotation(q)
    omega = (turned.T @ momentum - wheels) / (MOMENTS - CRAFT["I_w"])
    down = np.array([-np.sin(RATE * time), 0, np.cos(RATE * time)])
    moment = 3 * RATE**2 * np.cross(down, turned @ (MOMENTS * (turned.T @ down)))
    w, v = q[0], q[1:]
    return np.array([-v @ omega / 2, *(w * omega + np.cross(v, omega)) / 2, *(field * moment), *u])


def rotation(q: Array) -> Array:
    """Return the matrix from body to inertial axes of a quaternion, whatever its length."""
    w, x, y, z = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
