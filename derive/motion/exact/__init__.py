"""The exact motion of a body on which no moment acts, to any time at once."""

from __future__ import annotations

from collections.abc import Sequence

from derive.motion.attitude.lengths import largest_size, length_of, squares
from derive.motion.attitude.quaternion import product
from derive.motion.exact.diagonal import Three, diagonalised
from derive.motion.exact.inertia import Inertia
from derive.motion.exact.tumbling import tumble
from derive.program.operations import cos, less, power_of_two, select, sin, sqrt
from derive.program.tape import Number, named, number

TurnAndMomentum = tuple[list[Number], list[Number]]


def flow_exact(
    body: Inertia, attitude: Sequence[Number], omega: Sequence[Number], time: Number
) -> TurnAndMomentum:
    """Return the attitude (4,) and the angular velocity (3,) of a free body after ``time``.

    attitude : scalar first, Hamilton, body to inertial, of any length, which it keeps
    omega    : of the body in the inertial frame, along body axes, rad/s
    time     : s, of either sign; the attitude keeps the sign that a continuous motion gives it
    Rates are worked out over a power of two near the largest, and a body at rest as one that spins
    for no time: nothing overflows, and nothing is divided by zero.
    """
    turn, after, size = turn_and_rates(body, omega, time)
    return product(attitude, turn), [w * size for w in after]


def turn_and_rates(
    body: Inertia, omega: Sequence[Number], time: Number
) -> tuple[list[Number], list[Number], Number]:
    """Return the turn (4,) from body axes to those after ``time``; rates (3,) then; their unit."""
    size = power_of_two(largest_size(omega))
    moves = less(0, size)
    scaled = [w / select(moves, size, 1) for w in omega]
    scaled[0] = select(moves, scaled[0], 1)
    turn, after = _along_body(body, (scaled[0], scaled[1], scaled[2]), time * size)
    return turn, after, size


def principal_ratios(
    body: Inertia,
) -> tuple[Three, tuple[list[Number], list[Number], list[Number]]]:
    """Return three moments over the second, which lies between the others, and their axes.

    The axes are right-handed unit vectors along body axes, as rows. Slopes of the motion rest on
    this and on the turn, which is why ``Program.free`` holds the three.
    """
    axes: list[list[Number]] = [[number(int(i == j)) for j in range(3)] for i in range(3)]
    if body.kind == "spherical":
        return (number(1), number(1), number(1)), (axes[0], axes[1], axes[2])
    if body.kind == "axisymmetric":
        i, j, k = body.places
        ratio = body.tensor[k] / body.tensor[i]
        return (number(1), number(1), ratio), (axes[i], axes[j], axes[k])
    found = diagonalised(body)
    one, two, three = found.moments
    return (one / two, number(1), three / two), found.axes


def _along_body(body: Inertia, omega: Three, time: Number) -> TurnAndMomentum:
    """Return the turn and the angular velocity along body axes."""
    if body.kind == "spherical":
        return spun(omega, time), list(omega)
    if body.kind == "axisymmetric":
        i, _, k = body.places
        return precess((body.tensor[i], body.tensor[k]), k, omega, time)
    found = diagonalised(body)
    rows = [_named(k, row) for k, row in enumerate(found.axes, start=1)]
    a, b, c = (_dot(row, omega) for row in rows)
    (scalar, *vector), after = _along_principal(found.moments, (a, b, c), time)
    columns = list(zip(*rows, strict=True))
    return [scalar, *(_dot(n, vector) for n in columns)], [_dot(n, after) for n in columns]


def _along_principal(moments: Three, omega: Three, time: Number) -> TurnAndMomentum:
    """Return the motion along principal axes; moments that are numbers may be simpler than told."""
    one, two, three = moments
    if one.exact is not None and one.exact == three.exact:
        return spun(omega, time), list(omega)
    if two.exact is not None and two.exact == three.exact:
        return precess((two, one), 0, omega, time)
    if two.exact is not None and one.exact == two.exact:
        return precess((two, three), 2, omega, time)
    return tumble(moments, omega, time)


def _named(k: int, row: list[Number]) -> list[Number]:
    says = "principal axis {}, along {}"
    return [named(f"axis_{k}_{n}", e, says.format(k, n)) for n, e in zip("xyz", row, strict=True)]


def _dot(a: Sequence[Number], b: Sequence[Number]) -> Number:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def spun(omega: Three, time: Number) -> list[Number]:
    """Return the turn (4,) of a body whose angular velocity stays as it is, and is not zero."""
    return _turned(omega, sqrt(squares(omega)), time)


def _turned(omega: Three, rate: Number, time: Number) -> list[Number]:
    """Return the turn about ``omega`` of length ``rate``, over any scale."""
    half = rate * time / 2
    along = sin(half) / rate
    return [cos(half), *(along * w for w in omega)]


def precess(
    moments: tuple[Number, Number], axis: int, omega: Three, time: Number
) -> tuple[list[Number], list[Number]]:
    """Return the turn (4,) and the angular velocity (3,) of a body of revolution after ``time``.

    moments : across and along the axis, in kg m^2        axis : its place, 0 to 2
    The turn is one about the angular momentum and one about the axis after it, each steady.
    Source: Landau and Lifshitz, Mechanics, section 33.
    """
    across, along = moments
    ratio = named("moment_ratio", along / across, "moment along the axis over one across it")
    lag = named("lag", (across - along) / across, "1 - moment_ratio, from a difference of moments")
    i, j = (axis + 1) % 3, (axis + 2) % 3
    momentum = [ratio * w if k == axis else w for k, w in enumerate(omega)]
    half = lag * omega[axis] * time / 2
    cosine, sine = cos(half), sin(half)
    about = [cosine, *(sine if k == axis else number(0) for k in range(3))]
    x, y, z = momentum
    turn = product(_turned((x, y, z), length_of((x, y, z)), time), about)
    c, s = cosine * cosine - sine * sine, 2 * cosine * sine
    after = list(omega)
    after[i], after[j] = c * omega[i] + s * omega[j], c * omega[j] - s * omega[i]
    return turn, after
