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


KEPT, FEW = 32, 1 << 14
"""Angles whose sums are remembered: a cosine asked for after the sine is made of the same. Of no
more samples than so many, lest they fill the memory."""
SplitAngle = tuple[Any, Pair, Pair]  # quarter turns, and the cosine and the sine of what is left


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

    highs = [[rounded(c) for c in reversed(coefficients(bits, start))] for start in (0, 1)]
    series = [
        [(h, rounded(c - Fraction(float(h))))
         for h, c in zip(high, reversed(coefficients(bits, start)), strict=True)]
        for start, high in enumerate(highs)
    ]  # fmt: skip
    kept: dict[int, tuple[Pair, SplitAngle]] = {}

    def summed(square: Pair, start: int) -> Pair:
        total = (square[0] * 0, square[0] * 0)
        for own in series[start]:
            total = pair_add(pair_mul(total, square, factor), own)
        return total

    def parts(a: Pair) -> SplitAngle:
        k = np.floor(per_quarter * a[0] + dtype(0.5))
        r = pair_add(a, pair_minus(two_product(k, first, factor)))
        r = pair_add(r, pair_minus(two_product(k, second, factor)))
        r = pair_add(r, (-(k * third), k * 0))
        square = pair_mul(r, r, factor)
        return k, summed(square, 0), pair_mul(summed(square, 1), r, factor)

    def remembered(a: Pair) -> SplitAngle:
        own = kept.get(id(a))
        if own is None or own[0] is not a:
            own = a, parts(a)
            if len(kept) >= KEPT:
                kept.clear()
            if np.size(a[0]) <= FEW:
                kept[id(a)] = own
        return own[1]

    def sine(a: Pair, quarters: int) -> Pair:
        k, even, odd = remembered(a)
        turn = k + dtype(quarters)
        turn = turn - dtype(4) * np.floor(turn * dtype(0.25))
        across = ((turn > 0.5) & (turn < 1.5)) | (turn > 2.5)
        found = pair_select(across, even, odd)
        return pair_select(turn > 1.5, pair_minus(found), found)

    return sine
