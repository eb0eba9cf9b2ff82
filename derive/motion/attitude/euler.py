"""Three angles about axes of the body, in any of the twelve sequences, and quaternions.

"zyx" turns about z by the first angle, about the new y by the second, about the newest x by the
third (yaw, pitch, roll): q = q_z(first) q_y(second) q_x(third), body to inertial.
Source: Bernardes and Viollet, PLoS ONE 17 (2022) e0276302: every sequence is a proper one after a
quarter turn about the middle axis, which makes sums of two components from four. Beyond the
paper, no angles are added and no quarter turn is taken away afterwards, for that cancels.
"""

from collections.abc import Sequence
from fractions import Fraction

from derive.motion.attitude.lengths import FAR, either_way, largest_size, squares
from derive.motion.attitude.quaternion import product
from derive.program.operations import (
    absolute,
    at_most,
    atan2,
    cos,
    less,
    power_of_two,
    select,
    sin,
    sqrt,
)
from derive.program.tape import Number, number


def sign_of(i: int, j: int) -> int:
    """Return 1 if the axes i, j and the third are in the order x, y, z, x, ..., else -1."""
    return 1 if (j - i) % 3 == 1 else -1


def to_quaternion(sequence: str, angles: Sequence[Number]) -> list[Number]:
    """Return the unit quaternion (4) of three angles in rad, of any size. Within 5 u."""
    turns = [_turn(axis, angle) for axis, angle in zip(sequence, angles, strict=True)]
    return product(product(turns[0], turns[1]), turns[2])


def _turn(axis: str, angle: Number) -> list[Number]:
    half = angle * Fraction(1, 2)
    return [cos(half), *(sin(half) if axis == a else number(0) for a in "xyz")]


def from_quaternion(sequence: str, q: Sequence[Number]) -> list[Number]:
    """Return the three angles (3) in rad of a unit quaternion. Within 6 u of the largest.

    First and third from -pi to pi; the second from -pi/2 to pi/2, or from 0 to pi if the first
    axis is also the third. Where the first and the third turn about one line (gimbal lock) the
    third is zero. Next to it the angles are still right to the last digits of the quaternion
    given, though the smallest change of it changes them.
    """
    i, j, k = ("xyz".index(axis) for axis in sequence)
    if i == k:
        return _proper(i, j, q)
    w, at_i, at_j, at_k = q[0], q[1 + i], q[1 + j], q[1 + k]
    near, far = [w + at_j, at_i + at_k], [w - at_j, at_i - at_k]
    sine = w * at_j + at_i * at_k
    if sign_of(i, j) < 0:
        near, far = [w - at_j, at_i + at_k], [w + at_j, at_i - at_k]
        sine = w * at_j - at_i * at_k
    length = sqrt(squares(near) * squares(far))
    first, third = _first_and_third(near, far)
    return [first, atan2(sine + sine, length), third]


def _proper(i: int, j: int, q: Sequence[Number]) -> list[Number]:
    """Return the angles of a proper sequence; the second is small where ``far`` is.

    Both points are brought up, so that no square and no product of their components vanishes.
    """
    last = q[1 + 3 - i - j]
    near = [FAR * q[0], FAR * q[1 + i]]
    far = [q[1 + j], last if sign_of(i, j) > 0 else -last]
    size = largest_size(far)
    scale = power_of_two(select(less(0, size), size, 1))
    far = [c / scale for c in far]
    first, third = _first_and_third(near, far)
    return [first, 2 * atan2(FAR * scale * sqrt(squares(far)), sqrt(squares(near))), third]


def _first_and_third(near: Sequence[Number], far: Sequence[Number]) -> tuple[Number, Number]:
    """Return the sum and the difference of the angles of two points, from -pi to pi.

    The point of their complex product, and of one's with the other's mirror image. A point
    that is zero has no angle: it takes the other's, which makes the third angle zero.
    """
    no_near, no_far = (at_most(absolute(a) + absolute(b), 0) for a, b in (near, far))
    (a, b), (c, d) = either_way(no_near, far, near), either_way(no_far, near, far)
    ac, bd, bc, ad = a * c, b * d, b * c, a * d
    return atan2(bc + ad, ac - bd), atan2(bc - ad, ac + bd)
