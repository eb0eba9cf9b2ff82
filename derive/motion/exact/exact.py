"""The exact motion of a body on which no moment acts, to any time at once."""

from __future__ import annotations

from collections.abc import Sequence

from derive.motion.attitude.lengths import largest
from derive.motion.attitude.quaternion import product
from derive.motion.exact.inertia import Inertia
from derive.motion.exact.principal_axes import Row, Three, principal_axes
from derive.motion.exact.revolution import precess, spun
from derive.motion.exact.tumbling import tumble
from derive.program.operations import less, power_of_two, select
from derive.program.tape import Number, Tape, named, number

Motion = tuple[list[Number], list[Number]]


def flow_exact(
    tape: Tape,  # noqa: ARG001  every motion is given the tape that it is recorded on
    body: Inertia,
    attitude: Sequence[Number],
    omega: Sequence[Number],
    time: Number,
) -> Motion:
    """Return the attitude (4,) and the angular velocity (3,) of a free body after ``time``.

    attitude : scalar first, Hamilton, body to inertial, of any length, which it keeps
    omega    : of the body in the inertial frame, along body axes, rad/s
    time     : s, of either sign; the attitude keeps the sign that a continuous motion gives it
    Rates are worked out over a power of two near the largest, and a body at rest as one that spins
    for no time: nothing overflows, and nothing is divided by zero.
    """
    turn, after, size = turned(body, omega, time)
    return product(attitude, turn), [w * size for w in after]


def turned(
    body: Inertia, omega: Sequence[Number], time: Number
) -> tuple[list[Number], list[Number], Number]:
    """Return the turn (4,) from body axes to those after ``time``; rates (3,) then; their unit."""
    size = power_of_two(largest(omega))
    moves = less(0, size)
    scaled = [w / select(moves, size, 1) for w in omega]
    scaled[0] = select(moves, scaled[0], 1)
    turn, after = _moved(body, (scaled[0], scaled[1], scaled[2]), time * size)
    return turn, after, size


def principal(body: Inertia) -> tuple[Three, tuple[Row, Row, Row]]:
    """Return three moments over the second, which lies between the others, and their axes.

    The axes are right-handed unit vectors along body axes, as rows. Slopes of the motion rest on
    this and on the turn, which is why ``Program.free`` holds the three.
    """
    axes: list[Row] = [[number(int(i == j)) for j in range(3)] for i in range(3)]
    if body.kind == "spherical":
        return (number(1), number(1), number(1)), (axes[0], axes[1], axes[2])
    if body.kind == "axisymmetric":
        k = "xyz".index(body.axis or "z")
        ratio = body.tensor[k] / body.tensor[(k + 1) % 3]
        return (number(1), number(1), ratio), (axes[(k + 1) % 3], axes[(k + 2) % 3], axes[k])
    found = principal_axes(body)
    one, two, three = found.moments
    return (one / two, number(1), three / two), found.axes


def _moved(body: Inertia, omega: Three, time: Number) -> Motion:
    """Return the turn and the angular velocity along body axes."""
    if body.kind == "spherical":
        return spun(omega, time), list(omega)
    if body.kind == "axisymmetric":
        axis = "xyz".index(body.axis or "z")
        across = body.tensor[(axis + 1) % 3]
        return precess((across, body.tensor[axis]), axis, omega, time)
    found = principal_axes(body)
    rows = [_named(k, row) for k, row in enumerate(found.axes, start=1)]
    a, b, c = (_dot(row, omega) for row in rows)
    (scalar, *vector), after = _along_axes(found.moments, (a, b, c), time)
    columns = list(zip(*rows, strict=True))
    return [scalar, *(_dot(n, vector) for n in columns)], [_dot(n, after) for n in columns]


def _along_axes(moments: Three, omega: Three, time: Number) -> Motion:
    """Return the motion along principal axes; moments that are numbers may be simpler than told."""
    one, two, three = moments
    if one.exact is not None and one.exact == three.exact:
        return spun(omega, time), list(omega)
    if two.exact is not None and two.exact == three.exact:
        return precess((two, one), 0, omega, time)
    if two.exact is not None and one.exact == two.exact:
        return precess((two, three), 2, omega, time)
    return tumble(moments, omega, time)


def _named(k: int, row: Row) -> Row:
    says = "principal axis {}, along {}"
    return [named(f"axis_{k}_{n}", e, says.format(k, n)) for n, e in zip("xyz", row, strict=True)]


def _dot(a: Sequence[Number], b: Sequence[Number]) -> Number:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
