"""Intervals of floats, rounded outward: what a formula can be at most and at least on a box."""

import math
from typing import Any

Interval = tuple[float, float]
EVERYTHING = (-math.inf, math.inf)


def _outward(low: float, high: float) -> Interval:
    """Return an interval one float wider at each end; everything if an end is no number."""
    if math.isnan(low) or math.isnan(high):
        return EVERYTHING
    return math.nextafter(low, -math.inf), math.nextafter(high, math.inf)


def number(value: Any) -> Interval:
    """Return the interval of a number."""
    return _outward(float(value), float(value))


def added(a: Interval, b: Interval) -> Interval:
    """Return a + b."""
    return _outward(a[0] + b[0], a[1] + b[1])


def negative(a: Interval) -> Interval:
    """Return -a."""
    return -a[1], -a[0]


def multiplied(a: Interval, b: Interval) -> Interval:
    """Return a b."""
    ends = [x * y for x in a for y in b]
    return EVERYTHING if any(map(math.isnan, ends)) else _outward(min(ends), max(ends))


def divided(a: Interval, b: Interval) -> Interval:
    """Return a / b, everything if b may be 0."""
    if b[0] <= 0 <= b[1]:
        return EVERYTHING
    return multiplied(a, _outward(1 / b[1], 1 / b[0]))


def raised(a: Interval, exponent: int) -> Interval:
    """Return a to a whole power."""
    if exponent < 0:
        return divided((1.0, 1.0), raised(a, -exponent))
    try:
        ends = [x**exponent for x in a]
    except OverflowError:
        return EVERYTHING
    if exponent % 2 == 0 and a[0] <= 0 <= a[1]:
        ends.append(0.0)
    low, high = min(ends), max(ends)
    for _ in range(2):  # the library's power may be a unit wrong
        low, high = _outward(low, high)
    return max(low, 0.0) if exponent % 2 == 0 else low, high


def root(a: Interval) -> Interval:
    """Return the square root of what of a is not negative."""
    low, high = (math.sqrt(max(x, 0.0)) for x in a)
    return max(_outward(low, high)[0], 0.0), _outward(low, high)[1]


def _shifted(a: Interval, quarter: int) -> Interval:
    """Return sin of an angle so many right angles further."""
    if not all(map(math.isfinite, a)) or a[1] - a[0] >= 2 * math.pi:
        return -1.0, 1.0
    low, high = (x * 2 / math.pi + quarter for x in a)
    slack = 1e-15 * (1 + abs(low) + abs(high))  # of the angle in right angles
    first, last = math.ceil(low - slack), math.floor(high + slack)
    turning = {k % 4 for k in range(first, last + 1)}
    ends = [math.sin(x + quarter * math.pi / 2) for x in a]
    wider = 4e-15 * (1 + abs(a[0]) + abs(a[1]))
    top = 1.0 if 1 in turning else min(max(ends) + wider, 1.0)
    return -1.0 if 3 in turning else max(min(ends) - wider, -1.0), top


def sine(a: Interval) -> Interval:
    """Return the sine of an angle in rad."""
    return _shifted(a, 0)


def cosine(a: Interval) -> Interval:
    """Return the cosine of an angle in rad."""
    return _shifted(a, 1)
