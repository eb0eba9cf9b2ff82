"""Rotation matrices, column by column: nine components R_xx, R_yx, R_zx, R_xy, ... of R_NB.

R_NB takes components along B's axes to components along N's.
"""

from collections.abc import Sequence

from derive.motion.attitude.lengths import either_way, squares
from derive.program.operations import less, select, sqrt
from derive.program.tape import Number


def from_quaternion(q: Sequence[Number]) -> list[Number]:
    """Return the matrix (9, column by column) of a unit quaternion. 26 flops.

    Within 7 u of the rotation that ``q`` stands for if |q| is 1 up to rounding, which has its
    share in it; within 3 u of |q|^2 times it. The diagonal by 1 - 2 (y^2 + z^2) of 24 flops errs
    nearly twice as much.
    """
    w, x, y, z = q
    x2, y2, z2 = x + x, y + y, z + z
    xy, xz, yz = x * y2, x * z2, y * z2
    wx, wy, wz = w * x2, w * y2, w * z2
    ww, xx, yy, zz = w * w, x * x, y * y, z * z
    sum_wx, left_wx, sum_yz, left_yz = ww + xx, ww - xx, yy + zz, yy - zz
    return [
        *(sum_wx - sum_yz, xy + wz, xz - wy),
        *(xy - wz, left_wx + left_yz, yz + wx),
        *(xz + wy, yz - wx, left_wx - left_yz),
    ]


def to_quaternion(matrix: Sequence[Number]) -> list[Number]:
    """Return the unit quaternion (4) of a rotation matrix (9, column by column), w >= 0.

    Within 6 u of the rotation's own if the matrix is one up to rounding. Each of four vectors is
    the quaternion times four times one of its components; that of the largest is taken, so that
    nothing cancels at any angle. Source: Shepperd, J. Guidance and Control 1 (1978) 223.
    """
    xx, yx, zx, xy, yy, zy, xz, yz, zz = matrix
    a, b, c = zy - yz, xz - zx, yx - xy
    d, e, f = yx + xy, xz + zx, zy + yz
    # 4 w^2 and 4 x^2 add up to 2 + 2 R_xx, so the sign of R_yy + R_zz tells which is larger.
    w_or_x = either_way(
        less(yy + zz, 0),
        [a, 1 + (xx - yy) - zz, d, e],
        [1 + (xx + yy) + zz, a, b, c],
    )
    y_or_z = either_way(
        less(yy, zz),
        [c, e, f, 1 + (zz - xx) - yy],
        [b, d, 1 + (yy - xx) - zz, f],
    )
    found = either_way(less(xx, 0), y_or_z, w_or_x)
    length = sqrt(squares(found))
    length = select(less(found[0], 0), -length, length)
    return [v / length for v in found]
