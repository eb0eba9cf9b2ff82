"""Modified Rodrigues parameters: the axis times the tangent of a quarter of the angle.

Of the two sets for a rotation the one with |mrp| <= 1 is given (the other is its shadow), so that
there is no singular attitude. Source: Schaub and Junkins, J. Astronaut. Sci. 44 (1996) 1.
"""

from collections.abc import Sequence

from derive.motion.attitude.lengths import FAR, largest_size, squares
from derive.program.operations import absolute, less, power_of_two, select
from derive.program.tape import Number


def from_quaternion(q: Sequence[Number]) -> list[Number]:
    """Return the parameters (3) of a unit quaternion, |mrp| <= 1 up to rounding. Within 4 u."""
    w, *u = q
    under = 1 + absolute(w)
    under = select(less(w, 0), -under, under)
    return [c / under for c in u]


def to_quaternion(mrp: Sequence[Number]) -> list[Number]:
    """Return the unit quaternion (4) of any parameters: scalar and vector part each within 4 u.

    With p a power of two near the largest parameter if that is large, else 1, and s = mrp / p:
    w = (1/p^2 - s.s) / (1/p^2 + s.s), the vector part is 2 s / p over the same.
    """
    m = largest_size(mrp)
    inverse = 1 / power_of_two(select(less(FAR, m), m * (1 / FAR), 1))
    s = [c * inverse for c in mrp]
    one, ss = inverse * inverse, squares(s)
    twice, under = inverse + inverse, one + ss
    return [(one - ss) / under, *(twice * (c / under) for c in s)]
