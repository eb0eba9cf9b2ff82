"""The exact motion of a free body along its principal axes, the attitude included.

The motion from phase 0 is added to the state by addition theorems, for the momentum and for the
angle about it: the phase of the state is never worked out. No turn is reduced before its half is,
so the attitude keeps the sign of a continuous motion.
"""

from __future__ import annotations

from fractions import Fraction

from derive.motion.attitude.lengths import largest_size
from derive.motion.exact.diagonal import Three
from derive.motion.exact.elliptic import (
    HALF,
    Angle,
    Complex,
    JacobiFunctions,
    Ladder,
    angle,
    jacobi_functions,
    ladder,
)
from derive.motion.exact.orbit import Orbit, orbit, role_of_a
from derive.program.operations import absolute, cos, less, power_of_two, select, sin, sqrt
from derive.program.tape import Number

OVER = Fraction(40)
"""The phase on the separatrix after which nothing but a pure spin is left: sech 40 = 2^-57."""


def tumble(moments: Three, omega: Three, time: Number) -> tuple[list[Number], list[Number]]:
    """Return the turn (4,) and the angular velocity (3,) after ``time``, along principal axes.

    moments : in order, over any scale        omega : rad/s, not all of it zero
    """
    one, three = role_of_a(moments)
    path = orbit(one, three, omega)
    moving, resting = _until_over(path, time)
    means = ladder(path.complement)
    phase = means.mean * path.rate * moving
    at = jacobi_functions(means, sin(phase), cos(phase))
    after = _added(path, at)
    third = _third_kind(path, means, at)
    direction = _product(third.direction, _added_angle(path, at, after))
    rate = _mean_rate(path, third)
    half = path.hand * HALF * (moving * rate + resting * path.length)
    scalar, *vector = _turn(path, after, _product(direction, (cos(half), sin(half))))
    a, b, c = (path.hand * v for v in vector)
    m_1, omega_2, m_3 = path.back(after)
    return [scalar, *path.back((a, b, c))], [one.inverse * m_1, omega_2, three.inverse * m_3]


def _until_over(path: Orbit, time: Number) -> tuple[Number, Number]:
    """Return the time that the motion takes and, on the separatrix, the time after it is over."""
    phase = absolute(path.rate * time)
    moving = time * (OVER / select(less(OVER, phase), phase, OVER))
    return select(path.separatrix, moving, time), select(path.separatrix, time - moving, 0)


def _added(path: Orbit, at: JacobiFunctions) -> Three:
    """Return the momentum after the motion, along a, b, c.

    Source: DLMF 22.8(i), with 1 - k^2 sn^2 sn^2 as cn^2 + sn^2 dn^2, times A, C / r and C. That
    may be as small as k'^2, so all is worked out over a power of two near cn or sn dn.
    """
    s, n, d = at.sn, at.cn, at.dn
    t = s * (path.m[0] / path.divisor)
    size = power_of_two(largest_size((n, t)))
    (a, c, n, t, d), b = (x / size for x in (path.m[0], path.m[2], n, t, d)), path.m[1]
    scale = 1 / (n * n + t * t)
    tilt = path.c.root * path.a.inverse_root * (path.c.root * b / path.divisor)
    return (
        (a * d - tilt * c * (s * n)) * scale,
        (b * n * d + path.a.inverse_root * c * t) * scale,
        (c * n - path.a.root * b * (t * d)) * scale,
    )


def _third_kind(path: Orbit, means: Ladder, at: JacobiFunctions) -> Angle:
    """Return psi, the turn about a in the frames that the shortest turns from m to a make.

    psi' = (2 T + |m| m_a / I_a) / (|m| + m_a). From phase 0 it is of the third kind on the first
    rung of the ladder, with its pole where m_a = -|m|.
    """
    below, over = path.length + path.high * path.complement, path.length + path.high
    first = means.a[1]
    weight = path.modulus_squared * path.across_squared * path.a.inverse_root
    weight = weight / (4 * first * over * below)
    return angle(means, at, weight, sqrt(first * below / over))


def _mean_rate(path: Orbit, third: Angle) -> Number:
    """Return the mean of psi', from omega_a or omega_b and what little is to be added.

    It lies between psi' at sn = 0, from where ``third`` takes it, and psi' at cn = 0.
    """
    a, b, c = path.m
    b, g, over = absolute(b), path.length, path.length + path.high
    lowest = path.high * path.complement
    square = path.c.part * (b * b) / (path.divisor + a) * path.a.inverse
    fast = square + path.across_squared / over * path.c.inverse
    slow = (
        (a * a * path.a.inverse + c * c * path.c.inverse - b * (a * a + c * c) / (g + b))
        + lowest * (g * path.a.inverse - b)
    ) / (g + lowest)
    back = path.hand * path.rate
    tumbles = less(path.complement, HALF)
    rest = select(tumbles, slow + back * (2 * third.weight - third.rate), fast - back * third.rate)
    return select(tumbles, b, path.spin) + rest


def _added_angle(path: Orbit, at: JacobiFunctions, after: Three) -> Complex:
    """Return a complex number at half of psi less that from phase 0, by the addition theorem.

    x = 1 + d1 + d2 + d3 + A/|m| (d1 d2 + d2 d3 + d3 d1 + d1 d2 d3) and
    y = k^2 r m_b m_b' sn / (|m| (|m| + A)) with d1, d2, d3 for dn at the start, of the motion and
    at the end; the angle is -atan(y / x).
    """
    g, high = path.length, path.high
    start, end = path.m[0] / path.divisor, after[0] / path.divisor
    x = (1 + at.dn) * (1 + start * (after[0] / g)) + (start + end) * (1 + high / g * at.dn)
    y = path.modulus_squared * path.a.root * (path.m[1] / g) * (after[1] / (g + high)) * at.sn
    return x, -y


def _product(p: Complex, q: Complex) -> Complex:
    return p[0] * q[0] - p[1] * q[1], p[0] * q[1] + p[1] * q[0]


def _turn(path: Orbit, after: Three, half: Complex) -> list[Number]:
    """Return P(m)^-1 exp(psi / 2) P(m') of length 1, P(m) = (1 + m_a, 0, m_c, -m_b), |m| = 1.

    Counted as if a, b, c were right-handed: else the vector part has the wrong sign.
    """
    (a, b, c), (p, q, r) = ([v / path.length for v in m] for m in (path.m, after))
    g0, g1 = 1 + a, 1 + p
    cosine, sine = half
    y, z = cosine * r + sine * q, sine * r - cosine * q
    w, x = cosine * g1, sine * g1
    turn = [
        g0 * w + c * y - b * z,
        g0 * x - c * z - b * y,
        g0 * y - c * w + b * x,
        g0 * z + b * w + c * x,
    ]
    scale = 1 / sqrt(sum((v * v for v in turn[1:]), turn[0] * turn[0]))
    return [scale * v for v in turn]
