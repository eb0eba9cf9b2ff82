"""Principal axes and moments of any tensor of inertia, found where set-up works.

Two moments that are nearly equal decide how fast a body tumbles by their difference, so the tensor
is diagonalised in the pairs of set-up: there a difference of 1e-12 still has all its digits. What
numbers alone decide is decided here, and leaves no operation behind.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from derive.motion.exact.inertia import Inertia
from derive.program.operations import absolute, less, power_of_two, select, sqrt
from derive.program.recorded import repeat
from derive.program.tape import Number, number

BITS = 192  # kept of an exact root, and of exact numbers from turn to turn
NOTHING = 4608  # bits below the size of a tensor, of whose doubles no square is below 2^-4196
PASSES = 8  # over the three pairs of axes; six reach 2^-106 from any tensor tried
TURNS = ((0, 1, 2), (0, 2, 1), (1, 2, 0))

Three = tuple[Number, Number, Number]


@dataclass(frozen=True)
class Diagonal:
    """Moments over ``size``, smallest first, and the axes they belong to.

    size : a power of two near their sum
    axes : three right-handed unit vectors along body axes, the rows of the turn from those axes
    """

    moments: Three
    axes: tuple[list[Number], list[Number], list[Number]]
    size: Number


def diagonalised(body: Inertia) -> Diagonal:
    """Return the principal axes of a body, in set-up.

    Source: cyclic rotations of Jacobi, Crelle 30 (1846) 51, in the form of Golub and Van Loan 8.5.
    """
    xx, yy, zz, *products = body.tensor
    size = power_of_two(xx + yy + zz)
    moments, products = [m / size for m in (xx, yy, zz)], [p / size for p in products]
    rows = [[number(int(i == j)) for j in range(3)] for i in range(3)]
    if body.kind == "general":
        moments, rows = _turned_to_principal(moments, products, rows)
    for i, j in ((0, 1), (1, 2), (0, 1)):
        moments, rows = _in_order(i, j, moments, rows)
    return Diagonal((moments[0], moments[1], moments[2]), (rows[0], rows[1], rows[2]), size)


def square_root(x: Number) -> Number:
    """Return the square root, to ``BITS`` bits if ``x`` is an exact number."""
    if x.exact is None:
        return sqrt(x)
    shift = BITS + max(0, x.exact.denominator.bit_length() - x.exact.numerator.bit_length())
    return number(Fraction(isqrt(int(x.exact * 4**shift)), 2**shift))


def quotient(a: Number, b: Number, otherwise: int) -> Number:
    """Return a / b for b > 0, and ``otherwise`` where b is 0."""
    some = less(0, b)
    return select(some, a / select(some, b, 1), otherwise)


def _in_order(
    i: int, j: int, moments: Sequence[Number], rows: Sequence[list[Number]]
) -> tuple[list[Number], list[list[Number]]]:
    """Return moments and axes with those of i and j exchanged where the first is larger."""
    m, r = list(moments), list(rows)
    a, b = moments[i], moments[j]
    other = less(b, a)
    m[i], m[j] = select(other, b, a), select(other, a, b)
    r[i] = [select(other, q, p) for p, q in zip(rows[i], rows[j], strict=True)]
    r[j] = [select(other, -p, q) for p, q in zip(rows[i], rows[j], strict=True)]
    return m, r


def _turned_to_principal(
    moments: Sequence[Number], products: Sequence[Number], rows: Sequence[list[Number]]
) -> tuple[list[Number], list[list[Number]]]:
    values = [*moments, *products, *(x for row in rows for x in row)]
    tapes = [x.tape for x in values if x.tape is not None]
    if tapes:
        values = repeat(tapes[0], PASSES, values, lambda carried: (_pass(carried), None))
    else:
        for _ in range(PASSES):
            values = _pass(values)
    return values[:3], [values[6:9], values[9:12], values[12:15]]


def _shortened(x: Number) -> Number:
    if x.exact is None or not x.exact:
        return x
    below = x.exact.denominator.bit_length() - x.exact.numerator.bit_length()
    if below > NOTHING:
        return number(0)
    unit = Fraction(2) ** (BITS + below)
    return number(round(x.exact * unit) / unit)


def _pass(carried: Sequence[Number]) -> list[Number]:
    """Return moments, products (xy, xz, yz) and rows after one turn in each pair of axes."""
    values = list(carried)
    for p, q, r in TURNS:
        values = [_shortened(x) for x in _turn(p, q, r, values)]
    return values


def _turn(p: int, q: int, r: int, values: Sequence[Number]) -> list[Number]:
    """Return the values after the turn that makes the product of axes p and q vanish."""
    new = list(values)
    pq, rp, rq = (_place(p, q), _place(r, p), _place(r, q))
    across = values[q] - values[p]
    size = square_root(across * across + 4 * values[pq] * values[pq])
    divisor = select(less(across, 0), across - size, across + size)
    vanishes = quotient(number(1), absolute(divisor), 0)
    tangent = select(less(0, divisor), vanishes, -vanishes) * (2 * values[pq])
    cosine = 1 / square_root(1 + tangent * tangent)
    sine = tangent * cosine
    new[p] = values[p] - tangent * values[pq]
    new[q] = values[q] + tangent * values[pq]
    new[pq] = number(0)
    new[rp] = cosine * values[rp] - sine * values[rq]
    new[rq] = sine * values[rp] + cosine * values[rq]
    for j in range(3):
        one, other = 6 + 3 * p + j, 6 + 3 * q + j
        new[one] = cosine * values[one] - sine * values[other]
        new[other] = sine * values[one] + cosine * values[other]
    return new


def _place(i: int, j: int) -> int:
    return {(0, 1): 3, (0, 2): 4, (1, 2): 5}[(min(i, j), max(i, j))]
