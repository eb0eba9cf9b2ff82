"""The exact motion of a free body along its principal axes, the attitude included.

The motion from phase 0 is added to the state by addition theorems, for the momentum and for the
angle about it: the phase of the state is never worked out. No turn is reduced before its half is,
so the attitude keeps the sign of a continuous motion.
"""

from __future__ import annotations

from fractions import Fraction

from derive.flows.elliptic import HALF, Complex, Ladder, Values, angle, functions, ladder
from derive.flows.orbit import Orbit, orbit, role_of_a
from derive.flows.principal_axes import Three
from derive.trace import Number, absolute, cos, less, named, select, sin, sqrt

OVER = Fraction(40)
"""The phase on the separatrix after which nothing but a pure spin is left: sech 40 = 2^-57."""


def tumble(moments: Three, omega: Three, time: Number) -> tuple[list[Number], list[Number]]:
    """Return the turn (4,) and the angular velocity (3,) after ``time``, along principal axes.

    moments : in order, over any scale        omega : rad/s, not all of it zero
    """
    one, three = role_of_a(moments)
    moment = named("moment_2", moments[1], "principal moment 2, over a power of two")
    inverse = named("inverse_moment_2", 1 / moments[1], "1 / moment_2")
    m = one.moment * omega[0], moment * omega[1], three.moment * omega[2]
    path = orbit(one, three, m)
    moving, resting = _until_over(path, time)
    means = ladder(path.complement)
    phase = means.mean * path.rate * moving
    at = functions(means, sin(phase), cos(phase))
    after = _added(path, at)
    rate, direction = _angle(path, means, at, after)
    half = HALF * (moving * rate + resting * (path.hand * path.length * inverse))
    scalar, *vector = _turn(path, after, _product(direction, (cos(half), sin(half))))
    a, b, c = (path.hand * v for v in vector)
    end = path.back(after)
    spin = [one.inverse * end[0], inverse * end[1], three.inverse * end[2]]
    return [scalar, *path.back((a, b, c))], spin


def _until_over(path: Orbit, time: Number) -> tuple[Number, Number]:
    """Return the time that the motion takes and, on the separatrix, the time after it is over."""
    phase = absolute(path.rate * time)
    moving = time * (OVER / select(less(OVER, phase), phase, OVER))
    return select(path.separatrix, moving, time), select(path.separatrix, time - moving, 0)


def _divisor(high: Number) -> Number:
    return select(less(0, high), high, 1)


def _added(path: Orbit, at: Values) -> Three:
    """Return the momentum after the motion, along a, b, c.

    Source: DLMF 22.8(i), with 1 - k^2 sn^2 sn^2 as cn^2 + sn^2 dn^2, times A, C / r and C.
    """
    a, b, c = path.m
    s, n, d = at.sn, at.cn, at.dn
    high = _divisor(path.high)
    t = s * (a / high)
    scale = 1 / (n * n + t * t)
    tilt = path.c.part * path.a.inverse_root / high
    return (
        (a * d - tilt * (b * c) * (s * n)) * scale,
        (b * n * d + path.a.inverse_root * c * t) * scale,
        (c * n - path.a.root * b * (t * d)) * scale,
    )


def _angle(path: Orbit, means: Ladder, at: Values, after: Three) -> tuple[Number, Complex]:
    """Return psi, the turn about a in the frames that the shortest turns from m to a make.

    psi' = (2 T + |m| m_a / I_a) / (|m| + m_a). Returns its mean rate, and a complex number at half
    of what is left. From phase 0 psi is of the third kind on the first rung of the ladder, with its
    pole where m_a = -|m|. From another phase comes -2 atan(y / x), by the addition theorem:
        x = 1 + d1 + d2 + d3 + A/|m| (d1 d2 + d2 d3 + d3 d1 + d1 d2 d3)
        y = k^2 r m_b m_b' sn / (|m| (|m| + A)),
    where d1, d2, d3 are dn at the start, of the motion and at the end: no term of x is below 0.
    """
    g, high, root = path.length, path.high, path.a.root
    below, over = g + high * path.complement, g + high
    first, lower = means.a[1], (1 - path.complement) * HALF
    weight = lower * path.across * (path.across * path.a.inverse_root) / (over * below)
    third = angle(means, at, weight, sqrt(first * below / over))
    start, motion, end = path.m[0] / _divisor(high), at.dn, after[0] / _divisor(high)
    x = (1 + motion) * (1 + start * (after[0] / g)) + (start + end) * (1 + high / g * motion)
    y = 4 * first * lower * root * path.m[1] * after[1] * at.sn / (g * over)
    spin = high * path.a.inverse + path.across * path.across * path.c.inverse / over
    return path.hand * spin - path.rate * third.rate, _product(third.direction, (x, -y))


def _product(p: Complex, q: Complex) -> Complex:
    return p[0] * q[0] - p[1] * q[1], p[0] * q[1] + p[1] * q[0]


def _turn(path: Orbit, after: Three, half: Complex) -> list[Number]:
    """Return P(m)^-1 exp(psi / 2) P(m'), P(m) = (|m| + m_a, 0, m_c, -m_b), of length 1.

    Counted as if a, b, c were right-handed: else the vector part has the wrong sign.
    """
    _, b, c = path.m
    g0, g1 = path.length + path.m[0], path.length + after[0]
    cosine, sine = half
    y, z = cosine * after[2] + sine * after[1], sine * after[2] - cosine * after[1]
    w, x = cosine * g1, sine * g1
    turn = [
        g0 * w + c * y - b * z,
        g0 * x - c * z - b * y,
        g0 * y - c * w + b * x,
        g0 * z + b * w + c * x,
    ]
    scale = 1 / sqrt(sum((v * v for v in turn[1:]), turn[0] * turn[0]))
    return [scale * v for v in turn]
