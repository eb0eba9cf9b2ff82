"""Pairs of floats: twice the working precision from operations of the working precision alone."""

from collections.abc import Callable
from typing import Any

import numpy as np

Pair = tuple[Any, Any]

MANTISSA: dict[type, int] = {np.float64: 53, np.float32: 24}


def splitter(bits: int) -> int:
    """Return the number that splits a float of so many bits into halves (Veltkamp)."""
    return (1 << (bits + 1) // 2) + 1


def two_sum(a: Any, b: Any) -> Pair:
    """Return s and e with s + e = a + b exactly and s = fl(a + b) (Knuth)."""
    s = a + b
    t = s - a
    return s, (a - (s - t)) + (b - t)


def fast_two_sum(a: Any, b: Any) -> Pair:
    """Return s and e with s + e = a + b exactly where abs(a) >= abs(b) (Dekker)."""
    s = a + b
    return s, b - (s - a)


def _split(a: Any, factor: Any) -> Pair:
    c = factor * a
    high = c - (c - a)
    return high, a - high


def two_product(a: Any, b: Any, factor: Any) -> Pair:
    """Return p and e with p + e = a b exactly and p = fl(a b) (Veltkamp and Dekker)."""
    p = a * b
    ah, al = _split(a, factor)
    bh, bl = _split(b, factor)
    return p, ((ah * bh - p) + ah * bl + al * bh) + al * bl


def pair_add(a: Pair, b: Pair) -> Pair:
    """Return a + b within 3 u^2 relative, whatever cancels (Joldes, Muller and Popescu 2017)."""
    s, e = two_sum(a[0], b[0])
    t, f = two_sum(a[1], b[1])
    x, y = fast_two_sum(s, e + t)
    return fast_two_sum(x, y + f)


def pair_mul(a: Pair, b: Pair, factor: Any) -> Pair:
    """Return a b within a few u^2 relative."""
    p, e = two_product(a[0], b[0], factor)
    return fast_two_sum(p, e + (a[0] * b[1] + a[1] * b[0]))


def pair_div(a: Pair, b: Pair, factor: Any) -> Pair:
    """Return a / b within a few u^2 relative: long division, three digits."""
    zero = b[0] * 0
    q1 = a[0] / b[0]
    r = pair_add(a, pair_minus(pair_mul((q1, zero), b, factor)))
    q2 = r[0] / b[0]
    r = pair_add(r, pair_minus(pair_mul((q2, zero), b, factor)))
    return pair_add(pair_add((q1, zero), (q2, zero)), (r[0] / b[0], zero))


def pair_sqrt(a: Pair, factor: Any) -> Pair:
    """Return the square root of a within a few u^2 relative (Karp and Markstein)."""
    s = np.sqrt(a[0])
    r = pair_add(a, pair_minus(two_product(s, s, factor)))
    return fast_two_sum(s, np.where(s > 0, r[0] / (s + s), s * 0))


def pair_minus(a: Pair) -> Pair:
    """Return -a."""
    return -a[0], a[1] * 0 - a[1]  # a zero stays a positive zero, as CasADi has it


def pair_absolute(a: Pair) -> Pair:
    """Return a without its sign."""
    return pair_select(a[0] < 0, pair_minus(a), a)


def pair_below(compared: Callable[[Any, Any], Any], a: Pair, b: Pair) -> Any:
    """Return where a < b or a <= b, as the second parts are to be ``compared``."""
    return (a[0] < b[0]) | ((a[0] == b[0]) & compared(a[1], b[1]))


def pair_select(condition: Any, yes: Pair, no: Pair) -> Pair:
    """Return ``yes`` where the condition is true, else ``no``."""
    return np.where(condition, yes[0], no[0]), np.where(condition, yes[1], no[1])
