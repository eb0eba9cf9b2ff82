"""Machines of the catalogue move as Lagrange's equations of their energies say, written by hand.

Energies come from places in the inertial frame; rolling is a constraint with multipliers. Nothing
of it stands in the package, which balances forces and moments.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from random import Random
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from sympy import Expr, Matrix, Rational, Symbol, cos, hessian, lambdify, sin, symbols

from derive.solve.instrument import opened
from tests.made import thinned

CLOSE = 1e-10  # of the largest acceleration: a few solutions of small systems in double
TRIES = 5


@dataclass(frozen=True)
class ByHand:
    """Energies, forces and constraints of coordinates and their rates, as symbols.

    held : what is zero, linear in the rates
    """

    kinetic: Expr
    potential: Expr
    forces: Sequence[Expr]
    at: Sequence[Symbol]
    rates: Sequence[Symbol]
    held: Sequence[Expr] = ()

    def accelerations(self, values: dict[Symbol, float]) -> NDArray[Any]:
        """Return the second derivatives of the coordinates."""
        q, v = Matrix(self.at), Matrix(self.rates)
        momenta = Matrix([self.kinetic]).jacobian(v)
        left = Matrix([self.kinetic - self.potential]).jacobian(q).T + Matrix(self.forces)
        left -= momenta.jacobian(q) * v
        rows = Matrix(list(self.held)).jacobian(v) if self.held else Matrix(0, len(q), [])
        right = -((rows * v).jacobian(q) * v) if self.held else Matrix(0, 1, [])
        parts = (hessian(self.kinetic, list(v)), rows, left, right)
        M, A, f, b = (_valued(part, values) for part in parts)
        whole = np.block([[M, -A.T], [A, np.zeros((len(A), len(A)))]])
        found: NDArray[Any] = np.linalg.solve(whole, np.concatenate([f[:, 0], b[:, 0]]))
        return found[: len(q)]


def _valued(part: Any, values: dict[Symbol, float]) -> NDArray[Any]:
    found = lambdify(list(values), part)(*values.values())
    return np.asarray(found, dtype=float).reshape(part.shape)


def swung(length: Any, angle: Any) -> Matrix:
    """Return where a link from the origin ends, of its angle from the vertical."""
    return Matrix([length * sin(angle), length * cos(angle)])


def moving(place: Matrix, q: Sequence[Symbol], v: Sequence[Symbol]) -> Matrix:
    return place.jacobian(Matrix(q)) * Matrix(v)


def acrobot() -> ByHand:
    m1, m2, l1, c1, c2, I1, I2, g, T = symbols("m_1 m_2 l_1 c_1 c_2 I_1 I_2 g T")
    q, v = symbols("q_1 q_2"), symbols("q_1_dot q_2_dot")
    upper, lower = swung(c1, q[0]), swung(l1, q[0]) + swung(c2, q[0] + q[1])
    moves = moving(upper, q, v), moving(lower, q, v)
    kinetic = (m1 * moves[0].dot(moves[0]) + m2 * moves[1].dot(moves[1])
               + I1 * v[0] ** 2 + I2 * (v[0] + v[1]) ** 2) / 2  # fmt: skip
    return ByHand(kinetic, g * (m1 * upper[1] + m2 * lower[1]), (0, T), q, v)


def cart_pendulum() -> ByHand:
    cart, m, length, inertia, b, g, F = symbols("M m l I b g F")
    q, v = symbols("x theta"), symbols("x_dot theta_dot")
    bob = Matrix([q[0], 0]) + swung(length, q[1])
    move = moving(bob, q, v)
    kinetic = (cart * v[0] ** 2 + m * move.dot(move) + inertia * v[1] ** 2) / 2
    return ByHand(kinetic, m * g * bob[1], (F - b * v[0], 0), q, v)


def wheel_pendulum() -> ByHand:
    mp, mr, lp, lr, Jp, Jr, g, T = symbols("m_p m_r l_p l_r J_p J_r g T")
    q, v = symbols("theta turned"), symbols("theta_dot s")
    moves = [moving(swung(each, q[0]), q, v) for each in (lp, lr)]
    kinetic = (mp * moves[0].dot(moves[0]) + mr * moves[1].dot(moves[1])
               + Jp * v[0] ** 2 + Jr * (v[0] + v[1]) ** 2) / 2  # fmt: skip
    return ByHand(kinetic, (mp * lp + mr * lr) * g * cos(q[0]), (0, T), q, v)


def rolling_disc() -> ByHand:
    """Its centre, heading, lean and spin; what touches the floor has no velocity along it."""
    m, r, g = symbols("m r g")
    q, v = symbols("X Y yaw lean turned"), symbols("X_dot Y_dot W lean_dot s")
    (_, _, yaw, lean, _), (vx, vy, W, leaning, s) = q, v
    heading = Matrix([cos(yaw), sin(yaw), 0])
    up = Matrix([0, 0, 1])
    side = up.cross(heading)
    axle, across = cos(lean) * side + sin(lean) * up, cos(lean) * up - sin(lean) * side
    omega = leaning * heading + W * up + s * axle
    centre = Matrix([vx, vy, -r * sin(lean) * leaning])
    slip = centre + omega.cross(-r * across)
    spinning = Rational(1, 4) * (omega.dot(omega) + omega.dot(axle) ** 2)
    kinetic = m * (centre.dot(centre) + r**2 * spinning) / 2
    return ByHand(kinetic, m * g * r * cos(lean), (0,) * 5, q, v, (slip[0], slip[1]))


MACHINES: tuple[tuple[Callable[[], ByHand], tuple[str, ...]], ...] = (
    (wheel_pendulum, ("theta_dot_rate", "s_rate")),
    (acrobot, ("q_1_dot_rate", "q_2_dot_rate")),
    (cart_pendulum, ("x_dot_rate", "theta_dot_rate")),
    (rolling_disc, ("W_rate", "lean_dot_rate", "s_rate")),
)


@pytest.mark.long
@pytest.mark.parametrize("machine", thinned(MACHINES, len(MACHINES)))
def test_a_machine_moves_as_lagranges_equations_say(
    machine: tuple[Callable[[], ByHand], tuple[str, ...]],
) -> None:
    by_hand, rates = machine
    found, known = opened(by_hand.__name__), by_hand()
    ranges = {c: (q.low or 0, q.high or 0) for q in found.quantities() for c in q.components}
    dice = Random(by_hand.__name__)
    for _ in range(TRIES):
        at = {c: dice.uniform(float(low), float(high)) for c, (low, high) in ranges.items()}
        at |= {"X": 0.0, "Y": 0.0, "turned": 0.0}
        at |= _rolling(at) if by_hand is rolling_disc else {}
        own = known.accelerations({Symbol(n): x for n, x in at.items()})[-len(rates) :]
        answer = found.answer("state_rate", at)
        size = max(abs(own))
        assert [answer[n] for n in rates] == pytest.approx(own, rel=0, abs=CLOSE * size)


def _rolling(at: dict[str, float]) -> dict[str, float]:
    """Return the velocity with which the centre of the disc must move."""
    held = [e.subs(at) for e in rolling_disc().held]
    velocity = symbols("X_dot Y_dot")
    A = np.array(Matrix(held).jacobian(Matrix(velocity)), dtype=float)
    rest = np.array([e.subs(dict.fromkeys(velocity, 0)) for e in held], dtype=float)
    return dict(zip(("X_dot", "Y_dot"), np.linalg.solve(A, -rest), strict=True))


@pytest.mark.long
def test_a_disc_touches_the_floor_where_its_centre_and_its_lean_put_it() -> None:
    """The touching point is below the centre, by r sin(lean) to the side."""
    found = opened("rolling_disc")
    at = {"m": 0.4, "r": 0.2, "g": 9.81, "lean": 0.4, "lean_dot": 0.7, "W": 1.3, "s": 8.0,
          "yaw": 0.9, "x": 0.0, "y": 0.0, "turned": 0.0}  # fmt: skip
    answer = found.answer("state_rate", at)
    centre = _rolling(at)
    r, lean, yaw = symbols("r lean yaw")
    aside = Matrix([-r * sin(lean) * sin(yaw), r * sin(lean) * cos(yaw)])
    turns = aside.jacobian(Matrix([lean, yaw])) * Matrix(symbols("lean_dot W"))
    below = np.array(turns.subs(at), dtype=float)[:, 0]
    own = [answer["x_rate"], answer["y_rate"]]
    assert own == pytest.approx(np.array([*centre.values()]) + below, rel=1e-12)
