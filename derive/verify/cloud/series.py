"""Quantities that move, as the first coefficients of their power series in time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from mpmath import mp, mpf
from numpy.typing import NDArray

from derive.scene.formula import Arithmetic

DIGITS = 50
ORDER = 3  # value, rate, half the acceleration
Array = NDArray[Any]


@dataclass(frozen=True)
class Series:
    """Coefficients of 1, t, t^2; what is beyond is not known and never used."""

    parts: tuple[Any, ...]

    def __add__(self, other: Series | int) -> Series:
        return Series(tuple(a + b for a, b in zip(self.parts, series(other).parts, strict=True)))

    __radd__ = __add__

    def __neg__(self) -> Series:
        return Series(tuple(-a for a in self.parts))

    def __sub__(self, other: Series | int) -> Series:
        return self + (-series(other))

    def __rsub__(self, other: Series | int) -> Series:
        return series(other) - self

    def __mul__(self, other: Series | Any) -> Series:
        a, b = self.parts, series(other).parts
        return Series(tuple(mp.fsum(a[k] * b[n - k] for k in range(n + 1)) for n in range(ORDER)))

    __rmul__ = __mul__

    def __truediv__(self, other: Series | Any) -> Series:
        b, quotient = series(other).parts, list[Any]()
        for n in range(ORDER):
            known = mp.fsum(quotient[k] * b[n - k] for k in range(n))
            quotient.append((self.parts[n] - known) / b[0])
        return Series(tuple(quotient))

    @property
    def value(self) -> Any:
        """Return what it is at time zero."""
        return self.parts[0]

    @property
    def velocity(self) -> Any:
        """Return its rate at time zero."""
        return self.parts[1]

    @property
    def acceleration(self) -> Any:
        """Return its second rate at time zero."""
        return 2 * self.parts[2]

    def rate(self) -> Series:
        """Return the series of its rate; the last coefficient is lost."""
        return Series((*((n + 1) * c for n, c in enumerate(self.parts[1:])), mpf(0)))

    def integral(self, start: Any) -> Series:
        """Return the series that begins at ``start`` and has this rate."""
        return Series((start, *(c / (n + 1) for n, c in enumerate(self.parts[:-1]))))


def series(value: Series | Any) -> Series:
    """Return a constant as a series."""
    if isinstance(value, Series):
        return value
    return Series((mpf(value), *(mpf(0) for _ in range(ORDER - 1))))


def _composed(x: Series, value: Any, slope: Any, curvature: Any) -> Series:
    """Return a function of a series, by its value and derivatives there."""
    _, a, b = x.parts
    return Series((value, slope * a, slope * b + curvature * a * a / 2))


def sine(x: Series) -> Series:
    """Return the sine of a series."""
    s, c = mp.sin(x.value), mp.cos(x.value)
    return _composed(x, s, c, -s)


def cosine(x: Series) -> Series:
    """Return the cosine of a series."""
    s, c = mp.sin(x.value), mp.cos(x.value)
    return _composed(x, c, -s, -c)


def root(x: Series) -> Series:
    """Return the square root of a series."""
    r = mp.sqrt(x.value)
    return _composed(x, r, 1 / (2 * r), -1 / (4 * r**3))


def _power(x: Series, n: int) -> Series:
    made = series(1)
    for _ in range(abs(n)):
        made = made * x
    return made if n >= 0 else series(1) / made


ARITHMETIC: Arithmetic = {
    "number": lambda q: series(mpf(q.numerator) / q.denominator),
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "neg": lambda a: -a,
    "power": _power,
    "sin": sine,
    "cos": cosine,
    "tan": lambda x: sine(x) / cosine(x),
    "sqrt": root,
}


def each(function: Callable[[Series], Any], array: Array) -> Array:
    """Return an array with a function taken of every entry."""
    found: Array = np.vectorize(function, otypes=[object])(array)
    return found


def turn(axis: str, angle: Series) -> Array:
    """Return the turn about an axis that takes components along new axes to the old."""
    k = "xyz".index(axis)
    i, j = (k + 1) % 3, (k + 2) % 3
    R = np.array([[series(int(r == c)) for c in range(3)] for r in range(3)], dtype=object)
    R[i, i] = R[j, j] = cosine(angle)
    R[j, i], R[i, j] = sine(angle), -sine(angle)
    return R


def crossed(a: Array, b: Array) -> Array:
    """Return a vector product."""
    return np.array([a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3)], dtype=object)
