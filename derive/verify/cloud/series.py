"""Quantities that move, as the first coefficients of their power series in time, by flint."""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import arb, arb_series, ctx
from mpmath import mp, mpf
from numpy.typing import NDArray

from derive.scene.formula import Arithmetic
from derive.verify.operators import IN_BALLS

DIGITS, BITS = 50, 200  # of the numbers that go in and come out, and of balls between
ORDER = 3  # value, rate, half the acceleration


@dataclass(frozen=True)
class Series:
    """Coefficients of 1, t, t^2; what is beyond is not known and never used."""

    terms: arb_series

    def __add__(self, other: Series | Any) -> Series:
        return _by(operator.add, self, other)

    __radd__ = __add__

    def __neg__(self) -> Series:
        return _by(operator.neg, self)

    def __sub__(self, other: Series | Any) -> Series:
        return _by(operator.sub, self, other)

    def __rsub__(self, other: Series | Any) -> Series:
        return _by(operator.sub, other, self)

    def __mul__(self, other: Series | Any) -> Series:
        return _by(operator.mul, self, other)

    __rmul__ = __mul__

    @property
    def value(self) -> Any:
        """Return what it is at time zero."""
        return _number(self.terms[0])

    @property
    def velocity(self) -> Any:
        """Return its rate at time zero."""
        return _number(self.terms[1])

    @property
    def acceleration(self) -> Any:
        """Return its second rate at time zero."""
        return 2 * _number(self.terms[2])

    def rate(self) -> Series:
        """Return the series of its rate; the last coefficient is lost."""
        return _by(arb_series.derivative, self)

    def integral(self, start: Any) -> Series:
        """Return the series that begins at ``start`` and has this rate."""
        return _by(operator.add, _by(arb_series.integral, self), start)


def motion_series(*parts: Any) -> Series:
    """Return the series with these coefficients, zeros behind them."""
    with ctx.workprec(BITS):
        return Series(arb_series([ball_of(x) for x in parts], prec=ORDER))


def series(value: Series | Any) -> Series:
    """Return a constant as a series."""
    return value if isinstance(value, Series) else motion_series(value)


def _by(operation: Callable[..., Any], *given: Series | Any) -> Series:
    with ctx.workprec(BITS):
        return Series(operation(*(series(x).terms for x in given)))


def ball_of(x: Any) -> arb:
    """Return a number of mpmath as a ball."""
    if not mp.isfinite(x):
        return arb("nan")
    sign, mantissa, exponent, _ = mpf(x)._mpf_
    return arb(-int(mantissa) if sign else int(mantissa)) * arb(2) ** int(exponent)


def _number(ball: arb) -> Any:
    if not ball.is_finite():
        return mpf("nan")
    mantissa, exponent = ball.mid().man_exp()
    return mp.ldexp(mpf(int(mantissa)), int(exponent))


def _on_series(operation: Callable[..., Any]) -> Callable[..., Any]:
    return lambda *given: _by(operation, *given)


ARITHMETIC: Arithmetic = {
    **{name: _on_series(operation) for name, operation in IN_BALLS.items()},
    "number": lambda q: motion_series(mpf(q.numerator) / q.denominator),
    "power": lambda x, n: _by(lambda terms: terms**n, x),
}


def each(function: Callable[[Series], Any], array: NDArray[Any]) -> NDArray[Any]:
    """Return an array with a function taken of every entry."""
    found: NDArray[Any] = np.vectorize(function, otypes=[object])(array)
    return found


def turn(axis: str, angle: Series) -> NDArray[Any]:
    """Return the turn about an axis that takes components along new axes to the old."""
    k = "xyz".index(axis)
    i, j = (k + 1) % 3, (k + 2) % 3
    R = np.array([[series(int(r == c)) for c in range(3)] for r in range(3)], dtype=object)
    s = ARITHMETIC["sin"](angle)
    R[i, i] = R[j, j] = ARITHMETIC["cos"](angle)
    R[j, i], R[i, j] = s, -s
    return R


def crossed(a: NDArray[Any], b: NDArray[Any]) -> NDArray[Any]:
    """Return a vector product."""
    return np.array([a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3)], dtype=object)
