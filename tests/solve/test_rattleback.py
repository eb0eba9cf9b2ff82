"""The rattleback of the catalogue moves as Kane and Levinson's does, and as others found since."""

from collections.abc import Mapping
from functools import cache
from math import radians
from random import Random

import numpy as np
import pytest
from numpy.typing import NDArray
from sympy import Matrix, cos, lambdify, sin, symbols

from derive.solve.instrument import Instrument, opened
from derive.solve.motions import eigenvalues
from derive.solve.simulation import simulated

STONE = {"m": 1.0, "a": 0.2, "b": 0.03, "c": 0.02, "h": 0.01, "A": 2e-4, "B": 16e-4, "C": 17e-4,
         "D": -2e-5, "g": 9.81}  # fmt: skip
"""Theirs: 20, 3, 2, 1 cm; 2, 16, 17 and -0.2 cm^2 by mass."""
TRIES = 5
CLOSE = 1e-9  # of the largest: mass matrices of conditions below a thousand, twice in double
STEP = 2.5e-4  # s
KEPT = 1e-6  # of the energy: a step of the fast oscillation loses (110 STEP)^6/72, 5e4 of them

pytestmark = pytest.mark.long
opened_once = cache(opened)


def stone() -> Instrument:
    return opened_once("rattleback")


def kane_and_levinson(given: Mapping[str, float], mu: NDArray, u: NDArray) -> NDArray:
    """Return the rates of omega by their equations, about what touches the floor, by mass.

    mu : (3,) downwards, and u : (3,) omega in rad/s, both along body axes of which the third
        points down. Source: Kane & Levinson 1982, with what is theirs written as vectors.
    """
    squares = np.array([given[n] ** 2 for n in "abc"])
    A, B, C, D, m = (given[n] for n in ("A", "B", "C", "D", "m"))
    inertia = np.array([[A, D, 0], [D, B, 0], [0, 0, C]]) / m
    length = np.sqrt(squares @ mu**2)
    x = squares * mu / length - np.array([0, 0, given["h"]])
    turning = np.cross(mu, u)
    along = squares * (turning / length - mu * (squares @ (mu * turning)) / length**3)
    left = inertia + x @ x * np.eye(3) - np.outer(x, x)
    moment = given["g"] * np.cross(mu, x) + np.cross(inertia @ u, u)
    moment += np.cross(x, np.cross(u, np.cross(x, u) - along))
    return np.linalg.solve(left, moment)


@pytest.mark.long
@pytest.mark.whole
def test_a_rattleback_moves_by_the_equations_of_kane_and_levinson() -> None:
    """Our third axis points up, so that two axes are turned round; omega is differentiated."""
    alpha, beta, W = (symbols(n) for n in ("alpha", "beta", "W"))
    rates = symbols("alpha_dot beta_dot")
    up = Matrix([-sin(beta) * cos(alpha), sin(alpha), cos(beta) * cos(alpha)])
    omega = W * up + rates[0] * Matrix([cos(beta), 0, sin(beta)]) + Matrix([0, rates[1], 0])
    slopes = lambdify((alpha, beta, *rates, W), omega.jacobian([alpha, beta, *rates, W]))
    values = lambdify((alpha, beta, *rates, W), omega)
    ups = lambdify((alpha, beta), up)
    round_, dice = np.array([1.0, -1.0, -1.0]), Random("stone")
    reach = {"alpha": 0.4, "beta": 0.06, "alpha_dot": 5.0, "beta_dot": 5.0, "W": 6.0}
    for _ in range(TRIES):
        at = {name: dice.uniform(-x, x) for name, x in reach.items()}
        answer = stone().answer("state_rate", STONE | at)
        rate = np.array([answer[f"{name}_rate"] for name in at])
        ours = slopes(*at.values()) @ rate
        down = -ups(at["alpha"], at["beta"])[:, 0]
        theirs = kane_and_levinson(STONE, round_ * down, round_ * values(*at.values())[:, 0])
        assert round_ * ours == pytest.approx(theirs, rel=0, abs=CLOSE * max(abs(theirs)))


def modes(spin: float) -> list[complex]:
    """Return the slow and the fast oscillation, roll and pitch, as eigenvalues."""
    found = eigenvalues(stone().answer("linearised", STONE | {"n": spin}))
    return sorted((x for x in found if x.imag > 0), key=lambda x: x.imag)


def test_pitch_grows_in_one_sense_of_the_spin_and_roll_in_the_other() -> None:
    """Bondi 1986: both grow by the spin; the sense in which pitch grows turns back the sooner."""
    for spin in (-5.0, -1.0, 1.0, 5.0):
        roll, pitch = modes(spin)
        assert (roll.real > 0, pitch.real > 0) == (spin < 0, spin > 0)
        assert abs(pitch.real) > 5 * abs(roll.real)


def test_slow_spins_let_the_oscillations_grow_as_their_squared_frequencies() -> None:
    """Garcia & Hubbard 1988: all else in the two growths is the same, but of opposite sign."""
    spin = 1e-3
    roll, pitch = modes(spin)
    expected = -((pitch.imag / roll.imag) ** 2)
    assert pitch.real / roll.real == pytest.approx(expected, rel=spin)  # the spin squared, halved


def test_a_rattleback_that_is_spun_turns_back_soon_in_one_sense_and_late_in_the_other() -> None:
    """At 5 rad/s and half a degree, as Kane and Levinson start it; it keeps its energy."""
    sooner, later = 4.0, 13.0
    back = {}
    for spin, until in ((5.0, sooner), (-5.0, later)):
        start = dict.fromkeys(("alpha", "beta"), radians(0.5))
        start |= {"alpha_dot": 0.0, "beta_dot": 0.0, "W": spin, "n": spin}
        motion = simulated(stone(), STONE | start, until, STEP)
        W = np.array(motion.states["W"])
        assert min(W * spin) < 0
        back[spin] = motion.times[int(np.argmax(W * spin < 0))]
        ends = [{n: row[k] for n, row in motion.states.items()} for k in (0, -1)]
        first, last = (stone().answer("energy_of_all", STONE | e)["energy_of_all"] for e in ends)
        assert last == pytest.approx(first, rel=KEPT)
    assert 2 * back[5.0] < sooner + back[5.0] < back[-5.0]
