"""How far an attitude is from another, in three components without a condition on a length.

With r = target* q, the turn from the target to q, the error is e = 2 sign(r_w) (r_x, r_y, r_z):
axis times 2 sin(angle / 2), along body axes, the target's or q's. Of small turns it is the rotation
vector to third order, zero where q = target or -target; squared it is 2 (1 - cos(angle)). At half
a turn its length is 2 and its sign jumps, so there it has no derivative; none is NaN anywhere.
"""

from __future__ import annotations

from collections.abc import Sequence

from derive.program.operations import less, select
from derive.program.tape import Number


def attitude_error(target: Sequence[Number], q: Sequence[Number]) -> list[Number]:
    """Return the error (3) of unit quaternions, exactly zero if they are equal. Within 4 u."""
    w, *vector = _between(target, q)
    factor = select(less(w, 0), -2, 2)
    return [factor * c for c in vector]


def error_tangent(target: Sequence[Number], q: Sequence[Number]) -> list[Number]:
    """Return the derivatives of the error by delta, q exp(delta / 2), column by column (9).

    They are sign(r_w) (r_w 1 + [r]x): 1 where there is no error, singular at half a turn alone.
    By an error delta of the target they are the transpose with the other sign. Within 4 u.
    """
    w, *_ = r = _between(target, q)
    sign = select(less(w, 0), -1, 1)
    w, x, y, z = (sign * c for c in r)
    return [w, z, -y, -z, w, x, y, -x, w]


def _between(p: Sequence[Number], q: Sequence[Number]) -> list[Number]:
    """Return p* q (4): of equal ones, differences of equal products, so the vector part is zero."""
    pw, px, py, pz = p
    qw, qx, qy, qz = q
    return [
        (pw * qw + px * qx) + (py * qy + pz * qz),
        (pw * qx - px * qw) + (pz * qy - py * qz),
        (pw * qy - py * qw) + (px * qz - pz * qx),
        (pw * qz - pz * qw) + (py * qx - px * qy),
    ]
