"""Sine and cosine of a float by + - * alone, the same bits wherever these round as IEEE 754 says.

Quarter turns are taken off first, in parts of few digits: their products with the number of
quarters are exact. What is left is a sum of two floats, high + low, and goes into polynomials that
were fitted to the precision (Remez, each coefficient rounded before the next was found).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np

from derive.program.pair_sine import PI
from derive.program.pairs import MANTISSA


@dataclass(frozen=True)
class Fit:
    """What a precision takes.

    sine, cosine : by powers of z = r^2, of (sin r - r)/(r z) and of (cos r - 1 + z/2)/z^2
    parts, count : pi/2 in so many parts, for a number of quarter turns of so many binary digits
    largest      : the angle in rad up to which that serves
    """

    sine: tuple[Fraction, ...]
    cosine: tuple[Fraction, ...]
    parts: int
    count: int
    largest: int


def _numbers(*hexadecimal: str) -> tuple[Fraction, ...]:
    return tuple(Fraction(float.fromhex(x)) for x in hexadecimal)


FITTED: Mapping[int, Fit] = {
    24: Fit(
        _numbers("-0x1.555546p-3", "0x1.110778p-7", "-0x1.9953fep-13"),
        _numbers("0x1.55554ap-5", "-0x1.6c0c28p-10", "0x1.99e80cp-16"),
        parts=4,
        count=9,
        largest=804,
    ),
    53: Fit(
        _numbers(
            *("-0x1.5555555555548p-3", "0x1.111111110f730p-7", "-0x1.a01a019be9217p-13"),
            *("0x1.71de35552b525p-19", "-0x1.ae5e4b83e358bp-26", "0x1.5d8b5593ecb7bp-33"),
        ),
        _numbers(
            *("0x1.555555555554bp-5", "-0x1.6c16c16c15013p-10", "0x1.a01a019c8ed07p-16"),
            *("-0x1.27e4f7f1410dbp-22", "0x1.1ee9db8e2ef60p-29", "-0x1.8fa65e911becbp-37"),
        ),
        parts=3,
        count=14,
        largest=25735,
    ),
}
"""By bits. The fits err by less than 2^-27.9 of a sine and 2^-32.9 of a cosine in float, by 2^-57.8
and 2^-63.8 in double, to 1.0001 of an eighth of a turn."""


def parts_of_quarter(bits: int) -> list[Fraction]:
    """Return pi/2 in parts: all but the last have digits to spare for a number of quarter turns."""
    fit, found, rest = FITTED[bits], list[Fraction](), PI / 2
    for place in range(fit.parts):
        digits = bits - fit.count if place + 1 < fit.parts else bits
        below = digits - (rest.numerator.bit_length() - rest.denominator.bit_length() + 1)
        whole = rest * Fraction(2) ** below
        cut = round(whole) if digits == bits else int(whole)
        found.append(Fraction(cut) / Fraction(2) ** below)
        rest -= found[-1]
    return found


def rounder(bits: int) -> Fraction:
    """Return what a float is added to, and less again, to leave the whole number next to it."""
    return Fraction(3 * 2 ** (bits - 2))


@cache
def _constants(dtype: type) -> tuple[Any, ...]:
    """Return 2/pi, the rounder, parts of pi/2, and coefficients, the last first, as floats."""
    bits = MANTISSA[dtype]
    fit = FITTED[bits]
    own = [[dtype(x.numerator / x.denominator) for x in numbers]
           for numbers in (parts_of_quarter(bits), fit.sine[::-1], fit.cosine[::-1])]  # fmt: skip
    return dtype(float(2 / PI)), dtype(float(rounder(bits))), *own


def sine_and_cosine(angle: Any, dtype: type) -> tuple[Any, Any]:
    """Return sine and cosine of angles up to the largest that is served, in rad."""
    per_quarter, top, parts, odd, even = _constants(dtype)
    half, one = dtype(0.5), dtype(1)
    k = (angle * per_quarter + top) - top
    high, low = angle - k * parts[0], None
    for part in parts[1:-1]:
        off = k * part
        after = high - off
        left = (high - after) - off
        high, low = after, left if low is None else low + left
    off = k * parts[-1] - low
    r = high - off
    low = (high - r) - off
    z = r * r
    odd_sum, even_sum = odd[0], even[0]
    for c in odd[1:-1]:
        odd_sum = c + z * odd_sum
    for c in even[1:]:
        even_sum = c + z * even_sum
    cube = z * r
    sine = r - ((z * (half * low - cube * odd_sum) - low) - cube * odd[-1])
    halved = half * z
    near = one - halved
    cosine = near + (((one - near) - halved) + (z * (z * even_sum) - r * low))
    quarter = k - dtype(4) * np.floor(k * dtype(0.25))
    across = (quarter == 1) | (quarter == 3)
    first, second = np.where(across, cosine, sine), np.where(across, sine, cosine)
    return (
        np.where(quarter >= 2, -first, first),
        np.where((quarter == 1) | (quarter == 2), -second, second),
    )
