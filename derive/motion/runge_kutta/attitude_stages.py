"""The attitude through the stages of a Runge-Kutta step in which nothing knows the attitude.

With b_i = h W_i / 4, W_i the angular velocities of the stages, the classic step from q0 is q0 P,

    3 (P - 1) = b1 R1 + 2 b2 R2 + 2 b3 R3 + b4,   R1 = 1 + 2 b2 R2,  R2 = 1 + b3 R3,  R3 = 1 + b4,

a product of quaternions in which q0 has no part. A change of the W_i turns the result by the
vector Im(conj(P) dP) / |P|^2 = sum K_i dW_i, in axes fixed in the body after the step.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from derive.motion.attitude.quaternion import conjugate, product
from derive.motion.runge_kutta.matrices import Matrix
from derive.program.tape import Number, number

Quaternion = list[Number]


@dataclass(frozen=True)
class Turning:
    """Quarter-step vectors of the stages, what multiplies each from the right, and P - 1."""

    quarters: list[Quaternion]
    rights: list[Quaternion]
    increment: Quaternion


def added(p: Sequence[Number], q: Sequence[Number]) -> Quaternion:
    """Return the sum of two quaternions."""
    return [x + y for x, y in zip(p, q, strict=True)]


def one_and(q: Sequence[Number]) -> Quaternion:
    """Return 1 + q."""
    return [1 + q[0], *q[1:]]


def norm_squared(q: Sequence[Number]) -> Number:
    """Return |q|^2."""
    return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]


def turning(omegas: Sequence[Sequence[Number]], time_step: Number) -> Turning:
    """Return how a step turns, from the angular velocities (4 stages of 3, body axes, rad/s)."""
    quarter = time_step * Fraction(1, 2) * Fraction(1, 2)
    b1, b2, b3, b4 = ([number(0), *(w * quarter for w in omega)] for omega in omegas)
    third = product(b3, one_and(b4))
    twice_third = [x + x for x in third]
    right2 = [2 + twice_third[0], *twice_third[1:]]
    twice_second = product(b2, right2)
    right1 = one_and(twice_second)
    total = added(added(added(product(b1, right1), twice_second), twice_third), b4)
    increment = [x * Fraction(1, 3) for x in total]
    rights = [right1, right2, one_and(b4), [number(1), *[number(0)] * 3]]
    return Turning([b1, b2, b3, b4], rights, increment)


def turn_slopes(turn: Turning, scale: Number) -> list[Matrix]:
    """Return K_1 ... K_4 (3, 3) but for a factor: ``scale`` stands for h / (12 |P|^2)."""
    b1, b2, b3, _ = turn.quarters
    whole = [x * scale for x in conjugate(one_and(turn.increment))]
    left2 = added(whole, product(whole, b1))
    left3 = [x + x for x in added(whole, product(left2, b2))]
    left4 = added(whole, product(left3, b3))
    lefts = (whole, left2, left3, left4)
    return [between(left, right) for left, right in zip(lefts, turn.rights, strict=True)]


def between(c: Sequence[Number], r: Sequence[Number]) -> Matrix:
    """Return the matrix (3, 3) of v -> Im(c v r)."""
    c0, (cx, cy, cz) = c[0], c[1:]
    r0, (rx, ry, rz) = r[0], r[1:]
    tx, ty, tz, t0 = cx * rx, cy * ry, cz * rz, c0 * r0
    first, less = t0 + tx, t0 - tx
    x, y, z = (r0 * u - c0 * v for u, v in zip(c[1:], r[1:], strict=True))
    xy, xz, yz = cx * ry + cy * rx, cx * rz + cz * rx, cy * rz + cz * ry
    return [
        [less + (ty + tz), -z - xy, y - xz],
        [z - xy, first - (ty - tz), -x - yz],
        [-y - xz, x - yz, first + (ty - tz)],
    ]


def right_matrix(p: Sequence[Number]) -> Matrix:
    """Return the matrix (4, 4) of q -> q p."""
    w, x, y, z = p
    return [[w, -x, -y, -z], [x, w, z, -y], [y, -z, w, x], [z, y, -x, w]]


def tangent_matrix(q: Sequence[Number]) -> Matrix:
    """Return the matrix (4, 3) of v -> q (0, v)."""
    w, x, y, z = q
    return [[-x, -y, -z], [w, -z, y], [z, w, -x], [-y, x, w]]
