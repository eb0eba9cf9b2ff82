"""Three moments of inertia in order, whether they are numbers or parameters."""

from collections.abc import Sequence

from derive.program.operations import less, select
from derive.program.tape import Number


def in_order(moments: Sequence[Number]) -> tuple[Number, Number, Number]:
    """Return three moments, the smallest first.

    >>> from derive.program.tape import number
    >>> [int(m.exact) for m in in_order([number(3), number(1), number(2)])]
    [1, 2, 3]
    """
    x, y, z = moments
    x, y = _swapped(x, y)
    y, z = _swapped(y, z)
    x, y = _swapped(x, y)
    return x, y, z


def _swapped(x: Number, y: Number) -> tuple[Number, Number]:
    if x.exact is not None and y.exact is not None:
        return (y, x) if y.exact < x.exact else (x, y)
    first = less(y, x)
    return select(first, y, x), select(first, x, y)
