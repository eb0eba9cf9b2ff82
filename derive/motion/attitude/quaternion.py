"""Quaternions (w, x, y, z), Hamilton, body to inertial: product, exp, log, turning of vectors.

Errors are in u, the unit roundoff, normwise: the largest error of a component over the largest
component of the result. Sources: Sola, "Quaternion kinematics for the error-state Kalman filter"
(2017), eqs. 13, 101, 105; the forms here are those among equals that do not cancel.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from derive.motion.attitude.lengths import FAR, largest_size, length_and_rest, size_of, squares
from derive.program.operations import absolute, atan2, cos, less, power_of_two, select, sin, sqrt
from derive.program.tape import Number

TINY = Fraction(1, 2**30)
"""Below, a rotation vector v has sin(|v|/2)/|v| = 1/2 and cos(|v|/2) = 1 to the last bit."""


def conjugate(q: Sequence[Number]) -> list[Number]:
    """Return the quaternion of the opposite rotation (4), which is the inverse if |q| = 1."""
    w, x, y, z = q
    return [w, -x, -y, -z]


def product(a: Sequence[Number], b: Sequence[Number]) -> list[Number]:
    """Return a b (4): the rotation b, then a, both seen from the outer frame. 28 flops.

    Within 4 u if both are unit quaternions; any scale as long as no product of two components
    leaves the range of floats.
    """
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return [
        (aw * bw - ax * bx) - (ay * by + az * bz),
        (aw * bx + ax * bw) + (ay * bz - az * by),
        (aw * by + ay * bw) + (az * bx - ax * bz),
        (aw * bz + az * bw) + (ax * by - ay * bx),
    ]


def exponential(v: Sequence[Number]) -> list[Number]:
    """Return the unit quaternion (4) of a rotation vector ``v`` (3) in rad: exp(v / 2).

    Within 6 u for |v| from zero and denormal up to 2^26 (double) or 2^12 (float), and up to pi
    the vector part within 6 u of itself: |v| is carried with what its rounding left. Beyond,
    |v| is rounded once and the quaternion is still of unit length. 69 flops, a sine, a cosine.
    """
    m = largest_size(v)
    tiny = less(m, TINY)
    scale = power_of_two(select(less(FAR, m), m * (1 / FAR), 1))
    y = [c / scale for c in v]
    h, low, square = length_and_rest(y, tiny)
    half = scale * Fraction(1, 2)
    sine, cosine = sin(h * half), cos(h * half)
    rest = low * half
    # A rest above the root of u would leave the sphere; there |v| is too large to be known.
    rest = select(less(absolute(rest) * h, 1), rest, 0)
    ratio = select(tiny, Fraction(1, 2), (sine + rest * cosine) / h)
    scalar = 1 - square * Fraction(1, 8)  # 1 if tiny, and bent as the cosine is
    return [select(tiny, scalar, cosine - rest * sine), *(ratio * c for c in y)]


def logarithm(q: Sequence[Number]) -> list[Number]:
    """Return the rotation vector (3) in rad of a quaternion of any length, |v| <= pi.

    Within 5 u, near the identity, near -1, and at 180 degrees; lengths from denormal to the
    largest float. Zero for the zero quaternion, and for (w, 0, 0, 0) of either sign.
    The angle is 2 atan2(|(x, y, z)|, |w|): an arc cosine loses half of the digits near identity.
    """
    far = less(FAR, largest_size(q))
    factor = select(far, 1 / FAR, FAR)
    w, *u = (c * factor for c in q)
    m = largest_size(u)
    scale = size_of(u) * select(less(1, m), FAR, 1)
    y = [c / scale for c in u]
    length = select(less(0, m), sqrt(squares(y)), 1)
    angle = 2 * atan2(length * scale, absolute(w))
    ratio = angle / length
    ratio = select(less(q[0], 0), -ratio, ratio)
    return [ratio * c for c in y]


def normalise(q: Sequence[Number]) -> list[Number]:
    """Return q / |q| (4), for any q from denormal to the largest float; (1, 0, 0, 0) for zero.

    Within 4 u. A quaternion that says nothing is taken for no rotation, so that what
    follows has a rotation to work with.
    """
    scale = size_of(q)
    w, *u = q
    w = select(less(0, largest_size(q)), w, 1)
    y = [c / scale for c in (w, *u)]
    length = sqrt(squares(y))
    return [c / length for c in y]


def rotate(q: Sequence[Number], v: Sequence[Number]) -> list[Number]:
    """Return q v q* (3): ``v`` along B's axes to N's, if |q| = 1. 41 flops.

    Within 8 u of the rotation that ``q`` stands for if |q| is 1 up to rounding, which has its share
    in it; within 6 u of q v q*. The form of 30 flops, v + 2 (w + u x) (u x v), takes differences
    of terms twice as long as v and errs up to 13 u.
    """
    w, *u = q
    scalar = (u[0] * v[0] + u[1] * v[1]) + u[2] * v[2]
    t = [w * a + b for a, b in zip(v, cross(u, v), strict=True)]
    return [(w * a + scalar * b) + c for a, b, c in zip(t, u, cross(u, t), strict=True)]


def rotate_back(q: Sequence[Number], v: Sequence[Number]) -> list[Number]:
    """Return q* v q (3): ``v`` along N's axes to B's, as ``rotate``."""
    w, *u = q
    scalar = (u[0] * v[0] + u[1] * v[1]) + u[2] * v[2]
    t = [w * a + b for a, b in zip(v, cross(v, u), strict=True)]
    return [(w * a + scalar * b) + c for a, b, c in zip(t, u, cross(t, u), strict=True)]


def cross(a: Sequence[Number], b: Sequence[Number]) -> list[Number]:
    """Return the cross product (3)."""
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def norm_squared(q: Sequence[Number]) -> Number:
    """Return |q|^2."""
    return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]
