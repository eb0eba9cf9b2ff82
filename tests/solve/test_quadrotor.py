"""The quadrotor of the catalogue hovers, and turns, as the balances of its momenta demand."""

from collections.abc import Mapping
from functools import cache
from math import pi, sqrt
from random import Random

import numpy as np
import pytest
from numpy.typing import NDArray

from derive.solve.instrument import Instrument, opened

CLOSE = 1e-10  # of the largest of a kind: some ten sums in double
TRIES = 5
ROTORS = ("fore", "left", "aft", "right")
SENSES = np.array([1, -1, 1, -1])
ARMS = np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
HUB, TIP, AIR, THRUST = 0.03, 0.165, 1.184, 0.0048
"""Of a rotor of Corke's: its mass, its radius, the air's density, and c_T without a dimension."""
BLADE = (0.005 * (TIP - 0.004) ** 2 + 0.010 * 0.004**2) / 4  # as he takes its moment of inertia
FLYER = {
    "m": 4 - 4 * HUB, "I_x": 0.082 - 2 * HUB * 0.315**2, "I_y": 0.082 - 2 * HUB * 0.315**2,
    "I_z": 0.149 - 4 * HUB * 0.315**2, "d": 0.315, "m_r": HUB, "J_r": 2 * BLADE,
    "c_T": THRUST * AIR * pi * TIP**4, "c_Q": THRUST * sqrt(THRUST / 2) * AIR * pi * TIP**5,
    "g": 9.81,
}  # fmt: skip
"""Data of mdl_quadrotor in Corke's toolbox: 4 kg, moments of all 0.082, 0.082, 0.149 kg m^2."""
AT_REST = dict.fromkeys((*(f"p_{c}{dot}" for c in "xyz" for dot in ("", "_dot")),
                         *(f"w_{c}" for c in "xyz")), 0.0)  # fmt: skip
LEVEL = {f"attitude_hull_{c}": float(c == "w") for c in "wxyz"}

pytestmark = pytest.mark.long
opened_once = cache(opened)


def flyer() -> Instrument:
    return opened_once("quadrotor")


@pytest.mark.long
@pytest.mark.whole
def test_four_equal_rotors_hold_it_where_thrust_is_weight() -> None:
    """sqrt(m g/(4 b)), b = 1.3234e-5: 861 rad/s; drag k = 1.0697e-7 is what motors balance."""
    assert FLYER["c_T"] == pytest.approx(1.3234e-5, abs=5e-10)
    assert FLYER["c_Q"] == pytest.approx(1.0697e-7, abs=5e-12)
    speed = sqrt(4 * 9.81 / (4 * FLYER["c_T"]))
    assert speed == pytest.approx(861, abs=0.5)
    at = FLYER | AT_REST | LEVEL | {f"s_{n}": speed for n in ROTORS}
    at |= {f"u_{n}": FLYER["c_Q"] * speed**2 for n in ROTORS}
    rates = flyer().answer("state_rate", at)
    assert max(map(abs, rates.values())) < CLOSE * 9.81


def test_it_moves_as_the_momenta_of_airframe_and_rotors_demand() -> None:
    """Newton's law of the whole, Euler's of the whole and of each rotor, as Mahony et al. do."""
    found, dice = flyer(), Random("flyer")
    ranges = {c: (float(q.low or -1), float(q.high or 1)) for q in found.quantities()
              for c in q.components}  # fmt: skip
    for _ in range(TRIES):
        at = {c: dice.uniform(low, high) for c, (low, high) in ranges.items()} | FLYER
        q = np.array([at[f"attitude_hull_{c}"] for c in "wxyz"])
        q /= np.linalg.norm(q)
        at |= dict(zip((f"attitude_hull_{c}" for c in "wxyz"), map(float, q), strict=True))
        answer = found.answer("state_rate", at)
        for names, own in by_hand(at, q):
            close = CLOSE * max(abs(own))
            assert [answer[n] for n in names] == pytest.approx(own, rel=0, abs=close)


def by_hand(at: Mapping[str, float], q: NDArray) -> list[tuple[list[str], NDArray]]:
    """Return names of rates and their values, by the balances of the whole and of each rotor."""
    s, u = (np.array([at[f"{n}_{r}"] for r in ROTORS]) for n in "su")
    w = np.array([at[f"w_{c}"] for c in "xyz"])
    arm, J = at["m_r"] * at["d"] ** 2, at["J_r"]
    whole = np.array([at["I_x"] + 2 * arm + 2 * J, at["I_y"] + 2 * arm + 2 * J,
                      at["I_z"] + 4 * arm])  # fmt: skip
    thrust = np.outer(at["c_T"] * s**2, [0, 0, 1])
    motors, drag = SENSES * u, -SENSES * at["c_Q"] * s**2
    outer = np.cross(at["d"] * ARMS, thrust).sum(axis=0)
    rotors = np.array([0, 0, J * (SENSES @ s)])  # their own momentum about z, which motors change
    turned = (outer - [0, 0, motors.sum()] - np.cross(w, whole * w + rotors)) / whole
    spun = SENSES * (motors + drag) / J
    mass = at["m"] + 4 * at["m_r"]
    lift = rotated(q, thrust.sum(axis=0)) / mass - [0, 0, at["g"]]
    return [
        ([f"p_{c}_dot_rate" for c in "xyz"], lift),
        ([f"w_{c}_rate" for c in "xyz"], turned),
        ([f"s_{r}_rate" for r in ROTORS], spun),
    ]


def rotated(q: NDArray, v: NDArray) -> NDArray:
    """Return v turned by a unit quaternion, scalar first."""
    turned: NDArray = v + 2 * np.cross(q[1:], np.cross(q[1:], v) + q[0] * v)
    return turned


def test_the_bearings_of_its_rotors_pass_their_gyroscopic_moments_on() -> None:
    """J_r s (e_z x w), each rotor its own way round, and what turns flat rotors along with it."""
    speeds = dict(zip(ROTORS, (900.0, 700.0, 800.0, 600.0), strict=True))
    at = FLYER | AT_REST | LEVEL | {"w_x": 1.5, "w_y": -2.0, "w_z": 0.5}
    at |= {f"s_{n}": x for n, x in speeds.items()} | {f"u_{n}": 0.1 for n in ROTORS}
    rates, w = flyer().answer("state_rate", at), np.array([1.5, -2.0, 0.5])
    flat = 4 * FLYER["J_r"] * np.array([0.5, 0.5, 0])
    spun = np.array([0, 0, FLYER["J_r"] * (900 - 700 + 800 - 600)])
    turned = np.array([rates[f"w_{c}_rate"] for c in "xyz"])
    own = -(flat * turned + np.cross(w, flat * w + spun))
    found = flyer().answer("gyro", at)
    assert (found["gyro_x"], found["gyro_y"]) == pytest.approx(own[:2], rel=1e-10)
