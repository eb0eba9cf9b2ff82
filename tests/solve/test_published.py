"""Machines of the catalogue give the figures that their sources print, as exactly as printed."""

from collections.abc import Mapping
from functools import cache
from math import sin, sqrt, tan

import numpy as np
import pytest
from numpy.typing import NDArray

from derive.solve.instrument import Instrument, opened
from derive.solve.motions import frequencies, limits, roots

Values = Mapping[str, float]
ROUNDING = 1e-12  # of formulas in closed form
REST = {"q_1": 0.0, "q_2": 0.0, "q_1_dot": 0.0, "q_2_dot": 0.0, "T": 0.0}
SPONG = {"m_1": 1.0, "m_2": 1.0, "l_1": 1.0, "c_1": 0.5, "c_2": 1.0, "I_1": 0.083, "I_2": 0.33,
         "g": 9.8}  # fmt: skip
"""Table 1 of Spong 1995."""
CART = {"M": 0.5, "m": 0.2, "l": 0.3, "I": 0.006, "b": 0.1, "g": 9.8}
"""Of the control tutorials."""
WHEEL = {"m_p": 0.2164, "m_r": 0.0850, "l_p": 0.1173, "l_r": 0.1270, "J_p": 2.233e-4,
         "J_r": 2.495e-5, "g": 9.81}  # fmt: skip
"""Of Block, Astrom & Spong 2007, section 2.5."""
GYROSCOPIC = {"m_p": 0.02, "m_r": 0.3, "l_p": 0.063, "l_r": 0.125, "J_p": 47e-6, "J_r": 32e-6,
              "g": 9.8}  # fmt: skip
"""Of Spong, Corke & Lozano 2001, table 1."""


opened_once = cache(opened)


def slopes(found: Instrument, states: tuple[str, ...], by: tuple[str, ...], at: Values) -> NDArray:
    """Return the derivatives of the rates of states by states or inputs."""
    answer = found.answer("state_rate_jacobian", dict(at))
    rows = [[answer.get(f"d({row}_rate)/d({column})", 0.0) for column in by] for row in states]
    return np.array(rows)


def best_feedback(A: NDArray, B: NDArray) -> NDArray:
    """Return the gain that makes the integral of x.x + u.u smallest: Hamilton's stable half."""
    size = len(A)
    whole = np.block([[A, -B @ B.T], [-np.eye(size), -A.T]])
    values, vectors = np.linalg.eig(whole)
    half = vectors[:, values.real < 0]
    gain: NDArray = (B.T @ half[size:] @ np.linalg.inv(half[:size])).real
    return gain


@pytest.mark.long
def test_an_acrobot_is_held_upright_by_the_gain_that_spong_prints() -> None:
    states = ("q_1", "q_2", "q_1_dot", "q_2_dot")
    acrobot, at = opened_once("acrobot"), SPONG | REST
    A, B = (slopes(acrobot, states, by, at) for by in (states, ("T",)))
    printed = [-246.481, -98.690, -106.464, -50.138]
    assert best_feedback(A, B)[0] == pytest.approx(printed, abs=6e-4)  # its last digit


@pytest.mark.long
def test_the_masses_of_an_acrobot_are_those_of_spongs_equations() -> None:
    """d_11 with q_2 = 0, d_12, d_22 of his equations (1) to (4); upright, weight pulls it over."""
    found = opened_once("acrobot").answer("linearised", SPONG)
    inertia = 0.25 + (1 + 1 + 2) + 0.083 + 0.33, 1 + 1 + 0.33, 1 + 0.33
    assert [found[f"mass_matrix_{n}"] for n in ("1_1", "1_2", "2_2")] == pytest.approx(inertia)
    pull = -9.8 * (0.5 + 1 + 1), -9.8, -9.8
    assert [found[f"stiffness_matrix_{n}"] for n in ("1_1", "1_2", "2_2")] == pytest.approx(pull)


@pytest.mark.long
def test_a_cart_and_its_pendulum_have_the_matrices_and_poles_of_the_tutorials() -> None:
    """Their angle grows the other way round: where the pendulum falls towards -x."""
    states = ("x", "x_dot", "theta", "theta_dot")
    cart, at = opened_once("cart_pendulum"), CART | dict.fromkeys((*states, "F"), 0.0)
    A, B = (slopes(cart, states, by, at) for by in (states, ("F",)))
    other = np.diag([1, 1, -1, -1])
    A, B = other @ A @ other, other @ B
    printed = [[0, 1, 0, 0], [0, -0.1818, 2.6727, 0], [0, 0, 0, 1], [0, -0.4545, 31.1818, 0]]
    rows = A.tolist()
    assert rows == [pytest.approx(row, abs=6e-5) for row in printed]  # their last digit
    assert B[:, 0] == pytest.approx([0, 1.8182, 0, 4.5455], abs=6e-5)
    poles = sorted(np.linalg.eigvals(A).real)
    assert poles == pytest.approx([-5.6041, -0.1428, 0, 5.5651], abs=6e-5)


