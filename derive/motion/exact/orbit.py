"""What stays the same while a free body tumbles: which axis it goes round, and how.

Moments are in order along axes 1, 2, 3. The angular momentum m goes round axis a, which is 1 or 3;
axis 2 is b, and c is the one left. By half a turn about b, m_a is never below 0. Then
m = (A dn, C sn / r, C cn) of one phase, and its modulus, A and C follow without a difference but
one, the distance from the separatrix.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from derive.motion.attitude.lengths import hypotenuse, length_of
from derive.motion.exact.diagonal import Three, quotient, square_root
from derive.program.operations import absolute, at_most, both, less, select, sqrt
from derive.program.tape import Number, named, number

NEARLY_ZERO = Fraction(1, 2**100)
"""The complementary modulus on the separatrix, where the motion is over long before its period."""


@dataclass(frozen=True)
class EndAxis:
    """What set-up knows of axis 1 or 3 in the role of a, over I_2.

    part  : r^2 = I_c (I_b - I_a) / (I_b (I_c - I_a)); it becomes 1 - r^2 if a and c change places
    speed : rate of the phase over A, r I_b |I_c - I_a| / (I_a I_c)
    """

    moment: Number
    inverse: Number
    part: Number
    root: Number
    inverse_root: Number
    speed: Number


def role_of_a(moments: Three) -> tuple[EndAxis, EndAxis]:
    """Return the roles of axis 1 and of axis 3, constants of set-up."""
    i1, i2, i3 = moments
    across = i2 * (i3 - i1)
    parts = quotient(i3 * (i2 - i1), across, 1), quotient(i1 * (i3 - i2), across, 0)
    speed = across / (i1 * i3)
    one, three = (
        EndAxis(
            named(f"moment_{k}", i / i2, f"principal moment {k} over moment 2"),
            named(f"inverse_moment_{k}", i2 / i, f"1 / moment_{k}"),
            named(f"part_{k}", part, f"share of m_2^2 that is added to m_{4 - k}^2"),
            named(f"root_{k}", square_root(part), f"root of part_{k}"),
            named(f"inverse_root_{k}", quotient(number(1), square_root(part), 0), f"1 / root_{k}"),
            named(
                f"speed_{k}",
                square_root(part) * speed,
                f"rate of the phase if m goes round axis {k}",
            ),
        )
        for k, i, part in ((1, i1, parts[0]), (3, i3, parts[1]))
    )
    return one, three


@dataclass(frozen=True)
class Orbit:
    """The state in the roles a, b, c and what stays the same.

    m : angular momentum over I_2, along a, b, c; m_b is omega_b     spin : |omega_a|
    high : the largest m_a     across_squared : the square of the largest m_c
    length : of m     complement : k'
    rate : of the phase     a_is_1, separatrix : truths, the second of being on it exactly
    hand : 1 if (a, b, c) is right-handed, else -1     sign : 1, or -1 after half a turn about b
    """

    m: Three
    spin: Number
    a: EndAxis
    c: EndAxis
    high: Number
    across_squared: Number
    length: Number
    complement: Number
    a_is_1: Number
    separatrix: Number
    hand: Number
    sign: Number

    @property
    def rate(self) -> Number:
        """Return the rate of the phase."""
        return self.a.speed * self.high

    @property
    def divisor(self) -> Number:
        """Return the largest m_a, or 1 where that is zero: m_a stays zero there, and so does m."""
        return select(less(0, self.high), self.high, 1)

    @property
    def modulus_squared(self) -> Number:
        """Return k^2, with all its digits where it is small."""
        ratio = self.c.root * self.a.inverse_root / self.divisor
        return ratio * ratio * self.across_squared

    def back(self, v: Three) -> list[Number]:
        """Return the components along 1, 2, 3 of a vector along a, b, c."""
        a, c = v[0] * self.sign, v[2] * self.sign
        return [select(self.a_is_1, a, c), v[1], select(self.a_is_1, c, a)]


def orbit(one: EndAxis, three: EndAxis, omega: Three) -> Orbit:
    """Return the orbit of an angular velocity along axes 1, 2, 3.

    Source: Celledoni, Fasso, Saefstroem and Zanna, SIAM J. Sci. Comput. 30 (2008) 2084, section 2,
    with k'^2 = |part_1 m_1^2 - part_3 m_3^2| / (r A)^2 for their 1 - k^2, as a product of roots:
    a rate may be so small beside the others that its square vanishes, and yet it turns the body.
    """
    m_1, m_b, m_3 = one.moment * omega[0], omega[1], three.moment * omega[2]
    pull_1, pull_3 = one.root * absolute(m_1), three.root * absolute(m_3)
    a_is_1 = at_most(pull_3, pull_1)
    a, c = _chosen(a_is_1, one, three), _chosen(a_is_1, three, one)
    spin, m_a, m_c = (select(a_is_1, *v) for v in ((omega[0], omega[2]), (m_1, m_3), (m_3, m_1)))
    sign = select(less(spin, 0), -1, 1)
    m_a, m_c, b = absolute(m_a), m_c * sign, absolute(m_b)
    high, around = hypotenuse(m_a, c.root * b), a.root * m_b
    gap, scale = absolute(pull_1 - pull_3), a.root * high
    some = less(0, scale)
    scale = select(some, scale, 1)
    complement = select(some, sqrt(gap / scale) * sqrt((pull_1 + pull_3) / scale), 1)
    separatrix = both(some, at_most(gap, 0))
    complement = select(separatrix, NEARLY_ZERO, complement)
    hand = select(a_is_1, 1, -1)
    m, across_squared = (m_a, m_b, m_c), m_c * m_c + around * around
    found = a, c, high, across_squared, length_of(m), complement, a_is_1, separatrix, hand, sign
    return Orbit(m, absolute(spin), *found)


def _chosen(condition: Number, yes: EndAxis, no: EndAxis) -> EndAxis:
    pairs = zip(vars(yes).values(), vars(no).values(), strict=True)
    return EndAxis(*(select(condition, a, b) for a, b in pairs))
