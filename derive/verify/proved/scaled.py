"""What functions divide by once values are scaled by the largest of them: ranges for any scale.

A scale is a power of two. Twice such values have the same results, exactly, as long as all that is
done to what grows with them is exact, or a quotient of two that grow alike: it is compared, chosen,
multiplied by powers of two above one. So values whose largest is between 1 and 2 stand for all of
any size but nothing at all, which is looked at too.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

import numpy as np

from derive.program.precision import Precision
from derive.verify.proved.enclosed import Enclosed, enclosed
from derive.verify.proved.traits import COMPARED, traits
from derive.verify.proved.unfolded import Operation, pruned

SAME = ("abs", "neg", "power_of_two", "select", *COMPARED)
"""What gives, exactly, of values that grow alike one that does so too, or a truth that stays."""
ANY = -1
"""How nothing grows: as anything else does."""
Boxes = Mapping[str, tuple[float, float]]


@dataclass(frozen=True)
class Scaled:
    """A function whose values are scaled by the largest of some that are given, by their names."""

    steps: Sequence[Operation]
    boxes: Boxes
    names: tuple[str, ...]
    precision: Precision

    def ends(self, place: int) -> tuple[float, float] | None:
        """Return between which floats a value is, None if that changes with the scale."""
        found = list[tuple[float, float]]()
        found.append(over(self._of_nothing(), place, self._nothing(), self.precision))
        for boxes in self._cases():
            value = _over(self.steps, place, boxes, self.precision)
            at = value.traits.trace.results[0]
            if self._growth(value)[at] not in (0, ANY):
                return None
            found.append(ends_of(value, at))
        low, high = min(a for a, _ in found), max(b for _, b in found)
        return (low, high) if np.isfinite([low, high]).all() else None

    def _nothing(self) -> Boxes:
        return {**self.boxes, **dict.fromkeys(self.names, (0.0, 0.0))}

    def _of_nothing(self) -> Sequence[Operation]:
        """Return the function of no size at all: a power of two of nothing is nothing."""
        own = list(self.steps)
        for n in sorted(_powers(own)):
            if over(own, own[n].operands[0], self._nothing(), self.precision) == (0, 0):
                own[n] = Operation("number", (), "working", number=Fraction(0))
        return own

    def _cases(self) -> Iterator[Boxes]:
        """Yield what stands for values of any size but none: each in turn as the largest."""
        around = dict.fromkeys(self.names, (-2.0, 2.0))
        for name, ends in product(self.names, ((1.0, 2.0), (-2.0, -1.0))):
            yield {**self.boxes, **around, name: ends}

    def _growth(self, value: Enclosed) -> list[int | None]:
        """Return by which power of the scale each value grows; None of what is not known to."""
        found = list[int | None]()
        for step in value.traits.trace.steps:
            own = [found[o] for o in step.operands]
            if not own:
                found.append(ANY if step.number == 0 else int(step.name in self.names))
                continue
            if step.operator == "select":
                low, high = ends_of(value, step.operands[0])
                own = own[:1] + (own[1:2] if low > 0 else own[2:] if high < 1 else own[1:])
                if own[0] not in (0, ANY):
                    own = [None]
                own = own[1:] or own
            found.append(_grown(value, step, own))
        return found


def scaling(
    steps: Sequence[Operation], place: int, boxes: Boxes, precision: Precision
) -> list[Scaled]:
    """Return what a divisor is scaled by, nothing if that is no power of two of what is given.

    Comparisons that ranges decide are truths.
    """
    powers = sorted(_powers(steps) & needed(steps, place))
    if not powers:
        return []
    own = list(steps)
    for n in needed(steps, powers[0]):
        if steps[n].operator in COMPARED:
            low, high = over(steps, n, boxes, precision)
            if low == high:
                own[n] = Operation("number", (), "working", number=Fraction(low))
    names = tuple(own[n].name for n in sorted(needed(own, powers[0])) if own[n].name)
    every = [boxes[n] for n in names]
    return [Scaled(own, boxes, names, precision)] if all(a <= 0 <= b for a, b in every) else []


def _powers(steps: Sequence[Operation]) -> set[int]:
    """Return where a function takes powers of two in floats."""
    each = enumerate(steps)
    return {n for n, s in each if s.operator == "power_of_two" and s.origin == "working"}


def needed(steps: Sequence[Operation], place: int) -> set[int]:
    """Return what a value rests on, itself among it."""
    found = {place}
    for n in range(place, -1, -1):
        if n in found:
            found.update(steps[n].operands)
    return found


def ends_of(value: Enclosed, place: int) -> tuple[float, float]:
    """Return the range of a value over one box."""
    low, high = value.ranges[place]
    return float(low[0]), float(high[0])


def over(
    steps: Sequence[Operation], place: int, boxes: Boxes, precision: Precision
) -> tuple[float, float]:
    """Return the range of a value over a box."""
    found = _over(steps, place, boxes, precision)
    return ends_of(found, found.traits.trace.results[0])


def _over(steps: Sequence[Operation], place: int, boxes: Boxes, precision: Precision) -> Enclosed:
    """Return all that a value rests on over one box."""
    each = {n: (np.array([a]), np.array([b])) for n, (a, b) in boxes.items()}
    with np.errstate(all="ignore"):
        return enclosed(traits(pruned(steps, [place]), precision), each, 1)


def _grown(value: Enclosed, step: Operation, own: Sequence[int | None]) -> int | None:
    """Return by which power of the scale a result grows, those of its operands known."""
    if None in own:
        return None
    alike = {n for n in own if n != ANY}
    if step.operator in SAME and len(alike) <= 1:
        growth = next(iter(alike), ANY)
        return 0 if step.operator in COMPARED else growth
    if not alike - {0}:
        return 0
    if step.operator == "div" and len(alike) == 1 and len(own) == 2 and ANY not in own:
        return 0
    if step.operator == "mul" and 0 in own:
        by = value.traits.trace.steps[step.operands[own.index(0)]].number
        if by and abs(by) >= 1 and by.denominator == 1 and by.numerator & (by.numerator - 1) == 0:
            return max(n for n in own if n is not None)
    return None
