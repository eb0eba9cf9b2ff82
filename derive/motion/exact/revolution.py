"""The exact motion of a free body of revolution, and of one with three equal moments."""

from __future__ import annotations

from derive.motion.attitude.lengths import length_of, squares
from derive.motion.attitude.quaternion import product
from derive.motion.exact.principal_axes import Three
from derive.program.operations import cos, sin, sqrt
from derive.program.tape import Number, named, number


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
