"""Quaternions and matrices on which formulas fail, the naive forms, and what they should give.

A form is given the numbers and their type; every operation is rounded to that type. References are
in mpmath's working precision.
"""

import math
import random
from typing import Any

Row = list[float]


def normalised(q: Row, _: Any) -> Row:
    """Return a unit quaternion by the root of the sum of squares."""
    import numpy as np

    size = np.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return [x / size for x in q]


def logarithm(q: Row, real: Any) -> Row:
    """Return the rotation vector through the arc cosine of the scalar part."""
    import numpy as np

    factor = real(2) * np.arccos(q[0]) / np.sqrt(real(1) - q[0] * q[0])
    return [factor * x for x in q[1:]]


def from_matrix(m: Row, real: Any) -> Row:
    """Return the quaternion of a matrix (column by column) from its trace."""
    import numpy as np

    w = np.sqrt(real(1) + m[0] + m[4] + m[8]) / real(2)
    return [w, *((m[a] - m[b]) / (real(4) * w) for a, b in ((5, 7), (6, 2), (1, 3)))]


def tiny(dice: random.Random, precision: str) -> Row:
    """Return a quaternion whose squares vanish."""
    scale = {"f64": 1e-200, "f32": 1e-25}[precision]
    return [dice.gauss(0, 1) * scale for _ in range(4)]


def huge(dice: random.Random, precision: str) -> Row:
    """Return a quaternion whose squares overflow."""
    scale = {"f64": 1e200, "f32": 1e25}[precision]
    return [dice.gauss(0, 1) * scale for _ in range(4)]


def small_turn(dice: random.Random, precision: str) -> Row:
    """Return the quaternion of a small turn."""
    angle = {"f64": 1e-7, "f32": 1e-3}[precision] * dice.uniform(1, 10)
    axis = _direction(dice)
    return [math.cos(angle / 2), *(math.sin(angle / 2) * x for x in axis)]


def half_turn(dice: random.Random, precision: str) -> Row:
    """Return the matrix, column by column, of a turn just short of half a turn."""
    angle = math.pi - {"f64": 1e-7, "f32": 1e-3}[precision] * dice.uniform(0.5, 2)
    w, (x, y, z) = math.cos(angle / 2), [math.sin(angle / 2) * c for c in _direction(dice)]
    return [
        *(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
        *(2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
        *(2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
    ]


def _direction(dice: random.Random) -> Row:
    raw = [dice.gauss(0, 1) for _ in range(3)]
    size = math.hypot(*raw)
    return [x / size for x in raw]


def true_unit(q: Row) -> list[Any]:
    """Return the unit quaternion along a quaternion."""
    import mpmath

    size = mpmath.norm([mpmath.mpf(x) for x in q])
    return [mpmath.mpf(x) / size for x in q]


def true_logarithm(q: Row) -> list[Any]:
    import mpmath

    vector = [mpmath.mpf(x) for x in q[1:]]
    size = mpmath.norm(vector)
    return [2 * mpmath.atan2(size, mpmath.mpf(q[0])) / size * x for x in vector]


def true_from_matrix(m: Row) -> list[Any]:
    """Return the unit quaternion of the nearest rotation.

    Source: Bar-Itzhack, J. Guidance 23 (2000) 1085, equation 2: the largest eigenvector.
    """
    import mpmath

    xx, yx, zx, xy, yy, zy, xz, yz, zz = (mpmath.mpf(x) for x in m)
    symmetric = mpmath.matrix([
        [xx - yy - zz, yx + xy, zx + xz, zy - yz],
        [yx + xy, yy - xx - zz, zy + yz, xz - zx],
        [zx + xz, zy + yz, zz - xx - yy, yx - xy],
        [zy - yz, xz - zx, yx - xy, xx + yy + zz],
    ])  # fmt: skip
    values, vectors = mpmath.eigsy(symmetric / 3)
    last = max(range(4), key=lambda n: values[n])
    x, y, z, w = (vectors[n, last] for n in range(4))
    sign = 1 if w >= 0 else -1
    return [sign * part for part in (w, x, y, z)]
