"""Points and directions in space, as triples of floats.

Only sums, products, quotients and square roots are taken of them, which are rounded alike on every
machine; sines come from mpmath.
"""

from collections.abc import Iterable, Sequence
from functools import cache
from math import fsum, sqrt

from mpmath import mp, mpf

Position = tuple[float, float, float]
Flat = tuple[float, float]
Basis = tuple[Position, Position, Position]
ORIGIN: Position = (0.0, 0.0, 0.0)
AROUND = 36  # points of a circle


def shifted(a: Position, b: Position, scale: float = 1.0) -> Position:
    """Return ``a`` and so many times ``b``."""
    return a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]


def times(a: Position, scale: float) -> Position:
    """Return ``a``, scaled."""
    return a[0] * scale, a[1] * scale, a[2] * scale


def inner_product(a: Position, b: Position) -> float:
    """Return the product of two directions."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def across_both(a: Position, b: Position) -> Position:
    """Return what stands across both."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def extent(a: Position) -> float:
    """Return the length of a direction."""
    return sqrt(inner_product(a, a))


def directed(a: Position) -> Position:
    """Return a direction of length one; of none, the third axis."""
    size = extent(a)
    return times(a, 1 / size) if size > 0 else (0.0, 0.0, 1.0)


def basis_along(axis: Position) -> Basis:
    """Return a right-handed basis whose third direction is ``axis``."""
    along = directed(axis)
    least = min(range(3), key=lambda k: abs(along[k]))
    other = directed(across_both(along, (float(least == 0), float(least == 1), float(least == 2))))
    return across_both(other, along), other, along


def within(basis: Basis, at: Sequence[float]) -> Position:
    """Return the point whose components along a basis are given."""
    return shifted(shifted(times(basis[0], at[0]), basis[1], at[1]), basis[2], at[2])


def middle_of(points: Iterable[Position]) -> Position:
    """Return the mean of points."""
    each = tuple(points)
    x, y, z = (fsum(c) / len(each) for c in zip(*each, strict=True))
    return x, y, z


@cache
def turned_by(part: mpf) -> tuple[float, float]:
    """Return cosine and sine of a part of a whole turn."""
    return float(mp.cospi(2 * part)), float(mp.sinpi(2 * part))


@cache
def circle() -> tuple[tuple[float, float], ...]:
    """Return points of the unit circle."""
    return tuple(turned_by(mpf(k) / AROUND) for k in range(AROUND))
