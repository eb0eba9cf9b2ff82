"""What operations mean of ranges, and of linear forms, without rounding."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from derive.verify.operators import Column
from derive.verify.proved.forms import (
    Affine,
    chosen_form,
    difference_of_forms,
    opposite,
    plain_form,
    product,
    quotient_form,
    root_form,
    square_form,
    sum_of_forms,
    wave_form,
)
from derive.verify.proved.ranges import (
    Interval,
    hull,
    inverse,
    magnitude,
    negated,
    one_power,
    powers_of_two,
    root_of,
    squared,
    sum_of,
    times,
    wave,
)
from derive.verify.proved.traits import Traits
from derive.verify.proved.unfolded import Operation


def _less(a: Interval, b: Interval) -> Interval:
    return np.where(a[1] < b[0], 1.0, 0.0), np.where(a[0] >= b[1], 0.0, 1.0)


def _at_most(a: Interval, b: Interval) -> Interval:
    return np.where(a[1] <= b[0], 1.0, 0.0), np.where(a[0] > b[1], 0.0, 1.0)


def _select(condition: Interval, yes: Interval, no: Interval) -> Interval:
    both = hull(yes, no)
    sure, never = decided("select", (condition, yes, no))
    return (
        np.where(sure, yes[0], np.where(never, no[0], both[0])),
        np.where(sure, yes[1], np.where(never, no[1], both[1])),
    )


def _ends(which: Callable[[Column, Column], Column]) -> Callable[[Interval, Interval], Interval]:
    return lambda a, b: (which(a[0], b[0]), which(a[1], b[1]))


def _unbounded(*given: Interval) -> Interval:
    return np.full_like(given[0][0], -np.inf), np.full_like(given[0][0], np.inf)


MEANT: Mapping[str, Callable[..., Interval]] = {
    "add": sum_of,
    "sub": lambda a, b: sum_of(a, negated(b)),
    "mul": times,
    "div": lambda a, b: times(a, inverse(b)),
    "neg": negated,
    "sqrt": root_of,
    "abs": magnitude,
    "sin": lambda a: wave(a, 0),
    "cos": lambda a: wave(a, 1),
    "power_of_two": powers_of_two,
    "less": _less,
    "at_most": _at_most,
    "both": _ends(np.minimum),
    "either": _ends(np.maximum),
    "select": _select,
    "rounded": lambda a: a,
    "least": _ends(np.minimum),
    "most": _ends(np.maximum),
}


def exactly(of: Traits, index: int, step: Operation, each: Sequence[Interval]) -> Interval:
    """Return the range of an operation without rounding."""
    if step.operator == "mul" and step.operands[0] == step.operands[1]:
        return squared(each[0])
    if step.operator == "power_of_two" and of.any_power:
        return one_power(each[0])
    kind = of.kinds[index]
    if kind in ("least", "most"):
        return MEANT[kind](each[1], each[2])
    if kind == "abs":
        return magnitude(each[2])
    return MEANT.get(step.operator, _unbounded)(*each)


def formed(
    of: Traits,
    index: int,
    step: Operation,
    each: Sequence[Interval],
    forms: Sequence[Affine],
    exact: Interval,
) -> Affine:
    """Return an operation's form without rounding, its operands' and its own range known."""
    if step.operator == "mul" and step.operands[0] == step.operands[1]:
        return square_form(forms[0])
    kind = of.kinds[index] or step.operator
    if kind in FORMED:
        return FORMED[kind](forms, each)
    whole = plain_form(exact, len(forms[0].parts))
    if kind == "abs":
        low, high = each[-1]
        way = chosen_form(opposite(forms[-1]), whole, high <= 0)
        return chosen_form(forms[-1], way, low >= 0)
    if kind not in ("select", "least", "most"):
        return whole
    sure, never = decided(kind, each)
    return chosen_form(forms[1], chosen_form(forms[2], whole, never), sure)


def decided(kind: str, each: Sequence[Interval]) -> tuple[Column, Column]:
    """Return in which boxes a choice surely takes its first value, and in which its second."""
    if kind == "select":
        return each[0][0] > 0, each[0][1] < 1
    below, above = each[1][1] < each[2][0], each[1][0] > each[2][1]
    return (below, above) if kind == "least" else (above, below)


FORMED: Mapping[str, Callable[[Sequence[Affine], Sequence[Interval]], Affine]] = {
    "add": lambda a, _: sum_of_forms(a[0], a[1]),
    "sub": lambda a, _: difference_of_forms(a[0], a[1]),
    "mul": lambda a, _: product(a[0], a[1]),
    "div": lambda a, each: quotient_form(a[0], a[1], each[1]),
    "neg": lambda a, _: opposite(a[0]),
    "sqrt": lambda a, each: root_form(a[0], each[0]),
    "sin": lambda a, each: wave_form(a[0], each[0], 0),
    "cos": lambda a, each: wave_form(a[0], each[0], 1),
    "rounded": lambda a, _: a[0],
}
