"""Sums that keep what rounding takes away, and carry it to the next call.

A state that moves by small increments loses half a unit in the last place at every step. Kept
beside the state, that loss is added to the next increment, and the error of a long run no longer
grows with the number of steps.

A Runge-Kutta step gives its increment. A step that multiplies by a turn has one too: write the
turn as (1 - less, v), with ``less`` worked out without cancellation, and ``quaternion_change``
gives what the attitude gains. A momentum that is turned gains the sum of its shears (``turns``).
"""

from collections.abc import Sequence

from derive.program.tape import Number

Vector = Sequence[Number]


def compensated_add(state: Number, increment: Number, remainder: Number) -> tuple[Number, Number]:
    """Return the state after an increment, and what rounding kept from it.

    ``remainder`` is what the call before gave, zero at first; state + remainder is the better
    value. Exact while the increment is not larger than the state; where it is, the loss is a
    rounding of the increment. Source: Kahan, CACM 8 (1965) 40.
    """
    if increment.exact == 0:
        return state, remainder
    wanted = increment + remainder
    after = state + wanted
    return after, wanted - (after - state)


def closely_added(
    state: Number, increment: Number, low: Number, remainder: Number
) -> tuple[Number, Number]:
    """Return the same for an increment with a low part, of which nothing is dropped on the way.

    A low part below half a rounding of the increment would otherwise be rounded away every time.
    """
    wanted = increment + remainder
    short = remainder - (wanted - increment)
    after = state + wanted
    return after, (wanted - (after - state)) + (short + low)


def compensated_sums(
    attitude: Vector, omega: Vector, turn: Vector, change: Vector, remainder: Vector
) -> tuple[list[Number], list[Number], list[Number]]:
    """Return attitude and omega after their increments, and the remainder of the seven sums."""
    state, increments = [*attitude, *omega], [*turn, *change]
    sums = [compensated_add(*each) for each in zip(state, increments, remainder, strict=True)]
    after = [x for x, _ in sums]
    return after[:4], after[4:], [r for _, r in sums]


def two_sum(a: Number, b: Number) -> tuple[Number, Number]:
    """Return s and e with s + e = a + b exactly and s the rounded sum (Knuth)."""
    s = a + b
    t = s - a
    return s, (a - (s - t)) + (b - t)


def two_product(a: Number, b: Number, factor: Number) -> tuple[Number, Number]:
    """Return p and e with p + e = a b exactly and p the rounded product (Veltkamp and Dekker)."""
    p = a * b
    (a1, a2), (b1, b2) = _halves(a, factor), _halves(b, factor)
    return p, a1 * b1 - p + a1 * b2 + a2 * b1 + a2 * b2


def _halves(a: Number, factor: Number) -> tuple[Number, Number]:
    c = factor * a
    high = c - (c - a)
    return high, a - high
