"""Motion as a Taylor series in time, in exact rationals: rates come by expansion.

A jet is the list of a quantity's first coefficients. Products and quotients of series are all that
is known here; no rule of mechanics enters.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

ORDER = 4  # coefficients kept: value, rate, acceleration, and one more to differentiate once


@dataclass(frozen=True)
class Jet:
    """The first coefficients of a power series in time."""

    coefficients: tuple[Fraction, ...]

    def __add__(self, other: Jet) -> Jet:
        return Jet(tuple(a + b for a, b in zip(self.coefficients, other.coefficients, strict=True)))

    def __neg__(self) -> Jet:
        return Jet(tuple(-a for a in self.coefficients))

    def __sub__(self, other: Jet) -> Jet:
        return self + (-other)

    def __mul__(self, other: Jet) -> Jet:
        a, b = self.coefficients, other.coefficients
        return Jet(
            tuple(sum((a[k] * b[n - k] for k in range(n + 1)), Fraction(0)) for n in range(ORDER))
        )

    def __truediv__(self, other: Jet) -> Jet:
        quotient: list[Fraction] = []
        for n in range(ORDER):
            known = sum((quotient[k] * other.coefficients[n - k] for k in range(n)), Fraction(0))
            quotient.append((self.coefficients[n] - known) / other.coefficients[0])
        return Jet(tuple(quotient))

    def derivative(self, order: int) -> Fraction:
        """Return the derivative of an order at time zero."""
        factor = 1
        for k in range(2, order + 1):
            factor *= k
        return factor * self.coefficients[order]


Column = tuple[Jet, Jet, Jet]
Rows = tuple[Column, Column, Column]


def constant(value: Fraction | int) -> Jet:
    """Return what does not change."""
    return Jet((Fraction(value), *(Fraction(0) for _ in range(ORDER - 1))))


def column(entry: Callable[[int], Jet]) -> Column:
    """Return three jets."""
    return entry(0), entry(1), entry(2)


def rows(entry: Callable[[int, int], Jet]) -> Rows:
    """Return nine jets."""
    x, y, z = (column(lambda k, i=i: entry(i, k)) for i in range(3))  # type: ignore[misc]
    return x, y, z


def total(jets: Sequence[Jet]) -> Jet:
    """Return a sum."""
    found = constant(0)
    for jet in jets:
        found = found + jet
    return found


def applied(matrix: Rows, v: Column) -> Column:
    """Return a matrix times a column."""
    return column(lambda i: total([matrix[i][k] * v[k] for k in range(3)]))


def product(a: Rows, b: Rows) -> Rows:
    """Return a matrix product."""
    return rows(lambda i, k: total([a[i][n] * b[n][k] for n in range(3)]))


def transposed(a: Rows) -> Rows:
    """Return a transpose."""
    return rows(lambda i, k: a[k][i])


def added(a: Column, b: Column) -> Column:
    """Return a sum of columns."""
    return column(lambda i: a[i] + b[i])


def crossed(a: Column, b: Column) -> Column:
    """Return a vector product."""
    return column(lambda i: a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2])


def turning(p: Column) -> Rows:
    """Return the rotation of Gibbs vector ``p``: 1 + 2 ([p]x + [p]x^2)/(1 + p.p), rational in p."""
    x, y, z = p
    skew = ((constant(0), -z, y), (z, constant(0), -x), (-y, x, constant(0)))
    square = product(skew, skew)
    scale = constant(2) / (constant(1) + x * x + y * y + z * z)
    return rows(lambda i, k: constant(int(i == k)) + scale * (skew[i][k] + square[i][k]))
