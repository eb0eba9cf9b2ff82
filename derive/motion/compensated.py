"""Sums that keep what rounding takes away, and carry it to the next call.

A state that moves by small increments loses half a unit in the last place at every step. Kept
beside the state, that loss is added to the next increment, and the error of a long run no longer
grows with the number of steps.

A Runge-Kutta step gives its increment. A step that multiplies by a turn has one too: write the
turn as (1 - less, v), with ``less`` worked out without cancellation, and ``quaternion_change``
gives what the attitude gains. A momentum that is turned gains the sum of its shears (``turns``).
"""

from collections.abc import Sequence

from derive.motion.attitude.quaternion import norm_squared
from derive.program.operations import sqrt
from derive.program.program import Quantity
from derive.program.tape import Number, Vector

REMAINDER = "remainder"
"""The quantity that carries what rounding left; it has no range but that of rounding."""


def remainder(states: Sequence[Quantity]) -> Quantity:
    """Return the quantity that carries what rounding left of earlier steps: zeros at the start."""
    parts = tuple(f"remainder_{c}" for q in states for c in q.components)
    says = "what rounding left of earlier steps, each in its own unit, zeros at the start"
    return Quantity(REMAINDER, parts, (len(parts),), "", "", None, None, says, "remainder")


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
    state: Number, increment: Number, remainder: Number, low: Number
) -> tuple[Number, Number]:
    """Return the same for an increment with a low part, of which nothing is dropped on the way.

    A low part below half a rounding of the increment would otherwise be rounded away every time.
    """
    wanted = increment + remainder
    short = remainder - (wanted - increment)
    after = state + wanted
    return after, (wanted - (after - state)) + (short + low)


def compensated_sums(state: Vector, increments: Vector, remainder: Vector) -> list[Number]:
    """Return a state after its increments, and then what rounding kept from each."""
    sums = [compensated_add(*each) for each in zip(state, increments, remainder, strict=True)]
    return [part for parts in zip(*sums, strict=True) for part in parts]


def normalising_increment(q: Vector, increment: Vector) -> list[Number]:
    """Return an increment of a quaternion (4) after which it is of length one.

    d + (q + d) (s - 1),  s = 1 / |q + d|: s - 1 from e = |q + d|^2 - 1 without cancellation. What
    rounding does to that part is along the quaternion: it changes its length, which the next step
    mends, and never its direction.
    """
    along = sum((x * d for x, d in zip(q[1:], increment[1:], strict=True)), q[0] * increment[0])
    excess = (norm_squared(q) - 1) + (2 * along + norm_squared(increment))
    length = sqrt(1 + excess)
    less = -excess / (length * (1 + length))
    return [d + (x + d) * less for x, d in zip(q, increment, strict=True)]
