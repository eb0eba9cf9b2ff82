"""Parts of a box in which one value is looked at, and cut where that leaves it least near to zero.

Outcomes of comparisons that choose between values are cut apart too: one that cannot be so in a
part of the ranges is of no number at all.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from derive.verify.operators import Column
from derive.verify.proved.enclosed import enclosed
from derive.verify.proved.ranges import Interval
from derive.verify.proved.traits import COMPARED, Traits

MOST_CHOICES = 4
"""Of a divisor, whose outcomes are cut apart as ranges are."""
AT_ONCE = 1 << 14
NOTHING = np.array([[np.inf], [-np.inf]])
"""The range of what no number is in."""


def choosing(of: Traits) -> list[int]:
    """Return the comparisons by which one of two values is taken, with a jump, the first few."""
    steps = of.trace.steps
    asked = {s.operands[0] for n, s in enumerate(steps) if of.jumps(n)}
    return [n for n in sorted(asked) if steps[n].operator in COMPARED][:MOST_CHOICES]


@dataclass(frozen=True)
class Slivers:
    """Parts of a box, and the range of one value in them."""

    of: Traits
    names: tuple[str, ...]
    whole: tuple[Column, Column]
    quaternions: tuple[tuple[int, ...], ...]

    @property
    def price(self) -> int:
        """Return what a look at one part costs."""
        return len(self.of.trace.steps)

    def ranges(self, low: Column, high: Column) -> Interval:
        """Return the range of the value in parts."""
        each = [np.zeros((2, 0))]
        for n in range(0, low.shape[1], AT_ONCE):
            own = slice(n, n + AT_ONCE)
            boxes = {name: (low[k, own], high[k, own]) for k, name in enumerate(self.names)}
            with np.errstate(all="ignore"):
                found = enclosed(self.of, boxes, low[:, own].shape[1])
            ends = np.array(found.ranges[self.of.trace.results[0]])
            each.append(np.where(found.void, NOTHING, ends))
        least, most = np.concatenate(each, axis=1)
        return least, most

    def halved(self, low: Column, high: Column, away: float) -> tuple[Column, Column]:
        """Return parts cut in two, each where that leaves the least nearer to zero than that."""
        count, middle = low.shape[1], (low + high) / 2
        best, along = np.full(count, np.inf), np.zeros(count, int)
        for k in range(len(self.names)):
            over = np.maximum(
                *(self._beyond(*half, away) for half in _halves(low, high, middle, k))
            )
            over = np.where(low[k] < high[k], over, np.inf)
            along, best = np.where(over < best, k, along), np.minimum(over, best)
        at = along, np.arange(count)
        lower, upper = high.copy(), low.copy()
        lower[at], upper[at] = middle[at], middle[at]
        return np.concatenate([low, upper], axis=1), np.concatenate([lower, high], axis=1)

    def _beyond(self, low: Column, high: Column, away: float) -> Column:
        """Return how far the value may be from all that is on one side, and away from zero."""
        least, most = self.ranges(low, high)
        over = np.minimum(-least, most)
        over = np.where(np.isnan(over), np.inf, over)
        return np.asarray(np.maximum(over + away, 0.0))


def _halves(low: Column, high: Column, middle: Column, k: int) -> Iterator[tuple[Column, Column]]:
    """Yield the lower and the upper halves of parts along a side."""
    lower, upper = high.copy(), low.copy()
    lower[k], upper[k] = middle[k], middle[k]
    yield low, lower
    yield upper, high
