"""A step that carries what rounding leaves to the next: increments, summed with a remainder.

A quaternion's length is kept by an increment too. What rounding does to that part is along the
quaternion: it changes its length, which the next step mends, and never its direction.
"""

from __future__ import annotations

from collections.abc import Sequence

from derive.motion.runge_kutta.attitude_stages import norm_squared
from derive.motion.runge_kutta.compensated import compensated_add
from derive.motion.runge_kutta.system import System
from derive.program.operations import sqrt
from derive.program.program import Quantity
from derive.program.tape import Number

Row = list[Number]
REMAINDER = "remainder"
"""The quantity that carries what rounding left; it has no range but that of rounding."""


def remainder(states: Sequence[Quantity]) -> Quantity:
    """Return the quantity that carries what rounding left of earlier steps: zeros at the start."""
    parts = tuple(f"remainder_{c}" for q in states for c in q.components)
    says = "what rounding left of earlier steps, zeros at the start"
    return Quantity(REMAINDER, parts, (len(parts),), "", "", None, None, says, "remainder")


def carried_on(system: System, start: Row, increments: Row, remainders: Row) -> tuple[Row, Row]:
    """Return the state after its increments, and what rounding leaves of them."""
    gains = list(increments)
    for place in system.quaternions:
        gains[place] = on_the_sphere(start[place], increments[place])
    sums = [compensated_add(*each) for each in zip(start, gains, remainders, strict=True)]
    return [after for after, _ in sums], [rest for _, rest in sums]


def on_the_sphere(q: Row, increment: Row) -> Row:
    """Return an increment of a quaternion (4) after which it is of length one.

    d + (q + d) (s - 1),  s = 1 / |q + d|: s - 1 from e = |q + d|^2 - 1 without cancellation.
    """
    along = sum((x * d for x, d in zip(q[1:], increment[1:], strict=True)), q[0] * increment[0])
    excess = (norm_squared(q) - 1) + (2 * along + norm_squared(increment))
    length = sqrt(1 + excess)
    less = -excess / (length * (1 + length))
    return [d + (x + d) * less for x, d in zip(q, increment, strict=True)]
