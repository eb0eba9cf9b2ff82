"""Euler's equations integrated by their Taylor series, to fifty digits: a judge of motions."""

from collections.abc import Sequence
from math import ceil

import flint

BITS = 230
ORDER = 60
REACH = 0.5  # rad a step: the terms fall to 1e-50 well within the order


def integrated(tensor: Sequence[float], state: Sequence[float]) -> tuple[flint.arb, ...]:
    """Return attitude and angular velocity (7,) of a body (6,) after a state and a time (8,)."""
    with flint.ctx.workprec(BITS):
        xx, yy, zz, xy, xz, yz = (flint.arb(float(x)) for x in tensor)
        inertia = flint.arb_mat([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        inverse = inertia.inv()
        now = [flint.arb(float(x)) for x in state[:7]]
        spread = float(max(tensor[:3]) / min(tensor[:3]))
        fast = spread * sum(abs(float(x)) for x in state[4:7])
        steps = max(1, ceil(abs(float(state[7])) * fast / REACH))
        h = flint.arb(float(state[7])) / steps
        for _ in range(steps):
            now = [x.mid() for x in _step(inertia, inverse, now, h)]
        return tuple(now)


def _step(
    inertia: flint.arb_mat, inverse: flint.arb_mat, now: Sequence[flint.arb], h: flint.arb
) -> list[flint.arb]:
    """Return the state a step later, from the terms of w' = J (I w x w) and q' = q w / 2."""
    q, w = [[x] for x in now[:4]], [[x] for x in now[4:]]
    m = [[flint.arb(0)] for _ in range(3)]
    _append(m, inertia, w)
    for n in range(ORDER):
        rate = [
            _cauchy(m[i], w[j], n) - _cauchy(m[j], w[i], n) for i, j in ((1, 2), (2, 0), (0, 1))
        ]
        for i in range(3):
            w[i].append(sum((inverse[i, j] * rate[j] for j in range(3)), flint.arb(0)) / (n + 1))
        turned = _turned(q, w, n)
        for i in range(4):
            q[i].append(turned[i] / (2 * (n + 1)))
        _append(m, inertia, w)
    return [_value(x, h) for x in (*q, *w)]


def _append(
    m: list[list[flint.arb]], inertia: flint.arb_mat, w: Sequence[Sequence[flint.arb]]
) -> None:
    for i in range(3):
        term = sum((inertia[i, j] * w[j][-1] for j in range(3)), flint.arb(0))
        m[i] = [*m[i][: len(w[0]) - 1], term]


def _turned(
    q: Sequence[Sequence[flint.arb]], w: Sequence[Sequence[flint.arb]], n: int
) -> list[flint.arb]:
    """Return term n of q (0, w)."""
    a, b, c, d = q
    x, y, z = w
    return [
        -_cauchy(b, x, n) - _cauchy(c, y, n) - _cauchy(d, z, n),
        _cauchy(a, x, n) + _cauchy(c, z, n) - _cauchy(d, y, n),
        _cauchy(a, y, n) + _cauchy(d, x, n) - _cauchy(b, z, n),
        _cauchy(a, z, n) + _cauchy(b, y, n) - _cauchy(c, x, n),
    ]


def _cauchy(a: Sequence[flint.arb], b: Sequence[flint.arb], n: int) -> flint.arb:
    return sum((a[k] * b[n - k] for k in range(n + 1)), flint.arb(0))


def _value(terms: Sequence[flint.arb], h: flint.arb) -> flint.arb:
    value = flint.arb(0)
    for term in reversed(terms):
        value = value * h + term
    return value
