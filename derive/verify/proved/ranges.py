"""Ranges of numbers in columns of doubles, rounded outwards: a range holds whatever is meant.

Each end is moved by more than an operation on doubles can round, so that no mode of rounding is
asked for and every machine finds the same ends.
"""

from typing import Any

import numpy as np

from derive.program.own_sine import FITTED, sine_and_cosine
from derive.program.pair_sine import PI
from derive.verify.operators import Column

Interval = tuple[Column, Column]
SLACK = 2.0**-52
LEAST = 1e-290
"""What is moved besides, far more than underflow leaves."""
NEAR = 1e-6
"""Of a turn: ends that are nearer to a crest of a sine count as beyond it; of a number next to a
power of two, which the high part of a pair may be above."""
SINE_SLACK = 2.0**-50
EXPONENT = 0x7FF0_0000_0000_0000
"""Where the exponent of a double stands: what is left of its bits is a power of two."""
LARGEST = float(np.finfo(np.float64).max)
FARTHEST = float(FITTED[53].largest)


def outward(low: Column, high: Column) -> Interval:
    """Return a range that holds what ends were rounded from, all numbers for ends that are none."""
    under, over = _slack(low, LEAST), _slack(high, LEAST)
    np.subtract(low, under, out=under)
    return _numbers(under, np.add(high, over, out=over))


def _slack(x: Column, least: float) -> Column:
    """Return what an end is moved by."""
    by = np.abs(x)
    by *= SLACK
    if least:
        by += least
    return by


def _numbers(low: Column, high: Column) -> Interval:
    """Return a range, all numbers for ends that are none."""
    return np.fmax(low, -np.inf, out=low), np.fmin(high, np.inf, out=high)


def greatest(a: Interval) -> Column:
    """Return the largest absolute value in a range."""
    return np.maximum(np.abs(a[0]), np.abs(a[1]))


def hull(a: Interval, b: Interval) -> Interval:
    """Return the range that holds both."""
    return np.minimum(a[0], b[0]), np.maximum(a[1], b[1])


def sum_of(a: Interval, b: Interval) -> Interval:
    """Return a + b: a sum that is small is exact."""
    low, high = a[0] + b[0], a[1] + b[1]
    return _numbers(low - _slack(low, 0.0), high + _slack(high, 0.0))


def negated(a: Interval) -> Interval:
    """Return -a."""
    return -a[1], -a[0]


def times(a: Interval, b: Interval) -> Interval:
    """Return a b of two that are not the same; nothing times anything is nothing."""
    corners = (a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1])
    low = np.minimum(np.minimum(corners[0], corners[1]), np.minimum(corners[2], corners[3]))
    high = np.maximum(np.maximum(corners[0], corners[1]), np.maximum(corners[2], corners[3]))
    low, high = outward(low, high)
    for x in (a, b):
        nothing = x[0] == 0
        if nothing.any():
            nothing &= x[1] == 0
            low, high = np.where(nothing, 0.0, low), np.where(nothing, 0.0, high)
    return low, high


def squared(a: Interval) -> Interval:
    """Return a^2."""
    first = magnitude(a)
    low, high = outward(first[0] * first[0], first[1] * first[1])
    return np.maximum(low, 0.0), high


def magnitude(a: Interval) -> Interval:
    """Return a without its sign."""
    across = (a[0] <= 0) & (a[1] >= 0)
    ends = np.abs(a[0]), np.abs(a[1])
    return np.where(across, 0.0, np.minimum(*ends)), np.maximum(*ends)


def inverse(a: Interval) -> Interval:
    """Return 1/a, all numbers if a may be zero."""
    holds = (a[0] <= 0) & (a[1] >= 0)
    low, high = outward(1.0 / a[1], 1.0 / a[0])
    return np.where(holds, -np.inf, low), np.where(holds, np.inf, high)


def root_of(a: Interval) -> Interval:
    """Return the root of what of a range is not below zero."""
    low, high = outward(np.sqrt(np.maximum(a[0], 0.0)), np.sqrt(np.maximum(a[1], 0.0)))
    return np.maximum(low, 0.0), high


def wave(a: Interval, which: int) -> Interval:
    """Return sines (0) or cosines (1)."""
    far = ~(greatest(a) < FARTHEST)
    low, high = (np.where(far, 0.0, end) for end in a)
    ends = np.asarray(sine_and_cosine(np.stack(np.broadcast_arrays(low, high)), np.float64)[which])
    turn = 2 * float(PI)
    quarters = 0.25 - 0.25 * which  # of a turn, to the first crest
    crests = (high / turn - quarters, low / turn - quarters)
    crest = far | (np.floor(crests[0] + NEAR) >= np.ceil(crests[1] - NEAR))
    trough = far | (np.floor(crests[0] - 0.5 + NEAR) >= np.ceil(crests[1] - 0.5 - NEAR))
    return (
        np.where(trough, -1.0, np.maximum(np.minimum(*ends) - SINE_SLACK, -1.0)),
        np.where(crest, 1.0, np.minimum(np.maximum(*ends) + SINE_SLACK, 1.0)),
    )


def powers_of_two(a: Interval) -> Interval:
    """Return the powers of two that a program may take for numbers of a range: at or below them."""
    first = magnitude(a)
    itself = (first[0] == first[1]) & (np.frexp(first[0])[0] == 0.5)
    _, least = np.frexp(np.where(itself, first[0], first[0] * (1 - NEAR)))
    _, most = np.frexp(np.where(itself, first[1], first[1] * (1 + NEAR)))
    return np.where(first[0] > 0, np.ldexp(1.0, least - 1), 0.0), np.ldexp(1.0, most - 1)


def one_power(a: Interval) -> Interval:
    """Return one of these powers, for programs that any of them serves alike."""
    return (powers_of_two(a)[1],) * 2


def half_unit(most: Column, bits: int, least: float) -> Column:
    """Return how far rounding to floats of so many bits may move a number up to ``most``.

    A number that is little above a power of two is no further from that.
    """
    finite = np.minimum(np.asarray(most, np.float64), LARGEST)
    power = (finite.view(np.int64) & EXPONENT).view(np.float64)
    half = power * 2.0**-bits
    found = np.maximum(np.maximum(np.minimum(half, finite - power), 0.5 * half), least)
    return np.where(most == 0, 0.0, np.where(most < np.inf, found, np.inf))


def unit(most: Column, bits: int) -> Column:
    """Return the unit in the last place of numbers up to ``most``, not of that if a power of two.

    >>> unit(np.array([1.0, 1.5]), 24) * 2**24
    array([1., 2.])
    """
    mantissa, exponent = np.frexp(most)
    return np.asarray(np.ldexp(1.0, exponent - bits - (mantissa == 0.5)))


def column(x: Any, count: int) -> Interval:
    """Return one number as ranges of no width."""
    whole = np.full(count, float(x))
    return whole, whole
