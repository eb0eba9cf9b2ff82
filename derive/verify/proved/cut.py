"""A bound over a whole box: cut into parts, the part with the largest bound first.

Nothing is left out when it ends early: a bound of all is the largest of its parts, cut or not.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np

from derive.verify.draw import Dice
from derive.verify.operators import Column
from derive.verify.proved.cells import Cells, bound_of_each, cut_along, every_cell, in_two
from derive.verify.proved.enclosed import Enclosed, enclosed
from derive.verify.proved.ranges import Interval
from derive.verify.proved.slopes import shifts
from derive.verify.proved.sphere import near_the_sphere, of_about_unit_length
from derive.verify.proved.traits import Traits

TIGHT = 1.1
"""A bound is no more than this of one at a point: nothing is left to cut for."""
FINEST = 4
TRIED_AT = 512
"""Points that a climb to the largest bound begins with, and takes in each of its turns."""
CLIMBS, KEPT = 12, 48
ENDS = 0.5
"""Of all moves go to an end of a range: bounds are largest there."""
START = 0.1
"""Of the work may be spent on cutting quaternions evenly, before the worst parts are cut."""
HOPE = 1 / 16
"""Of the work is spent until half of a box must have a bound, or no more is cut."""
MOSTLY = 0.51
"""Of a box is more than its half, whatever rounds."""
SPECK = 2.0**-60
"""Of a box is a part that is not cut any more for having no bound."""
PIECES = 8
"""Into so many a side is cut to see what cutting it takes from a bound."""
MOST = 32768
"""Cells that a box is cut into at most."""
BATCH = 256
AT_ONCE = 3
"""Times that parts are halved before they are valued, if they are few: that takes hardly longer."""
FULL = 1 << 15
"""Numbers that a table of slopes, results by boxes, has at most."""


@dataclass(frozen=True)
class Region:
    """What is given to a function: names, ends, and where quaternions stand among them."""

    names: tuple[str, ...]
    lows: Column
    highs: Column
    quaternions: tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class Peaks:
    """Points at which the bound is largest, a column each: of what is named, and how large."""

    names: tuple[str, ...]
    points: Column
    most: float


@dataclass
class Cutting:
    """The bound of an output in the making: the largest of its components', over all parts.

    work    : counted in operations over one box, for one result
    highest : points at which the bound in another precision is largest, and so is this one
    """

    traits: Traits
    box: Region
    work: int
    dice: Dice
    spent: int = 0
    highest: Column | None = None

    def valued(self, lows: Column, highs: Column) -> Cells:
        """Return parts with their bounds, those that hold nothing left out."""
        lows, highs = near_the_sphere(self.box.quaternions, lows, highs, self.traits.shell)
        rows = len(self.traits.trace.results)
        each = [self._valued(*ends) for ends in self.batches(lows, highs)]
        none = Cells(lows[:, :0], highs[:, :0], np.zeros((rows, 0)), np.zeros(0, int))
        return every_cell([none, *each])

    def again(self, parts: Cells) -> Cells:
        """Return parts of another precision with their bounds, or those alone that have none."""
        lacking = parts.of(np.isinf(bound_of_each(parts)))
        found = self.valued(lacking.lows, lacking.highs)
        if np.isinf(bound_of_each(found)).any():
            return found
        return self.valued(parts.lows, parts.highs)

    def batches(self, lows: Column, highs: Column) -> Iterator[tuple[Column, Column]]:
        """Yield parts, as many at once as a table of slopes holds."""
        step = max(1, FULL // len(self.traits.trace.results))
        for n in range(0, lows.shape[1], step):
            yield lows[:, n : n + step], highs[:, n : n + step]

    def ranges(self, lows: Column, highs: Column) -> dict[str, Interval]:
        """Return the ranges of what is given in parts, by name."""
        return {n: (lows[k], highs[k]) for k, n in enumerate(self.box.names)}

    def _valued(self, lows: Column, highs: Column) -> Cells:
        count = lows.shape[1]
        self._count(count)
        with np.errstate(all="ignore"):
            found = enclosed(self.traits, self.ranges(lows, highs), count)
            every = Cells(lows, highs, shifts(found, self.rows), found.blamed)
        return every.of(~found.void) if found.void.any() else every

    def scores(self, parts: Cells) -> Column:
        """Return how much the bound of each part is above what is certain at points.

        As long as some are without a bound, these alone count.
        """
        over = bound_of_each(parts)
        lacking = np.isinf(over)
        if lacking.any():
            return np.where(lacking, np.inf, 0.0)
        return over / max(self.peaks.most, 1e-280)

    def run(self) -> Cells:
        """Return parts that make up the box, cut while that makes the bound smaller."""
        parts = self.valued(*self._started())
        while self.spent < self.work and 0 < parts.shifts.shape[1] < MOST:
            if self._is_in_vain(parts):
                break
            scores = self.scores(parts)
            if scores.max() <= TIGHT:
                break
            order = np.argsort(-scores, kind="stable")
            first = order[:BATCH]
            first = first[scores[first] > TIGHT]
            rest = parts.of(order[len(first) :])
            halves = self._halved(parts.of(first))
            parts = every_cell([rest, halves])
        return parts

    def _is_in_vain(self, parts: Cells) -> bool:
        """Tell whether after some work most of a box, or what is next to a point, has no bound."""
        if self.spent <= HOPE * self.work:
            return False
        sides, lacking = parts.highs - parts.lows, np.isinf(bound_of_each(parts))
        sizes = reduce(np.multiply, np.where(sides > 0, sides, 1.0))
        without, whole = sizes[lacking], sizes.sum()
        return bool(without.sum() > whole * MOSTLY or without.min(initial=whole) < whole * SPECK)

    @cached_property
    def peaks(self) -> Peaks:
        """Return points with the largest bounds that a climb finds: none of all can be below."""
        if self.highest is not None:
            most = self._certain(self.highest)
            return Peaks(self.box.names, self.highest, float(most.max(initial=0.0)))
        count = max(16, min(TRIED_AT, self.work // (CLIMBS * 4 * self.price)))
        points = np.repeat(self.box.lows[:, None], count, axis=1)
        points = self._moved(points, np.ones_like(points))
        most = self._certain(points)
        for turn in range(CLIMBS):
            points, most = _first(points, most)
            start = points[:, np.resize(np.arange(points.shape[1]), count)]
            other = self._moved(start, np.full_like(start, 2.0 ** -(turn / 2)))
            points = np.concatenate([points, other], axis=1)
            most = np.concatenate([most, self._certain(other)])
        points, most = _first(points, most)
        return Peaks(self.box.names, points, float(most.max(initial=0.0)))

    def _moved(self, start: Column, share: Column) -> Column:
        """Return points with some components at ends of their ranges, some moved by a share."""
        d, count = start.shape
        to, ends = self.dice.uniform(d, count), self.dice.uniform(d, count) < ENDS
        to = self.box.lows[:, None] + (self.box.highs - self.box.lows)[:, None] * np.where(
            ends, np.round(to), to
        )
        some = np.maximum(self.dice.uniform(count) / 2, 1.5 / max(d, 1))
        some = np.where(share < 1, some, 1.0)
        changed = self.dice.uniform(d, count) < some
        by = np.where(ends, 1.0, share) * changed
        return self._at(start + (to - start) * by)

    def _at(self, points: Column) -> Column:
        """Return points of the box with quaternions of about unit length."""
        points = np.clip(points, self.box.lows[:, None], self.box.highs[:, None])
        for places in self.box.quaternions:
            points[list(places)] = of_about_unit_length(points[list(places)], self.traits.shell)
        return points

    def _certain(self, points: Column) -> Column:
        """Return the bound at points, where choices are what they are."""
        ends = points.copy(), points.copy()
        ends[0][self._free], ends[1][self._free] = 0.0, 1.0
        self._count(points.shape[1])
        with np.errstate(all="ignore"):
            found = shifts(enclosed(self.traits, self.ranges(*ends), points.shape[1]), self.rows)
        most = found.max(axis=0, initial=0.0)
        return np.where(np.isfinite(most), most, 0.0)

    def _started(self) -> tuple[Column, Column]:
        """Return parts to begin with: by choices, then quaternions, of the sphere alone."""
        ends = self.box.lows[:, None], self.box.highs[:, None]
        for k in np.flatnonzero(self._free).tolist():
            decided = self.valued(*in_two(ends, k))
            ends = decided.lows, decided.highs
        for _ in range(FINEST if self.box.quaternions else 0):
            finer = ends
            for k in (k for places in self.box.quaternions for k in places):
                finer = near_the_sphere(self.box.quaternions, *in_two(finer, k), self.traits.shell)
            if finer[0].shape[1] > min(MOST / 4, START * self.work / self.price):
                break
            ends = finer
        return ends

    def _halved(self, parts: Cells) -> Cells:
        """Return parts cut in two, each where that serves the first of them best; few, again."""
        low, high, gains = parts.lows, parts.highs, self._gains(parts)
        whole = (self.box.highs - self.box.lows)[:, None]
        first = np.maximum(((high - low) / whole)[:, :1], 1e-12)
        for _ in range(AT_ONCE):
            along = np.argmax(gains[:, None] * ((high - low) / whole) / first, axis=0)
            low, high = cut_along(low, high, along)
            if 4 * low.shape[1] > BATCH:
                break
        return self.valued(low, high)

    def _gains(self, parts: Cells) -> Column:
        """Return what cutting each side takes from the bound, or from what keeps it from being."""
        d = len(self.box.names)
        low, high = (np.repeat(x[:, :1], 1 + PIECES * d, axis=1) for x in (parts.lows, parts.highs))
        for k in range(d):
            ends = np.linspace(parts.lows[k, 0], parts.highs[k, 0], PIECES + 1)
            own = slice(1 + PIECES * k, 1 + PIECES * (k + 1))
            low[k, own], high[k, own] = ends[:-1], ends[1:]
        self._count(low.shape[1])
        with np.errstate(all="ignore"):
            found = enclosed(self.traits, self.ranges(low, high), low.shape[1])
            over = bound_of_each(Cells(low, high, shifts(found, self.rows), found.blamed))
        if not np.isfinite(over[0]):
            over = _width(found)
        width = (parts.highs[:, 0] - parts.lows[:, 0]) / (self.box.highs - self.box.lows)
        width[self._free] = 0.0
        with np.errstate(all="ignore"):
            gains = 1 - over[1:].reshape(d, PIECES).mean(axis=1) / over[0]
        gains[self._free] = 0.0
        return np.asarray(np.maximum(np.where(np.isfinite(gains), gains, 0.0), 1e-6 * width))

    @property
    def rows(self) -> range:
        """Return all results."""
        return range(len(self.traits.trace.results))

    @property
    def _free(self) -> Column:
        """Return which sides are choices: once decided, there is nothing to cut them for."""
        return np.array([n.startswith("choice") for n in self.box.names], dtype=bool)

    def _count(self, boxes: int) -> None:
        self.spent += boxes * self.price

    @property
    def price(self) -> int:
        """Return what one box costs, of the work."""
        return len(self.traits.trace.steps) * (4 + len(self.traits.trace.results))


def _first(points: Column, most: Column) -> tuple[Column, Column]:
    """Return the points with the largest bounds."""
    first = np.argsort(-most, kind="stable")[:KEPT]
    return points[:, first], most[first]


def _width(found: Enclosed) -> Column:
    """Return how wide that is which the first part has no bound for."""
    blamed = int(found.blamed[0])
    if blamed < 0:
        return np.ones(len(found.blamed))
    operands = found.traits.trace.steps[blamed].operands
    low, high = found.ranges[operands[-1] if operands else blamed]
    return np.asarray(high - low)
