"""Principal axes of any inertia tensor, found by Jacobi's rotations.

Nearly equal moments are the hard case: their common part is taken off first, which is exact for
floats that close, and the directions are then as accurate as the small rest defines them. Very
different moments, as of a thin rod, keep their own relative accuracy, since nothing is taken off.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import copysign, hypot, sqrt

Column = tuple[float, float, float]
_NEGLIGIBLE = 2.0**-60  # an entry this small against its diagonal no longer changes a float
_SWEEPS = 30  # Jacobi's method needs five or six; thirty means that the input is not a number
_PLANES = ((0, 1, 2), (1, 2, 0), (0, 2, 1))


@dataclass(frozen=True)
class PrincipalAxes:
    """Moments in kg m^2, ascending, and their unit vectors, a right-handed triad."""

    moments: Column
    directions: tuple[Column, Column, Column]


def principal_axes(tensor: Sequence[Sequence[float]]) -> PrincipalAxes:
    """Return the principal moments of a symmetric tensor and the directions of its axes.

    tensor : (3, 3) kg m^2, rows; products of inertia enter with minus
    Raises ValueError if the tensor is not symmetric or not finite.
    Source: lecture step "principal_directions".

    >>> principal_axes([[2, 0, 0], [0, 3, 0], [0, 0, 1]]).moments
    (1.0, 2.0, 3.0)
    """
    a = [[float(entry) for entry in row] for row in tensor]
    _refuse_unfit(a)
    common = _common_part(a)
    for i in range(3):
        a[i][i] -= common
    v = [[float(i == k) for k in range(3)] for i in range(3)]
    for _ in range(_SWEEPS):
        turned = [_turned(a, v, *plane) for plane in _PLANES]
        if not any(turned):
            return _sorted([a[i][i] + common for i in range(3)], v)
    raise ValueError(f"inertia tensor: Jacobi's method does not converge for {tensor}")


def _refuse_unfit(a: list[list[float]]) -> None:
    for i, k in ((0, 1), (0, 2), (1, 2)):
        if a[i][k] != a[k][i]:
            raise ValueError(
                f"inertia tensor: must be symmetric, but {a[i][k]!r} faces {a[k][i]!r}"
            )
    if not all(abs(entry) < float("inf") for row in a for entry in row):
        raise ValueError(f"inertia tensor: must be finite, not {a}")


def _common_part(a: list[list[float]]) -> float:
    """Return what all three moments share if the rest is small beside it, else nothing."""
    middle = sorted(a[i][i] for i in range(3))[1]
    rest = max(abs(a[i][k] - (middle if i == k else 0.0)) for i in range(3) for k in range(3))
    return middle if rest < abs(middle) / 2 else 0.0


def _turned(a: list[list[float]], v: list[list[float]], p: int, q: int, r: int) -> bool:
    """Turn in the plane p q so that a[p][q] vanishes; return whether there was a need to."""
    entry = a[p][q]
    if abs(entry) <= _NEGLIGIBLE * sqrt(abs(a[p][p])) * sqrt(abs(a[q][q])):
        a[p][q] = a[q][p] = 0.0
        return False
    ratio = (a[q][q] - a[p][p]) / 2 / entry
    tangent = copysign(1.0, ratio) / (abs(ratio) + hypot(1.0, ratio))
    cosine = 1 / hypot(1.0, tangent)
    sine = tangent * cosine
    bend = sine / (1 + cosine)
    a[p][p] -= tangent * entry
    a[q][q] += tangent * entry
    a[p][q] = a[q][p] = 0.0
    first, second = a[p][r], a[q][r]
    a[p][r] = a[r][p] = first - sine * (second + bend * first)
    a[q][r] = a[r][q] = second + sine * (first - bend * second)
    for row in v:
        first, second = row[p], row[q]
        row[p] = first - sine * (second + bend * first)
        row[q] = second + sine * (first - bend * second)
    return True


def _sorted(moments: list[float], v: list[list[float]]) -> PrincipalAxes:
    """Order the moments; the largest component of the first two directions is positive."""
    order = sorted(range(3), key=lambda k: moments[k])
    x, y = (_pointed((v[0][k], v[1][k], v[2][k])) for k in order[:2])
    z = (x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0])
    first, second, third = (moments[k] for k in order)
    return PrincipalAxes((first, second, third), (x, y, z))


def _pointed(direction: Column) -> Column:
    sign = copysign(1.0, max(direction, key=abs))
    x, y, z = (sign * part + 0.0 for part in direction)
    return x, y, z
