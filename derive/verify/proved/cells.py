"""Cells of a box, in columns, with their bounds, and how they are cut."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from derive.verify.operators import Column


@dataclass
class Cells:
    """Cells of a box, a column each, and how far rounding moves each result in each."""

    lows: Column
    highs: Column
    shifts: Column
    blamed: Column

    def of(self, which: Column) -> "Cells":
        """Return some of the parts."""
        return Cells(*(x[..., which] for x in (self.lows, self.highs, self.shifts, self.blamed)))


def every_cell(each: Sequence[Cells]) -> Cells:
    """Return all parts together."""
    several = ([getattr(p, n) for p in each] for n in ("lows", "highs", "shifts", "blamed"))
    return Cells(*(np.concatenate(x, axis=-1) for x in several))


def bound_of_each(parts: Cells) -> Column:
    """Return the bound of each part, all results together."""
    over = parts.shifts.max(axis=0, initial=0.0)
    return np.asarray(np.where(np.isnan(over), np.inf, over))


def in_two(ends: tuple[Column, Column], k: int) -> tuple[Column, Column]:
    """Return boxes cut in two along a side."""
    middle = (ends[0][k] + ends[1][k]) / 2
    low, high = (np.concatenate([x, x], axis=1) for x in ends)
    low[k, len(middle) :] = middle
    high[k, : len(middle)] = middle
    return low, high


def cut_along(low: Column, high: Column, along: Column) -> tuple[Column, Column]:
    """Return boxes cut in two, each along a side of its own."""
    at = (along, np.arange(len(along)))
    below, above = high.copy(), low.copy()
    below[at] = above[at] = ((low + high) / 2)[at]
    return np.concatenate([low, above], axis=1), np.concatenate([below, high], axis=1)
