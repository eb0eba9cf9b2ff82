"""The squared length of a quaternion that is turned, from that which is given and the turn alone.

Along the way from true to computed values it is off by what rounding has made of it by then.
"""

from collections.abc import Mapping, Sequence
from functools import reduce
from operator import add

import numpy as np

from derive.verify.operators import Column
from derive.verify.proved.forms import Affine, plain_form, product, widened_form
from derive.verify.proved.meant import exactly, formed
from derive.verify.proved.multiples import UNIT_QUATERNION
from derive.verify.proved.ranges import Interval, greatest, outward, times
from derive.verify.proved.sphere import UNIT
from derive.verify.proved.traits import Traits

UPWARDS = 1 + 2.0**-40
"""More than rounding takes from a sum of errors."""


def squared_length(
    of: Traits,
    index: int,
    ranges: Sequence[Interval],
    forms: Mapping[int, Affine],
    own: Sequence[Column | None],
) -> tuple[Interval, Affine, Column]:
    """Return the range and form of |q|^2 |p|^2, and how far rounding moves it on its way."""
    names, places = of.multiples[index]
    one = dict(zip(names, UNIT_QUATERNION, strict=True))
    at, symbols = dict[int, tuple[Interval, Affine]](), len(next(iter(forms.values())).parts)
    for n in places:
        step = of.trace.steps[n]
        if step.operator == "given":
            whole = (np.full_like(ranges[0][0], float(one[step.name])),) * 2
            at[n] = whole, plain_form(whole, symbols)
            continue
        operands = [at.get(o) or (ranges[o], forms[o]) for o in step.operands]
        each, own_forms = [a for a, _ in operands], [f for _, f in operands]
        exact = exactly(of, n, step, each)
        form = formed(of, n, step, each, own_forms, exact)
        at[n] = tightened(exact, form), form
    value, form = at[places[-1]]
    unit = (np.full_like(value[0], UNIT[0]), np.full_like(value[0], UNIT[1]))
    off = _off(of, places, ranges, own)
    low, high = times(value, unit)
    made = widened_form(product(form, plain_form(unit, len(form.parts))), off)
    return outward(low - off, high + off), made, off


def _off(
    of: Traits,
    places: Sequence[int],
    ranges: Sequence[Interval],
    own: Sequence[Column | None],
) -> Column:
    """Return how far the last place of a cone is moved by the rounding of those before."""
    errors = dict[int, Column]()
    nothing = np.zeros_like(ranges[0][0])
    for n in places:
        step = of.trace.steps[n]
        came = [errors.get(o, nothing) for o in step.operands]
        if step.operator == "mul":
            first, second = (greatest(ranges[o]) for o in step.operands)
            error = first * came[1] + second * came[0] + came[0] * came[1]
        else:
            error = reduce(add, came, nothing)
        rounding = own[n] if n < len(own) else None
        errors[n] = (error if rounding is None else error + rounding) * UPWARDS
    return errors[places[-1]]


def tightened(exact: Interval, form: Affine) -> Interval:
    """Return what of a range a form leaves."""
    ends = form.ends
    low, high = np.fmax(exact[0], ends[0]), np.fmin(exact[1], ends[1])
    holds = low <= high
    return np.where(holds, low, exact[0]), np.where(holds, high, exact[1])


def of_no_larger_square(a: Interval, square: Column) -> Interval:
    """Return what of a range has no larger square."""
    end = np.sqrt(square) * UPWARDS
    return np.maximum(a[0], -end), np.minimum(a[1], end)
