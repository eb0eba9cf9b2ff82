"""Lengths of vectors of any scale, so that no square overflows or vanishes.

A length is worked out from components over a power of two near the largest of them. Where a
length is an angle, what its rounding left is wanted too: half an angle of 1000 rad that is wrong
by one unit in its last place turns a vector visibly.
"""

from collections.abc import Sequence
from fractions import Fraction

from derive.program.operations import absolute, less, power_of_two, select, splitter, sqrt
from derive.program.pairs import two_sum
from derive.program.tape import Number

FAR = Fraction(2**60)
"""Larger numbers are brought down by this before their power of two is asked for: the way to a
power of two multiplies by up to 2^52, and both float and double must bear it."""


def largest_size(values: Sequence[Number]) -> Number:
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
    m = largest_size(values)
    return power_of_two(select(less(1, m), m * (1 / FAR), select(less(0, m), m, 1)))


def squares(values: Sequence[Number]) -> Number:
    """Return the sum of squares, added in pairs."""
    terms = [v * v for v in values]
    while len(terms) > 1:
        couples = zip(terms[::2], terms[1::2], strict=False)
        terms = [a + b for a, b in couples] + terms[len(terms) // 2 * 2 :]
    return terms[0]


def hypotenuse(x: Number, y: Number) -> Number:
    """Return the root of x^2 + y^2 for x, y >= 0: no square overflows, or vanishes and matters."""
    x_is_longer = less(y, x)
    longer, shorter = select(x_is_longer, x, y), select(x_is_longer, y, x)
    ratio = shorter / select(less(0, longer), longer, 1)
    return longer * sqrt(1 + ratio * ratio)


def length_of(values: Sequence[Number]) -> Number:
    """Return the length of a vector of any scale that is not zero, differentiable on its axes."""
    size = largest_size(values)
    return size * sqrt(squares([v / size for v in values]))


def length_and_rest(v: Sequence[Number], vanishing: Number) -> tuple[Number, Number, Number]:
    """Return the rounded length h of ``v``, l with h + l right to u times the root of u, and h^2.

    ``v`` is scaled already. Where ``vanishing`` is true h is 1 and l means nothing;
    h^2 is never more than near. With every
    number split into a short one and a rest, the squares of the short ones are exact and so is
    their sum with what its rounding leaves; the sum over h^2 is r, and l = r / (2 h).
    Every product that must be exact is one of short numbers: fused operations give the same.
    Source: Dekker, Numer. Math. 18 (1971) 224, halves; Knuth, TAOCP 2, 4.2.2, sums.
    """
    shift = splitter(next(c.tape for c in v if c.tape is not None)) - 1
    (x, x_low), (y, y_low), (z, z_low) = (_halves(c, shift) for c in v)
    partial, first = two_sum(x * x, y * y)
    total, second = two_sum(partial, z * z)
    beside = (v[0] + x) * x_low + (v[1] + y) * y_low + ((v[2] + z) * z_low + (first + second))
    h = select(vanishing, 1, sqrt(total + beside))
    high, low = _halves(h, shift)
    return h, ((total - high * high) + (beside - (h + high) * low)) / (h + h), total


def _halves(a: Number, shift: Number) -> tuple[Number, Number]:
    """Return ``a`` as a number of half the digits and the rest; ``shift`` is a power of two."""
    c = shift * a
    high = (c + a) - c
    return high, a - high
