"""How far rounding moves results: each value's own rounding times how much a result follows it.

With every value on its way from the true to the computed one, the way of a result is the sum of
what its values' roundings add, by slopes that ranges of these values enclose: nothing is left out.
"""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from derive.verify.operators import Column
from derive.verify.proved.enclosed import Enclosed
from derive.verify.proved.lengths import UPWARDS
from derive.verify.proved.meant import decided
from derive.verify.proved.ranges import Interval, greatest, inverse, negated, sum_of, times, wave
from derive.verify.proved.unfolded import Operation


def shifts(of: Enclosed, results: Sequence[int]) -> Column:
    """Return how far rounding moves some results at most: a row a result, a column a box."""
    trace, count = of.traits.trace, len(of.blamed)
    rows = len(results)
    total = np.zeros((rows, count))
    slopes: dict[int, Interval] = {}
    for row, place in enumerate(trace.results[r] for r in results):
        own = np.zeros((rows, count))
        own[row] = 1.0
        slopes[place] = (own, own) if place not in slopes else _both(slopes[place], own)
    with np.errstate(all="ignore"):
        for index in range(len(trace.steps) - 1, -1, -1):
            if index not in slopes:
                continue
            slope, step = slopes.pop(index), trace.steps[index]
            own_ = of.own[index]
            if own_ is not None:
                total += np.fmax(greatest(slope) * own_, 0.0)  # nothing times anything is nothing
            if step.origin == "working":
                _passed_on(of, index, step, slope, slopes)
    total = np.where(np.isnan(total), np.inf, total * UPWARDS)
    return np.where(of.void, 0.0, np.where(of.blamed >= 0, np.inf, total))


def _both(slope: Interval, own: Column) -> Interval:
    return slope[0] + own, slope[1] + own


def _passed_on(
    of: Enclosed, index: int, step: Operation, slope: Interval, slopes: dict[int, Interval]
) -> None:
    """Add what a value passes on of its slope to what it is made of."""
    kind = of.traits.kinds[index]
    each = [of.ranges[o] for o in step.operands]
    rule = SLOPES.get(kind or step.operator)
    if rule is None:
        return  # truths, powers of two and numbers follow nothing
    for operand, part in zip(step.operands, rule(slope, of.ranges[index], each), strict=True):
        if part is not None and _follows(of, operand):
            slopes[operand] = part if operand not in slopes else sum_of(slopes[operand], part)


def _follows(of: Enclosed, place: int) -> bool:
    """Tell whether a value is rounded or made of one that is."""
    step = of.traits.trace.steps[place]
    return not of.traits.exact[place] and (bool(step.operands) or of.own[place] is not None)


def _flat(a: Interval) -> Interval:
    return a[0][None, :], a[1][None, :]


def _product(slope: Interval, _: Interval, each: Sequence[Interval]) -> list[Interval | None]:
    return [times(slope, _flat(each[1])), times(slope, _flat(each[0]))]


def _quotient(slope: Interval, _: Interval, each: Sequence[Interval]) -> list[Interval | None]:
    over = inverse(each[1])
    first = times(slope, _flat(over))
    return [first, negated(times(slope, _flat(times(times(each[0], over), over))))]


def _root(slope: Interval, value: Interval, _: Sequence[Interval]) -> list[Interval | None]:
    return [times(slope, _flat(inverse((2 * value[0], 2 * value[1]))))]


def _chosen(slope: Interval, _: Interval, each: Sequence[Interval]) -> list[Interval | None]:
    sure, never = decided("select", each)
    return [None, _where(slope, sure, never), _where(slope, never, sure)]


def _where(slope: Interval, sure: Column, never: Column) -> Interval:
    """Return a slope where a way is taken, nothing where it is not, either where it may be."""
    low = np.where(sure, slope[0], np.where(never, 0.0, np.minimum(slope[0], 0.0)))
    return low, np.where(sure, slope[1], np.where(never, 0.0, np.maximum(slope[1], 0.0)))


def _extreme(kind: str) -> Callable[..., list[Interval | None]]:
    def rule(slope: Interval, _: Interval, each: Sequence[Interval]) -> list[Interval | None]:
        sure, never = decided(kind, each)
        return [None, _where(slope, sure, never), _where(slope, never, sure)]

    return rule


def _bent(slope: Interval, operand: Interval) -> Interval:
    """Return the slope of what an absolute value is taken of."""
    low = np.where(operand[0] >= 0, 1.0, -1.0)
    return times(slope, _flat((low, np.where(operand[1] <= 0, -1.0, 1.0))))


SLOPES: Mapping[str, Callable[[Interval, Interval, Sequence[Interval]], list[Interval | None]]] = {
    "add": lambda slope, _, __: [slope, slope],
    "sub": lambda slope, _, __: [slope, negated(slope)],
    "mul": _product,
    "div": _quotient,
    "neg": lambda slope, _, __: [negated(slope)],
    "sqrt": _root,
    "sin": lambda slope, _, each: [times(slope, _flat(wave(each[0], 1)))],
    "cos": lambda slope, _, each: [negated(times(slope, _flat(wave(each[0], 0))))],
    "select": _chosen,
    "least": _extreme("least"),
    "most": _extreme("most"),
    "abs": lambda slope, _, each: [None] * (len(each) - 1) + [_bent(slope, each[-1])],
}
