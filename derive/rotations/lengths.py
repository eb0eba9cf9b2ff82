"""Lengths of vectors of any scale, so that no square overflows or vanishes.

A length is worked out from components over a power of two near the largest of them. Where a
length is an angle, what its rounding left is wanted too: half an angle of 1000 rad that is wrong
by one unit in its last place turns a vector visibly.
"""

from collections.abc import Sequence
from fractions import Fraction

from derive.trace import Number, Tape, absolute, less, power_of_two, select, sqrt

FAR = Fraction(2**60)
"""Larger numbers are brought down by this before their power of two is asked for: the way to a
power of two multiplies by up to 2^52, and both float and double must bear it."""


def largest(values: Sequence[Number]) -> Number:
    """Return the largest magnitude among ``values``."""
    first, *rest = map(absolute, values)
    for size in rest:
        first = select(less(first, size), size, first)
    return first


def either_way(condition: Number, yes: Sequence[Number], no: Sequence[Number]) -> list[Number]:
    """Return one of two vectors, component by component."""
    return [select(condition, a, b) for a, b in zip(yes, no, strict=True)]


def size_of(values: Sequence[Number]) -> Number:
    """Return a power of two over which ``values`` are near 1, or near 2^60 if they are large.

    1 if all are zero, so that it can be divided by.
    """
    m = largest(values)
    return power_of_two(select(less(1, m), m * (1 / FAR), select(less(0, m), m, 1)))


def squares(values: Sequence[Number]) -> Number:
    """Return the sum of squares, added in pairs."""
    terms = [v * v for v in values]
    while len(terms) > 1:
        couples = zip(terms[::2], terms[1::2], strict=False)
        terms = [a + b for a, b in couples] + terms[len(terms) // 2 * 2 :]
    return terms[0]


def length_and_rest(tape: Tape, v: Sequence[Number], vanishing: Number) -> tuple[Number, Number]:
    """Return the rounded length h of ``v``, and l with h + l right to about u^2.

    ``v`` is scaled already. Where ``vanishing`` is true h is 1 and l means nothing.
    The exact squares leave h^2 by r, and l = r / (2 h).
    Source: Dekker, Numer. Math. 18 (1971) 224, products; Knuth, TAOCP 2, 4.2.2, sums.
    """
    factor = _splitter(tape)
    (xx, x_low), (yy, y_low), (zz, z_low) = (_exact_square(c, factor) for c in v)
    partial, first = _exact_sum(xx, yy)
    total, second = _exact_sum(partial, zz)
    h = select(vanishing, 1, sqrt(total))
    hh, h_low = _exact_square(h, factor)
    lows = (x_low + y_low) + (z_low + (first + second))
    return h, ((total - hh) - h_low + lows) / (h + h)


def _splitter(tape: Tape) -> Number:
    """Return Veltkamp's factor 2^12 + 1 or 2^27 + 1, as the precision of the program needs.

    A compiler sees constants only: in float 1 + 2^-30 is 1.
    """
    more = Number(tape, tape.record("add", (Fraction(1), Fraction(1, 2**30))))
    return select(less(1, more), 2**27 + 1, 2**12 + 1)


def _exact_square(a: Number, factor: Number) -> tuple[Number, Number]:
    """Return p and e with p + e = a^2 exactly and p the rounded square."""
    p, c = a * a, factor * a
    high = c - (c - a)
    low = a - high
    return p, ((high * high - p) + (high + high) * low) + low * low


def _exact_sum(a: Number, b: Number) -> tuple[Number, Number]:
    """Return s and e with s + e = a + b exactly and s the rounded sum."""
    s = a + b
    t = s - a
    return s, (a - (s - t)) + (b - t)
