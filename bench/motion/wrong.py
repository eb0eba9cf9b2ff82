"""How wrong an end state is: omega, attitude, kinetic energy and angular momentum."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal, localcontext
from fractions import Fraction

from bench.motion.case import Case

ROUNDOFF = {"f32": 2.0**-24, "f64": 2.0**-53}
DIGITS = 60
Exact = Sequence[Fraction]


@dataclass(frozen=True)
class Wrong:
    """Errors at the end of a motion; each is NaN if the state is not finite.

    omega : norm of the error over the norm      attitude : angle in rad, up to the sign of q
    energy, momentum : relative, against those of the reference; momentum is its length
    """

    omega: float
    attitude: float
    energy: float
    momentum: float

    @property
    def state(self) -> float:
        """Return the larger error of omega and attitude: what "the error" means."""
        return max(self.omega, self.attitude, key=lambda x: math.inf if math.isnan(x) else x)


def wrong(case: Case, state: Sequence[float]) -> Wrong:
    """Return the errors of (attitude, omega) at the end of a case."""
    if not all(map(math.isfinite, state)):
        return Wrong(math.nan, math.nan, math.nan, math.nan)
    q, w = [Fraction(x) for x in state[:4]], [Fraction(x) for x in state[4:]]
    change = [a - b for a, b in zip(w, case.omega_T, strict=True)]
    energy, length = invariants(case, w)
    energy_T, length_T = invariants(case, case.omega_T)
    return Wrong(
        _ratio(norm(change), norm(case.omega_T)),
        angle(q, case.q_T),
        _ratio(abs(energy - energy_T), energy_T),
        _ratio(abs(length - length_T), length_T),
    )


def angle(p: Exact, q: Exact) -> float:
    """Return the angle in rad between two attitudes, whatever their lengths and signs.

    >>> q = (Fraction(3, 5), Fraction(4, 5), Fraction(0), Fraction(0))
    >>> angle(q, [-x for x in q])
    0.0
    """
    a, x, b, y = p[0], p[1:], q[0], q[1:]
    vector = [a * y[i] - b * x[i] - (x[i - 2] * y[i - 1] - x[i - 1] * y[i - 2]) for i in range(3)]
    scalar = sum((m * n for m, n in zip(p, q, strict=True)), Fraction(0))
    return 2 * math.atan2(_float(norm(vector)), _float(abs(scalar)))


def invariants(case: Case, w: Exact) -> tuple[Fraction, Fraction]:
    """Return kinetic energy and length of the angular momentum with this omega."""
    xx, yy, zz, xy, xz, yz = case.inertia
    turning = (
        xx * w[0] + xy * w[1] + xz * w[2],
        xy * w[0] + yy * w[1] + yz * w[2],
        xz * w[0] + yz * w[1] + zz * w[2],
    )
    energy = sum((a * b for a, b in zip(turning, w, strict=True)), Fraction(0)) / 2
    return energy, norm([a + b for a, b in zip(turning, case.wheel, strict=True)])


def norm(a: Exact) -> Fraction:
    """Return the length of a vector, to ``DIGITS`` digits."""
    squares = sum((x * x for x in a), Fraction(0))
    with localcontext() as context:
        context.prec = DIGITS
        return Fraction((Decimal(squares.numerator) / Decimal(squares.denominator)).sqrt())


def _ratio(a: Fraction, b: Fraction) -> float:
    return _float(a / b if b else a)


def _float(x: Fraction) -> float:
    """Return the float next to ``x``; infinity beyond the largest."""
    try:
        return float(x)
    except OverflowError:
        return math.inf
