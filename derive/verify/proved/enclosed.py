"""All values of a function over boxes of its inputs and parameters, and how far each is rounded.

Set-up's values have a range and an error, both rounded outwards: its pairs err so little that
errors add up plainly. A value in floats is taken along the way from the true one to the one that
is computed: its range holds them and what is between, and beside it stands its own rounding.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from derive.program.arithmetic import rounded
from derive.program.own_sine import FITTED
from derive.verify.operators import Column
from derive.verify.proved.forms import Affine, fitted_form, plain_form, widened_form
from derive.verify.proved.lengths import UPWARDS, of_no_larger_square, squared_length, tightened
from derive.verify.proved.meant import exactly, formed
from derive.verify.proved.multiples import squares_in
from derive.verify.proved.ranges import (
    Interval,
    column,
    greatest,
    half_unit,
    magnitude,
    outward,
    unit,
)
from derive.verify.proved.sphere import forms_of_sides
from derive.verify.proved.traits import COMPARED, Traits, choice_name
from derive.verify.proved.unfolded import Operation

PAIR_ERROR = {"add": 4.0, "sub": 4.0, "mul": 8.0, "div": 16.0, "sqrt": 16.0}
"""In u^2, of + - * (Joldes, Muller and Popescu 2017: 3, 3, 7), and of long division and the root,
whose digits are each as exact as these."""
PAIR_WAVE = 64.0
"""In u^2 absolute, and as much of the angle relative to it: sines of pairs."""
BROAD = (0.9, 1.1)
"""Of the squared length of a quaternion that a program divides by."""
OWN_WAVE = {24: 0.79, 53: 0.77}
"""In units in the last place: sines and cosines of our own (``program.own_sine``)."""
SIZEABLE = {24: 2.0**-100, 53: 2.0**-960}
"""What underflow may leave of an operation on pairs, more than of all floats that it is made of."""


@dataclass
class Enclosed:
    """The values of all places over columns of boxes.

    ranges : of each place, and its form while it is needed      errors : of set-up's values
    own    : how far a place's own rounding moves it
    blamed : the first place that has no bound in a box, -1 for none
    void   : the boxes that hold nothing
    """

    traits: Traits
    ranges: list[Interval]
    forms: dict[int, Affine]
    errors: list[Column]
    own: list[Column | None]
    blamed: Column
    void: Column


def enclosed(of: Traits, boxes: Mapping[str, Interval], count: int) -> Enclosed:
    """Return the values of all places over boxes, the ranges of what is given by name."""
    found = Enclosed(of, [], {}, [], [], np.full(count, -1), np.zeros(count, bool))
    own_boxes = {s.name: boxes[s.name] for s in of.trace.steps if s.name}
    known = forms_of_sides(own_boxes, of.quaternions, of.shell)
    symbols = next((len(form.parts) for form in known.values()), 0)
    for index, step in enumerate(of.trace.steps):
        if step.operands:
            value, form, error, own = _made(found, index, step)
        else:
            value, error, own = given(of, step, boxes, count)
            form = widened_form(known.get(step.name) or plain_form(value, symbols), own)
        if choice_name(index) in boxes:
            value = _decided(found, value, boxes[choice_name(index)])
        found.ranges.append(value)
        found.forms[index] = form
        found.errors.append(error)
        found.own.append(own)
        _blame(found, index, step)
        for place in of.spent[index]:
            del found.forms[place]
    return found


def _decided(found: Enclosed, value: Interval, by: Interval) -> Interval:
    """Return a truth as a box decides it; one that decides against what is so holds nothing."""
    low, high = np.where(by[0] > 0, 1.0, value[0]), np.where(by[1] < 1, 0.0, value[1])
    found.void = found.void | (low > high) | (low > value[1]) | (high < value[0])
    return np.minimum(low, high), high


At = tuple[Interval, Column, Column | None]


def _blame(found: Enclosed, index: int, step: Operation) -> None:
    """Remember where a value has no bound, or is beyond what floats, or their pairs, hold."""
    largest = float(np.finfo(found.traits.precision.dtype).max)
    if step.origin == "pairs":
        largest /= 2.0 ** (found.traits.precision.bits // 2 + 2)
    own = found.own[index]
    held = greatest(found.ranges[index]) <= largest
    if step.origin == "pairs":
        held &= found.errors[index] < np.inf
    if own is not None:
        held &= own < np.inf
    if not held.all():
        found.blamed = np.where((found.blamed < 0) & ~held, index, found.blamed)


def given(of: Traits, step: Operation, boxes: Mapping[str, Interval], count: int) -> At:
    """Return the range of a number or of what is given, its error in pairs, its own in floats."""
    nothing = np.zeros(count)
    if step.operator == "given":
        if step.name not in of.carried:
            return boxes[step.name], nothing, None
        carried, most = of.carried[step.name], greatest(boxes[step.name])
        own = carried + half_unit((most + carried) * UPWARDS, of.precision.bits, _least(of))
        return _widened(boxes[step.name], own), nothing, own
    q = step.number or Fraction(0)
    held = Fraction(float(rounded(q, of.precision.dtype)))
    if step.origin == "pairs":
        value = outward(*column(float(q), count))
        return (
            (value if held != q else column(float(q), count)),
            greatest(value) * _u(of) ** 2,
            None,
        )
    low, high = sorted((held, q))
    value = (np.full(count, float(held)),) * 2
    if held == q:
        return value, nothing, None
    gap = float(high - low) * UPWARDS
    return (value[0] - gap, value[1] + gap), nothing, np.full(count, gap)


def _least(of: Traits) -> float:
    return float(np.finfo(of.precision.dtype).smallest_subnormal)


def _u(of: Traits) -> float:
    return of.precision.unit_roundoff


def _made(
    found: Enclosed, index: int, step: Operation
) -> tuple[Interval, Affine, Column, Column | None]:
    """Return the range and form of an operation's value, its error in pairs, its own in floats."""
    of = found.traits
    each, forms = [found.ranges[o] for o in step.operands], [found.forms[o] for o in step.operands]
    exact = exactly(of, index, step, each)
    if step.operator in (*COMPARED, "both", "either"):
        return exact, plain_form(exact, len(forms[0].parts)), np.zeros(len(found.blamed)), None
    form = formed(of, index, step, each, forms, exact)
    if index in of.multiples:
        value, form, off = squared_length(of, index, found.ranges, found.forms, found.own)
        exact = np.maximum(exact[0], value[0]), np.minimum(exact[1], value[1])
        for n in squares_in(of.trace.steps, index):
            found.ranges[n] = of_no_larger_square(found.ranges[n], exact[1] + off)
    elif index in of.lengths:
        ends = of.shell if of.carried else BROAD
        exact = np.clip(exact[0], *ends), np.clip(exact[1], *ends)
    exact = tightened(exact, form)
    error, own = _errors(found, index, step, exact)
    return _widened(exact, own), widened_form(fitted_form(form, exact), own), error, own


