"""Elliptic functions and an angle of the third kind, from one ladder of means.

A rung squares what is left of the modulus, so few rungs serve every modulus. The functions climb
from sine and cosine of M u, which keeps the real period: arguments of any size are reduced by sine
and cosine alone, and no quarter period is needed. The angle is a sum of arcs, each half as heavy
as the one before; roots of complex numbers halve them, and no arc is ever worked out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from derive.program.operations import sqrt
from derive.program.tape import Number, number

RUNGS = 12
"""From the least complementary modulus of a double, 2^-537, to means that agree in 53 bits."""

HALF = Fraction(1, 2)
Complex = tuple[Number, Number]


@dataclass(frozen=True)
class Ladder:
    """Arithmetic means a and geometric means b, from 1 and the complementary modulus k' > 0."""

    a: tuple[Number, ...]
    b: tuple[Number, ...]

    @property
    def mean(self) -> Number:
        """Return M(1, k'); pi / (2 M) is the quarter period."""
        return self.a[-1]


def ladder(complement: Number, rungs: int = RUNGS) -> Ladder:
    """Return the means from 1 and k'.  Source: DLMF 22.20(ii)."""
    a, b = [number(1)], [complement]
    for _ in range(rungs):
        mean, product = (a[-1] + b[-1]) * HALF, a[-1] * b[-1]
        a.append(mean)
        b.append(sqrt(product))
    return Ladder(tuple(a), tuple(b))


@dataclass(frozen=True)
class JacobiFunctions:
    """sn, cn, dn at an argument; then sn cn, sn^2, cn^2 and dn of the first rung at the same."""

    sn: Number
    cn: Number
    dn: Number
    first: tuple[Number, Number, Number, Number]


def jacobi_functions(means: Ladder, sine: Number, cosine: Number) -> JacobiFunctions:
    """Return the elliptic functions of u from sine and cosine of M u.

    cs = y / sine climbs from cot by factors dn: only y changes, and nothing divides by zero.
    Source: Gauss's transformation, DLMF 22.7(i); Bulirsch, Numer. Math. 7 (1965) 78, `sncndn`.
    """
    a, b, square = means.a, means.b, sine * sine
    y, dn = means.mean * cosine, number(1)
    rungs: list[Complex] = []
    for n in reversed(range(len(a) - 1)):
        high, low = a[n + 1] * square, y * y
        rungs.append((y, dn))
        y, dn = y * dn, (b[n] * high + low) / (a[n] * high + low)
    scale = 1 / sqrt(square + y * y)
    return JacobiFunctions(sine * scale, y * scale, dn, _first(a[1], sine, square, *rungs[-1]))


def _first(
    a: Number, sine: Number, square: Number, y: Number, dn: Number
) -> tuple[Number, Number, Number, Number]:
    """Return sn cn, sn^2, cn^2, dn on the first rung, where cs = y / (a sine)."""
    high, low = a * a * square, y * y
    scale = 1 / (high + low)
    return a * sine * y * scale, high * scale, low * scale, dn


@dataclass(frozen=True)
class Angle:
    """``rate`` u - 2 arg ``direction``, the direction of any length and right of the axis."""

    weight: Number
    rate: Number
    direction: Complex


def angle(means: Ladder, at: JacobiFunctions, weight: Number, pole: Number) -> Angle:
    """Return twice T(u) = kappa int_0^u P^2 / (C^2 + P^2), on the first rung, where C = a cs.

    weight, pole : kappa and P there; P >= a, and kappa^2 = (P^2 - a^2) (P^2 - b^2) / P^2
    Landen's transformation takes u to 2 u, C to (C - a b / C) / 2 and P to (P + Q) / 2 with
    Q = a b / P. By differentiation, with kappa' = kappa (P - Q) / (2 (P + Q)) on the next rung,
        2 T(u) = kappa u - atan(kappa sn cn / (a dn)) + T'(2 u).
    """
    product, sn2, cn2, dn = at.first
    rate, tangents, first = number(0), list[Number](), weight
    for a, b in zip(means.a[1:-1], means.b[1:-1], strict=True):
        rate = rate + weight
        ratio = b / a
        quotient = product / dn
        tangents.append(weight / a * quotient)
        sn, lower, upper = (1 + ratio) * quotient, cn2 / dn, ratio * sn2 / dn
        cn, dn = lower - upper, lower + upper
        product, sn2, cn2 = sn * cn, sn * sn, cn * cn
        other = a * b / pole
        sum_ = pole + other
        weight, pole = weight * (pole - other) / (2 * sum_), sum_ * HALF
    return Angle(first, rate, _halved(_direction(tangents)))


def _direction(tangents: Sequence[Number]) -> Complex:
    """Return a complex number at atan(t0) + atan(t1) / 2 + atan(t2) / 4 + ... < pi."""
    direction = (number(1), tangents[-1])
    for t in reversed(tangents[:-1]):
        x, y = _halved(direction)
        direction = (x - t * y, y + t * x)
    return direction


def _halved(direction: Complex) -> Complex:
    x, y = direction
    return x + sqrt(x * x + y * y), y
