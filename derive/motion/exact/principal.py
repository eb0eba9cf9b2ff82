"""Principal axes of an inertia tensor of numbers, by the rotations that set-up makes in C."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from derive.motion.exact import diagonal
from derive.motion.exact.inertia import Inertia
from derive.program.tape import Number, number

Direction = tuple[float, float, float]


@dataclass(frozen=True)
class PrincipalAxes:
    """Moments in kg m^2, ascending, and their unit vectors, a right-handed triad."""

    moments: Direction
    directions: tuple[Direction, Direction, Direction]


def principal_axes_of(rows: Sequence[Sequence[Fraction]]) -> PrincipalAxes:
    """Return the principal moments of a symmetric tensor and the directions of its axes.

    rows : (3, 3) kg m^2, along body axes; products of inertia enter with minus
    Directions are unit vectors along the same axes, the largest component of the first two
    positive. All is right to a rounding, whatever the moments: it is worked out in 192 bits.
    Source: lecture step "principal_directions".
    """
    xx, yy, zz = (number(rows[i][i]) for i in range(3))
    xy, xz, yz = (number(rows[i][k]) for i, k in ((0, 1), (0, 2), (1, 2)))
    found = diagonal.diagonalised(Inertia((xx, yy, zz, xy, xz, yz), "general", None))
    x, y, z = (_floats(row) for row in found.axes)
    first, second = (-1.0 if max(row, key=abs) < 0 else 1.0 for row in (x, y))
    moments = _floats([m * found.size for m in found.moments])
    return PrincipalAxes(moments, (_times(first, x), _times(second, y), _times(first * second, z)))


def _floats(values: Sequence[Number]) -> Direction:
    x, y, z = (float(v.exact or 0) for v in values)
    return x, y, z


def _times(sign: float, row: Direction) -> Direction:
    x, y, z = (sign * part + 0.0 for part in row)
    return x, y, z
