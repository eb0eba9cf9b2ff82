"""Sine and cosine of a pair of floats: quarter turns taken off, then a series in pairs.

No library is asked, so the digits are the same on every machine. The quarter turn has three parts:
an angle next to a whole number of them keeps its digits.
"""

from collections.abc import Callable
from fractions import Fraction
from math import factorial
from typing import Any

import numpy as np

from derive.program.pairs import (
    MANTISSA,
    Pair,
    pair_add,
    pair_minus,
    pair_mul,
    pair_select,
    splitter,
    two_product,
)

PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899")
TERMS = {24: 8, 53: 14}
"""Terms of the series by bits: the first left out is below 2^-(2 p + 1) at an eighth of a turn."""


def coefficients(bits: int, first: int) -> list[Fraction]:
    """Return coefficients by powers of x^2, of sin x / x (``first`` 1) or cos x (``first`` 0).

    >>> coefficients(24, 1)[:3]
    [Fraction(1, 1), Fraction(-1, 6), Fraction(1, 120)]
    """
    return [Fraction((-1) ** n, factorial(2 * n + first)) for n in range(TERMS[bits])]


def quarter_turn(rounded: Callable[[Fraction], Any]) -> list[Fraction]:
    """Return pi/2 as a sum of three floats."""
    parts, rest = list[Fraction](), PI / 2
    for _ in range(3):
        parts.append(Fraction(float(rounded(rest))))
        rest -= parts[-1]
    return parts


def pair_sine(dtype: type, rounded: Callable[[Fraction], Any]) -> Callable[[Pair, int], Pair]:
    """Return the function that takes the sine of an angle in rad and so many quarter turns."""
    bits = MANTISSA[dtype]
    factor = dtype(splitter(bits))
    first, second, third = (rounded(part) for part in quarter_turn(rounded))
    per_quarter = rounded(2 / PI)

    def summed(square: Pair, start: int) -> Pair:
        total = (square[0] * 0, square[0] * 0)
        for c in reversed(coefficients(bits, start)):
            high = rounded(c)
            own = (high, rounded(c - Fraction(float(high))))
            total = pair_add(pair_mul(total, square, factor), own)
        return total

    def sine(a: Pair, quarters: int) -> Pair:
        k = np.floor(per_quarter * a[0] + dtype(0.5))
        r = pair_add(a, pair_minus(two_product(k, first, factor)))
        r = pair_add(r, pair_minus(two_product(k, second, factor)))
        r = pair_add(r, (-(k * third), k * 0))
        square = pair_mul(r, r, factor)
        turn = k + dtype(quarters)
        turn = turn - dtype(4) * np.floor(turn * dtype(0.25))
        across = ((turn > 0.5) & (turn < 1.5)) | (turn > 2.5)
        found = pair_select(across, summed(square, 0), pair_mul(summed(square, 1), r, factor))
        return pair_select(turn > 1.5, pair_minus(found), found)

    return sine
