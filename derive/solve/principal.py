"""Principal axes of an inertia tensor in numbers, by the rotations that set-up makes in C."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite

from derive.motion.exact import diagonal
from derive.motion.exact.inertia import Inertia
from derive.program.tape import Number, number

Direction = tuple[float, float, float]


@dataclass(frozen=True)
class PrincipalAxes:
    """Moments in kg m^2, ascending, and their unit vectors, a right-handed triad."""

    moments: Direction
    directions: tuple[Direction, Direction, Direction]


def principal_axes(tensor: Sequence[Sequence[float]]) -> PrincipalAxes:
    """Return the principal moments of a symmetric tensor and the directions of its axes.

    tensor : (3, 3) kg m^2, rows along body axes; products of inertia enter with minus
    Directions are unit vectors along the same axes, the largest component of the first two
    positive. All is right to a rounding, whatever the moments: it is worked out in 192 bits.
    Raises ValueError if the tensor is not symmetric or not finite.
    Source: lecture step "principal_directions".

    >>> principal_axes([[2, 0, 0], [0, 3, 0], [0, 0, 1]]).moments
    (1.0, 2.0, 3.0)
    """
    rows = [[float(entry) for entry in row] for row in tensor]
    _refuse_unfit(rows)
    xx, yy, zz = (number(Fraction(rows[i][i])) for i in range(3))
    xy, xz, yz = (number(Fraction(rows[i][k])) for i, k in ((0, 1), (0, 2), (1, 2)))
    found = diagonal.diagonalised(Inertia((xx, yy, zz, xy, xz, yz), "general", None))
    x, y, z = (_floats(row) for row in found.axes)
    first, second = (-1.0 if max(row, key=abs) < 0 else 1.0 for row in (x, y))
    moments = _floats([m * found.size for m in found.moments])
    return PrincipalAxes(moments, (_times(first, x), _times(second, y), _times(first * second, z)))


def _refuse_unfit(rows: Sequence[Sequence[float]]) -> None:
    if not all(isfinite(entry) for row in rows for entry in row):
        raise ValueError(f"inertia tensor: must be finite, not {rows}")
    for i, k in ((0, 1), (0, 2), (1, 2)):
        if rows[i][k] != rows[k][i]:
            raise ValueError(
                f"inertia tensor: must be symmetric, but {rows[i][k]!r} faces {rows[k][i]!r}"
            )


def _floats(values: Sequence[Number]) -> Direction:
    x, y, z = (float(v.exact or 0) for v in values)
    return x, y, z


def _times(sign: float, row: Direction) -> Direction:
    x, y, z = (sign * part + 0.0 for part in row)
    return x, y, z
