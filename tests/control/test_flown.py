"""Wheels relieved by the gravity gradient, skew thrusters: flown again in the inertial frame."""

from pathlib import Path

import numpy as np
import pytest

import derive
from tests.control.inertial import Array, Body, rotation

SCENES = Path(__file__).parents[1] / "data" / "control"
CRAFT = {"A": 600, "B": 700, "C": 250, "I_w": 0.05, "n": 0.0011}
WHEELS = {"s_x": 6, "s_y": 20, "s_z": -4}
RATE, UNTIL = CRAFT["n"], 3000.0  # s, about half an orbit
CLOSE = 1e-7  # of the attitude, of the rates, of the fastest wheel
SKEW = {"I_xx": 10, "I_yy": 12, "I_zz": 7, "I_xy": 0.5, "I_xz": -0.3, "I_yz": 0.2}
SKEW |= {"J": 0.02, "l": 0.5}
LINES = 40  # of a scene that is no one's but its user's


@pytest.fixture(scope="module")
def relieved() -> derive.Trajectory:
    """Return the turn to and fro that leaves the wheels at rest, by the least of their motors."""
    end = {"attitude_hub_w": 1} | dict.fromkeys(("w_x", "w_y", "w_z", *WHEELS), 0)
    cost = {"energy": 1}
    scene = derive.load(SCENES / "dumping.toml")
    return derive.steer(scene, CRAFT | WHEELS, end=end, cost=cost, until=UNTIL, starts=2)


@pytest.mark.long
@pytest.mark.whole
def test_the_momentum_of_wheels_is_taken_out_by_attitude_alone(relieved) -> None:
    assert relieved.missed < 1e-8
    assert relieved.conditions.worst < 1e-6
    assert relieved.cost == pytest.approx(1.3377276e-3, rel=1e-7)
    leans = [np.abs(relieved.states[f"attitude_hub_{c}"]).max() for c in "xyz"]
    assert max(leans) > 0.2  # it must lean to be turned by the gradient
    assert all(abs(relieved.states[name][-1]) < 1e-8 for name in WHEELS)


@pytest.mark.long
@pytest.mark.parametrize("field", [1.0, 0.0], ids=["in the field", "without it"])
def test_its_inputs_lead_there_in_the_inertial_frame_if_there_is_a_field(field, relieved) -> None:
    inertia = np.diag([CRAFT[n] for n in "ABC"])

    def gradient(time: float, turned: Array, _: Array) -> Array:
        down = np.array([-np.sin(RATE * time), 0, np.cos(RATE * time)])
        return field * 3 * RATE**2 * np.cross(down, turned @ inertia @ turned.T @ down)

    body = Body(inertia, np.full(3, CRAFT["I_w"]), gradient, lambda u: u)
    orbit = np.array([0, -RATE, 0])
    turned, omega, spins = body.rates(
        body.flown(body.state(orbit, np.array([*WHEELS.values()])), relieved)
    )
    half = -RATE * UNTIL / 2
    there = rotation(np.array([np.cos(half), 0, np.sin(half), 0]))
    astray = max(np.abs(turned - there).max(), np.abs(omega - orbit).max() / RATE)
    assert (astray < CLOSE) == (np.abs(spins).max() < CLOSE * WHEELS["s_y"]) == bool(field)


@pytest.mark.long
@pytest.mark.whole
def test_two_skew_thrusters_and_a_wheel_turn_a_craft_with_a_full_tensor_fastest() -> None:
    scene = SCENES / "skew_thrusters.toml"
    assert len(scene.read_text("utf-8").splitlines()) <= LINES
    limits = {"f_1": 1, "f_2": 1, "u_z": 0.2}
    found = derive.steer(derive.load(scene), SKEW, "1,1,1 90deg", limits=limits, starts=4)
    assert found.missed < 1e-9
    assert found.conditions is not None
    assert found.conditions.worst < 1e-7
    assert found.until == pytest.approx(10.51815753, rel=1e-8)
    arms = SKEW["l"] * np.array([[0.8, -0.4], [0.5, 0.9], [0, 0.1]])
    xy, xz, yz = (-SKEW[f"I_{ab}"] for ab in ("xy", "xz", "yz"))  # I_xy is + sum x y dm
    inertia = np.diag([SKEW[f"I_{a}{a}"] for a in "xyz"]).astype(float)
    inertia += [[0, xy, xz], [xy, 0, yz], [xz, yz, 0]]
    first, last = found.u.index("f_1"), found.u.index("u_z")
    body = Body(
        inertia,
        np.array([0, 0, SKEW["J"]]),
        lambda _, turned, u: turned @ arms @ u[first : first + 2],
        lambda u: np.array([0, 0, u[last]]),
    )
    turned, omega, spins = body.rates(body.flown(body.state(np.zeros(3), np.zeros(3)), found))
    axis = np.ones(3) / np.sqrt(3) * np.sin(np.pi / 4)
    there = rotation(np.array([np.cos(np.pi / 4), *axis]))
    assert np.abs(turned - there).max() < CLOSE
    assert np.abs(omega).max() < CLOSE
    assert spins[2] == pytest.approx(found.states["s_z"][-1], rel=1e-6)
