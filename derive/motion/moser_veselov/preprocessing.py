"""What makes a discrete Moser-Veselov step of order ten out of one of order two.

The step is exact to order ten for a body whose moments are changed by the invariants of the
motion: 1/I_j becomes s/I_j + d (Hairer and Vilmart, J. Phys. A 39 (2006) 13225). As published, s
and d are series in N = h^2 |l|^2/2 and H = h^2 T with coefficients that grow as 1/(I1 I2 I3)^4 and
cancel for a thin rod. Here moments are measured in the largest one, a = 1 >= b, c, and the series
is expanded again in H and delta = (N - H)/(b c), which has no cancellation of its own. The
coefficients are then polynomials in tau = (b + c - 1)/(b c) and pi = b c, and both lie between 0
and 1 for every body that keeps the triangle inequality.
"""

from collections.abc import Sequence
from fractions import Fraction

from derive.program.operations import horner
from derive.program.tape import Number, number

PiPolynomial = tuple[tuple[int, ...], ...]
PiRow = tuple[tuple[int, PiPolynomial], ...]

# Row k holds, for i = 0..k, the coefficient of delta^(k-i) H^i: a denominator and, by powers of
# pi and then of tau, the numerator. Found from the published series by exact expansion.
S: tuple[PiRow, ...] = (
    ((6, ((2,), (0, 1))), (6, ((-2, -1),))),
    (
        (30, ((1,), (-3, 1), (0, 0, 1))),
        (30, ((-4, -1), (0, -1, 1))),
        (60, ((2, 1, 2),)),
    ),
    (
        (2520, ((4,), (-32, 6), (0, -66, 36), (0, 0, 0, 17))),
        (840, ((-12, -2), (44, -36, 20), (0, 0, -12, 5))),
        (2520, ((64, -30, 36), (0, 6, -19, -15))),
        (2520, ((-4, -2, 9, -17),)),
    ),
    (
        (45360, ((2,), (-30, 4), (378, -321, 156), (0, 0, -342, 154), (0, 0, 0, 0, 62))),
        (22680, ((-16, -2), (240, -294, 150), (0, 306, -393, 75), (0, 0, 0, -77, 47))),
        (7560, ((38, -43, 26), (-102, 134, -49, -25), (0, 0, 26, -22, 11))),
        (22680, ((-64, 30, 69, -77), (0, -2, 18, -39, 47))),
        (45360, ((2, 1, 39, -95, 62),)),
    ),
)
D: tuple[PiRow, ...] = (
    ((3, ((-1,),)), (6, ((0, 1),))),
    ((60, ((-2,), (0, -1))), (60, ((8, 2), (0, 0, -1))), (60, ((0, -1, -2),))),
    (
        (2520, ((-4,), (72, -4), (0, 0, -19))),
        (2520, ((36, 6), (0, -2, -47), (0, 0, 0, 2))),
        (2520, ((-64, 30, -36), (0, 0, 13, 17))),
        (2520, ((0, 2, -9, 17),)),
    ),
    (
        (45360, ((-2,), (-124, -3), (0, 243, -123), (0, 0, 0, -61))),
        (45360, ((32, 4), (-864, 816, -270), (0, 0, 222, -30), (0, 0, 0, 0, -1))),
        (15120, ((-76, 86, -52), (0, 38, -28, 60), (0, 0, 0, -10, -11))),
        (45360, ((128, -60, -138, 154), (0, 0, -30, 74, -93))),
        (45360, ((0, -1, -39, 95, -62),)),
    ),
)


def pi_coefficients(series: Sequence[PiRow], tau: Number, pi: Number) -> list[list[Number]]:
    """Return a series' coefficients for one body: row k, i = 0..k, of delta^(k-i) H^i."""
    return [
        [
            horner([horner([number(c) for c in inner], tau) for inner in polynomial], pi)
            * Fraction(1, denominator)
            for denominator, polynomial in row
        ]
        for row in series
    ]


def summed(rows: Sequence[Sequence[Number]], delta: Number, H: Number) -> Number:
    """Return a series without its constant term: row k times the powers of delta and H."""
    powers = [[number(1)], [number(1)]]
    for held, x in zip(powers, (delta, H), strict=True):
        for _ in rows:
            held.append(held[-1] * x)
    total = number(0)
    for k in reversed(range(len(rows))):
        order = k + 1
        for i, coefficient in enumerate(rows[k]):
            total = total + coefficient * powers[0][order - i] * powers[1][i]
    return total
