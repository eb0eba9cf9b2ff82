"""Numbers together with their derivatives, forward; without columns there are none to carry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from derive.motion.attitude.quaternion import conjugate, exponential, norm_squared
from derive.motion.attitude.quaternion import product as hamilton
from derive.motion.runge_kutta.matrices import (
    Matrix,
    NumberRow,
    minus,
    plus,
    product,
    right_matrix,
    sandwich_matrix,
    tangent_matrix,
    times,
    zeros,
)
from derive.program.operations import less, select, sqrt
from derive.program.tape import Number, number

TINY = Fraction(1, 2**40)
"""Below, the squared angle of a turn leaves nothing of what is multiplied by it."""


@dataclass(frozen=True)
class Varying:
    """Values (n) and their derivatives (n, m)."""

    values: NumberRow
    slopes: Matrix

    def __getitem__(self, place: slice) -> Varying:
        return Varying(self.values[place], self.slopes[place])

    def replaced(self, place: slice, part: Varying) -> Varying:
        """Return these with some of them replaced."""
        before, after = slice(place.start), slice(place.stop, None)
        return Varying(
            [*self.values[before], *part.values, *self.values[after]],
            [*self.slopes[before], *part.slopes, *self.slopes[after]],
        )


def weighed(weights: Sequence[Number | Fraction | int], parts: Sequence[Varying]) -> Varying:
    """Return a sum with weights; parts of equal weights are added first."""
    groups: dict[object, list[int]] = {}
    for place, weight in enumerate(weights):
        groups.setdefault(number(weight).operand, []).append(place)
    total: Varying | None = None
    for places in groups.values():
        values, slopes = parts[places[0]].values, parts[places[0]].slopes
        for k in places[1:]:
            values = [x + y for x, y in zip(values, parts[k].values, strict=True)]
            slopes = plus(slopes, parts[k].slopes)
        weight = weights[places[0]]
        part = Varying([x * weight for x in values], times(weight, slopes))
        total = part if total is None else added(total, part)
    return total or Varying([], [])


def added(a: Varying, b: Varying) -> Varying:
    """Return a sum."""
    values = [x + y for x, y in zip(a.values, b.values, strict=True)]
    return Varying(values, plus(a.slopes, b.slopes))


def turned(q: Varying, vector: Varying) -> Varying:
    """Return q exp(v / 2) for a rotation vector v (3), rad, along body axes.

    Its derivative is dq exp(v / 2) + q exp(v / 2) (0, J dv) / 2, J the right Jacobian of SO(3)
    (Sola 2017, eq. 143).
    """
    turn = exponential(vector.values)
    after = hamilton(q.values, turn)
    half = times(Fraction(1, 2), product(right_jacobian(vector.values, turn), vector.slopes))
    slopes = plus(product(right_matrix(turn), q.slopes), product(tangent_matrix(after), half))
    return Varying(after, slopes)


def right_jacobian(v: NumberRow, turn: NumberRow) -> Matrix:
    """Return J (3, 3): exp((v + dv) / 2) = exp(v / 2) exp(J dv / 2) to first order.

    1 - 2 r^2 [v]x + k (v v' - |v|^2), r = sin(|v|/2) / |v|, k = (1 - sin|v| / |v|) / |v|^2.
    For small angles k loses digits, as many as its factor of |v|^2 takes away again.
    """
    squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    small = less(squared, TINY)
    along = v[0] * turn[1] + v[1] * turn[2] + v[2] * turn[3]
    divisor = select(small, 1, squared)
    ratio = select(small, Fraction(1, 2), along / divisor)
    k = select(small, Fraction(1, 6), (1 - 2 * ratio * turn[0]) / divisor)
    x, y, z = (2 * ratio * c for c in turn[1:])
    kv = [k * c for c in v]
    one = 1 - k * squared
    return [
        [one + kv[0] * v[0], kv[0] * v[1] + z, kv[0] * v[2] - y],
        [kv[0] * v[1] - z, one + kv[1] * v[1], kv[1] * v[2] + x],
        [kv[0] * v[2] + y, kv[1] * v[2] - x, one + kv[2] * v[2]],
    ]


def whole_turn(vectors: Sequence[Varying]) -> Varying:
    """Return exp(v1 / 2) exp(v2 / 2) ... , its slopes as the turn (3, rad) that they are.

    These are along body axes after the turn, as an error of attitude is.
    """
    whole = [number(1), *[number(0)] * 3]
    bent = zeros(3, len(vectors[0].slopes[0]))
    for vector in vectors:
        turn = exponential(vector.values)
        own = product(right_jacobian(vector.values, turn), vector.slopes)
        bent = plus(product(sandwich_matrix(conjugate(turn), turn), bent), own)
        whole = hamilton(whole, turn)
    return Varying(whole, bent)


def finished(q: Varying, turn: Varying) -> Varying:
    """Return an attitude after a whole ``turn``, of length one."""
    after = hamilton(q.values, turn.values)
    scale = 1 / sqrt(norm_squared(after))
    after = [x * scale for x in after]
    slopes = times(scale, product(right_matrix(turn.values), q.slopes))
    slopes = minus(slopes, product([[x] for x in after], product([after], slopes)))
    bent = product(tangent_matrix(after), times(Fraction(1, 2), turn.slopes))
    return Varying(after, plus(slopes, bent))