@pytest.mark.long
def test_a_pendulum_without_inertia_of_its_own_falls_as_textbooks_say() -> None:
    """Unstable pole sqrt((M + m) g/(M l)) of a mass on a stick, the cart without friction."""
    found = opened_once("cart_pendulum")
    answer = found.answer("linearised", CART | {"I": 0.0, "b": 0.0})
    M, K = (np.array([[answer[f"{name}_matrix_{i}_{k}"] for k in (1, 2)] for i in (1, 2)])
            for name in ("mass", "stiffness"))  # fmt: skip
    fastest = max(np.linalg.eigvals(-np.linalg.solve(M, K)))
    m, cart, length, g = (CART[n] for n in ("m", "M", "l", "g"))
    assert sqrt(fastest) == pytest.approx(sqrt((cart + m) * g / (cart * length)), rel=ROUNDING)


def test_a_wheel_pendulum_has_the_figures_of_its_textbook() -> None:
    """J = 4.572e-3 kg m^2; a = 78 and b_p = 1.08, b_r = 198, which a motor's constant multiplies.

    The textbook's wheel has its speed from the inertial axes, ours from the pendulum.
    """
    states, wheel = ("theta", "theta_dot", "s"), opened_once("wheel_pendulum")
    at = WHEEL | dict.fromkeys((*states, "T"), 0.0)
    A, B = (slopes(wheel, states, by, at) for by in (states, ("T",)))
    whole = wheel.answer("linearised", WHEEL)["mass_matrix_1_1"] - WHEEL["J_r"]
    assert whole == pytest.approx(4.572e-3, abs=5e-7)
    assert A[1, 0] == pytest.approx(78, abs=0.5)
    absolute = B[2, 0] + B[1, 0]
    assert absolute / -B[1, 0] == pytest.approx(198 / 1.08, rel=0.005 / 1.08 + 0.5 / 198)


@pytest.mark.long
def test_a_gyroscopic_pendulum_has_the_masses_of_its_paper() -> None:
    """d_11 = 4.83e-3, d_12 = d_22 = 32e-6 kg m^2 and 38.7e-3 kg m, of lengths of three digits."""
    found = opened_once("wheel_pendulum").answer("linearised", GYROSCOPIC)
    assert found["mass_matrix_1_1"] == pytest.approx(4.83e-3, rel=2 * 0.0005 / 0.125)
    assert found["mass_matrix_1_2"] == pytest.approx(32e-6, rel=ROUNDING)
    assert found["mass_matrix_2_2"] == pytest.approx(32e-6, rel=ROUNDING)
    pull = -found["stiffness_matrix_1_1"] / GYROSCOPIC["g"]
    assert pull == pytest.approx(38.7e-3, rel=0.0005 / 0.125)


DISC = {"m": 0.4, "r": 0.2, "g": 9.81}


@pytest.mark.long
def test_a_disc_rolls_upright_from_the_speed_on_that_routh_gives() -> None:
    """Spin^2 > g/(3 r); above it the lean oscillates with omega^2 = 12/5 n^2 - 4/5 g/r."""
    disc, r, g = opened_once("rolling_disc"), DISC["r"], DISC["g"]
    assert limits(disc, DISC, "n") == [pytest.approx(sqrt(g / (3 * r)), rel=1e-6)]  # halved
    lean = sqrt(12 / 5 * 49 - 4 / 5 * g / r)
    assert frequencies(disc, DISC | {"n": 7.0}) == [pytest.approx(lean, rel=ROUNDING)]


@pytest.mark.long
def test_a_disc_runs_round_a_circle_as_the_balance_of_its_moments_demands() -> None:
    """Of a thin disc r W (6 s + 5 W sin(lean)) = -4 g tan(lean)."""
    at = DISC | {"s": 9.0, "lean": 0.3, "lean_dot": 0.0}
    found = [root["W"] for root in roots(opened_once("rolling_disc"), at)]
    assert found
    for W in found:
        turning = W * (6 * at["s"] + 5 * W * sin(at["lean"]))
        assert DISC["r"] * turning == pytest.approx(-4 * DISC["g"] * tan(at["lean"]), rel=1e-9)
