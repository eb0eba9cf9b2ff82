"""What attitude functions should return, in 2400 bits, by algebra that they do not use.

Quaternions are the matrices of multiplication from the left; exp is the exponential of a matrix,
log goes by square roots of quaternions, angles are read from rotation matrices.
"""

from collections.abc import Callable, Sequence

import flint

BITS = 2400  # 1e-320 and 1 side by side, squared, with 200 bits to spare
ROOTS = 110  # after so many square roots the sine of an angle is the angle to 220 bits

Vector = list[flint.arb]


def left(q: Sequence[flint.arb]) -> flint.arb_mat:
    """Return the matrix that multiplies by ``q`` from the left."""
    w, x, y, z = q
    return flint.arb_mat([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]])


def times(a: Sequence[flint.arb], b: Sequence[flint.arb]) -> Vector:
    return column(left(a) * left(b))


def column(m: flint.arb_mat) -> Vector:
    return [m[i, 0].mid() for i in range(4)]


def length(v: Sequence[flint.arb]) -> flint.arb:
    return sum((c * c for c in v), flint.arb(0)).sqrt()


def unit(q: Sequence[flint.arb]) -> Vector:
    size = length(q)
    return [c / size for c in q]


def exp(v: Sequence[flint.arb]) -> Vector:
    return column(left([flint.arb(0), *(c / 2 for c in v)]).exp())


def root(q: Sequence[flint.arb]) -> Vector:
    """Return the square root of a unit quaternion that is nearer to 1."""
    return unit([q[0] + 1, *q[1:]])


def log(q: Sequence[flint.arb]) -> Vector:
    q = unit(q)
    q = [-c for c in q] if q[0] < 0 else q
    for _ in range(ROOTS):
        q = root(q)
    return [c * 2 ** (ROOTS + 1) for c in q[1:]]


def matrix(q: Sequence[flint.arb]) -> list[Vector]:
    """Return R, row by row: the action of ``q`` on the base vectors."""
    u = unit(q)
    back = left([u[0], -u[1], -u[2], -u[3]])
    columns = []
    for k in range(3):
        e = [flint.arb(int(i == k + 1)) for i in range(4)]
        columns.append(column(left(u) * left(e) * back)[1:])
    return [[columns[k][i] for k in range(3)] for i in range(3)]


def by_column(q: Sequence[flint.arb]) -> Vector:
    return [entry for column in zip(*matrix(q), strict=True) for entry in column]


def rotate(q: Sequence[flint.arb], v: Sequence[flint.arb]) -> Vector:
    return [sum((a * b for a, b in zip(row, v, strict=True)), flint.arb(0)) for row in matrix(q)]


def rotate_back(q: Sequence[flint.arb], v: Sequence[flint.arb]) -> Vector:
    rows = matrix(q)
    return [sum((rows[i][k] * v[i] for i in range(3)), flint.arb(0)) for k in range(3)]


def between(p: Sequence[flint.arb], q: Sequence[flint.arb]) -> Vector:
    """Return the turn from p to q, of the two quaternions that say it the one nearer to 1."""
    r = times([p[0], *(-c for c in p[1:])], q)
    return [-c for c in r] if r[0] < 0 else r


def attitude_error(p: Sequence[flint.arb], q: Sequence[flint.arb]) -> Vector:
    return [2 * c for c in between(p, q)[1:]]


def error_slopes(p: Sequence[flint.arb], q: Sequence[flint.arb]) -> Vector:
    """Return the vector part of r (0, delta), column by column: an error is twice that of r."""
    turn = left(between(p, q))
    return [turn[i, k].mid() for k in (1, 2, 3) for i in (1, 2, 3)]


def mrp(q: Sequence[flint.arb]) -> Vector:
    """Return the axis times the tangent of the half-turned quaternion's half angle."""
    q = unit(q)
    half = root([-c for c in q] if q[0] < 0 else q)
    return [c / half[0] for c in half[1:]]


def from_mrp(s: Sequence[flint.arb]) -> Vector:
    half = unit([flint.arb(1), *s])
    return times(half, half)


def from_euler(sequence: str, angles: Sequence[flint.arb]) -> Vector:
    q = [flint.arb(i == 0) for i in range(4)]
    for axis, angle in zip(sequence, angles, strict=True):
        q = times(q, exp([angle if axis == a else flint.arb(0) for a in "xyz"]))
    return q


def to_euler(sequence: str, q: Sequence[flint.arb]) -> Vector:
    """Return the angles from the rotation matrix; not for gimbal lock itself."""
    R = matrix(q)
    i, j, k = ("xyz".index(axis) for axis in sequence)
    if i == k:
        k = 3 - i - j
        s = 1 if (j - i) % 3 == 1 else -1
        across = length([R[j][i], R[k][i]])
        return [angle(R[j][i], -s * R[k][i]), angle(across, R[i][i]), angle(R[i][j], s * R[i][k])]
    s = 1 if (j - i) % 3 == 1 else -1
    along = length([R[i][i], R[i][j]])
    return [angle(-s * R[j][k], R[k][k]), angle(s * R[i][k], along), angle(-s * R[i][j], R[i][i])]


def angle(y: flint.arb, x: flint.arb) -> flint.arb:
    return flint.arb.atan2(y.mid(), x.mid())


def plain(function: Callable[..., Vector], *given: Sequence[float]) -> Vector:
    """Return a truth for floats, at full precision."""
    with flint.ctx.workprec(BITS):
        return [c.mid() for c in function(*([flint.arb(float(x)) for x in each] for each in given))]