def _errors(
    found: Enclosed, index: int, step: Operation, exact: Interval
) -> tuple[Column, Column | None]:
    """Return the error of a value in pairs, and of one in floats how far it is rounded."""
    of, nothing = found.traits, np.zeros(len(found.blamed))
    each = [found.ranges[o] for o in step.operands]
    if step.origin == "rounded":
        if of.exact[index]:
            return nothing, None
        (error,) = (found.errors[o] for o in step.operands)
        most = (greatest(exact) + error) * UPWARDS
        return nothing, error + half_unit(most, of.precision.bits, _least(of))
    if step.operator == "select" and _may_turn(of, index, step):
        torn = each[0][0] != each[0][1]
        if step.origin == "pairs":
            jump = np.where(torn, greatest(exact) * 2, 0.0)
            return np.maximum(*(found.errors[o] for o in step.operands[1:])) + jump, None
        return nothing, np.where(torn, np.inf, 0.0)
    if step.origin == "pairs":
        return _pair_error(of, step, found, exact), None
    return nothing, _rounding(of, step, exact, each)


def _may_turn(of: Traits, index: int, step: Operation) -> bool:
    """Tell whether a choice may be another for rounded values than for true ones."""
    return not of.kinds[index] and not of.exact[step.operands[0]]


def _widened(a: Interval, by: Column | None) -> Interval:
    return a if by is None else outward(a[0] - by, a[1] + by)


def _rounding(
    of: Traits, step: Operation, exactly: Interval, each: Sequence[Interval]
) -> Column | None:
    """Return how far an operation in floats rounds at most, None if not at all."""
    steps, bits, least = of.trace.steps, of.precision.bits, _least(of)
    if step.operator in ("neg", "abs", "select", "power_of_two"):
        return None
    if step.operator == "add" and step.operands[0] == step.operands[1]:
        return None
    numbers = [steps[o].number for o in step.operands]
    if step.operator == "mul" and any(q is not None and _shifts(q) for q in numbers):
        return np.full_like(exactly[0], least)
    most = greatest(exactly)
    if step.operator not in ("sin", "cos"):
        return half_unit(most, bits, least)
    far = ~(greatest(each[0]) <= FITTED[bits].largest)
    return np.where(far, np.inf, unit(most, bits) * OWN_WAVE[bits] + least)


def _shifts(q: Fraction) -> bool:
    """Tell whether a number is a power of two, whose products are exact but for underflow."""
    top, bottom = abs(q.numerator), q.denominator
    return top & (top - 1) == 0 and bottom & (bottom - 1) == 0


def _pair_error(of: Traits, step: Operation, found: Enclosed, exactly: Interval) -> Column:
    """Return the error of an operation on pairs, of its operands and its own."""
    errors = [found.errors[o] for o in step.operands]
    least = np.ones(1)
    ranges = [found.ranges[o] for o in step.operands]
    square_of_u = _u(of) ** 2
    match step.operator:
        case "add" | "sub":
            came = errors[0] + errors[1]
        case "mul":
            first, second = map(greatest, ranges)
            came = first * errors[1] + second * errors[0] + errors[0] * errors[1]
        case "div":
            least = magnitude(ranges[1])[0] - errors[1]
            least = np.where(least > 0, least, 0.0)
            came = (errors[0] + greatest(exactly) * errors[1]) / least
        case "sqrt":
            least = np.sqrt(np.maximum(ranges[0][0] - errors[0], 0.0))
            came = errors[0] / least
        case "sin" | "cos":
            own = PAIR_WAVE * square_of_u * (1 + greatest(ranges[0]))
            return (errors[0] + own) * UPWARDS
        case "neg" | "abs":
            return errors[0]
        case "select":
            return np.maximum(errors[1], errors[2])
        case "power_of_two":
            return errors[0] * 0
        case _:
            return errors[0] + np.inf
    lost = SIZEABLE[of.precision.bits] / np.minimum(least, 1.0)
    own = PAIR_ERROR[step.operator] * square_of_u * (greatest(exactly) + came)
    return np.asarray((came + own + lost) * UPWARDS)
