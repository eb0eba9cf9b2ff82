"""How far results are seen to be off: samples of the ranges and of the worst parts of a bound.

Figures are absolute, as proved bounds are, so that the two can be held against each other. From
the worst samples the search goes on to others beside them, nearer and nearer.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from operator import add

import numpy as np

from derive.program.program import Program
from derive.verify.columns import Plan, arithmetics, found_and_true
from derive.verify.draw import Dice, Sampled, admitted, complete, drawn, on_the_sphere
from derive.verify.operators import Column
from derive.verify.scale import measured_outputs


@dataclass(frozen=True)
class Search:
    """How widely a search goes: samples to begin with, then rounds of more from the worst.

    finest : halvings of the ranges that steps come down to     operations : of a round, at most
    """

    samples: int = 4096
    rounds: int = 80
    batch: int = 4096
    kept: int = 6
    finest: int = 24
    operations: int = 600_000

    def of(self, program: Program) -> "Search":
        """Return a search of as many samples a round as so many operations take, or 128."""
        few = max(128, self.operations // reduce(add, program.count.values(), 1))
        return replace(self, samples=min(self.samples, 4 * few), batch=min(self.batch, few))


SEARCH = Search()


def gaps(of: Sampled, plan: Plan, rows: Column) -> Column:
    """Return how far each measured output is off at samples: the largest of its components."""
    by = arithmetics(of.precision.dtype)
    with np.errstate(all="ignore"):
        pairs = found_and_true(plan, complete(of, rows), by)
        each = np.array([np.abs(by.off(f, t)) for f, t in pairs])
    each = np.where(np.isfinite(each), each, 0.0)
    spans = [span for _, span in measured_outputs(plan.program)]
    return np.array([each[span].max(axis=0) for span in spans])


def seen(of: Sampled, plan: Plan, beside: tuple[Sequence[str], Column], by: Search) -> list[float]:
    """Return the largest error that is found of each measured output, absolute.

    beside : points to begin from besides, the names of their components and a column a point
    """
    by, name = by.of(plan.program), plan.program.name
    dice = Dice(f"derive: {of.library.scene.name} {of.precision.name} seen {name}")
    rows = np.concatenate([drawn(of, dice, by.samples), _at(of, dice, beside)], axis=1)
    found = gaps(of, plan, rows)
    best, kept = found.max(axis=1), _worst(rows, found, by.kept)
    for turn in range(by.rounds):
        rows = np.concatenate([kept, _beside(of, dice, kept, by, turn / by.rounds)], axis=1)
        found = gaps(of, plan, rows)
        best, kept = np.maximum(best, found.max(axis=1)), _worst(rows, found, by.kept)
    return [float(x) for x in best]


def _worst(rows: Column, found: Column, kept: int) -> Column:
    """Return the samples at which each output is worst."""
    each = [np.argsort(-row, kind="stable")[:kept] for row in found]
    return rows[:, np.unique(np.concatenate(each))]


def _at(of: Sampled, dice: Dice, beside: tuple[Sequence[str], Column]) -> Column:
    names, points = beside
    start = drawn(of, dice, points.shape[1])
    rows = start.copy()
    for name, row in zip(names, points, strict=True):
        if name in of.names:
            rows[of.names.index(name)] = row
    return _fitting(of, rows, start)


def _fitting(of: Sampled, rows: Column, start: Column) -> Column:
    """Return samples on the ranges, of bodies that can be, else those that they came from."""
    rows = np.clip(rows, of.lows[:, None], of.highs[:, None])
    rows = on_the_sphere(of, rows)
    return np.where(admitted(of, rows), rows, start)


def _beside(of: Sampled, dice: Dice, parents: Column, by: Search, share: float) -> Column:
    """Return samples beside parents, the nearer the more of the search is done."""
    start = parents[:, (dice.uniform(by.batch) * parents.shape[1]).astype(int)]
    fine = 1 + by.finest * share * dice.uniform(by.batch)
    reach = np.ldexp(1.0, -fine.astype(int))
    many = dice.uniform(by.batch)
    changed = dice.uniform(*start.shape) < np.maximum(many * many, 1.5 / len(of.names))
    across = (of.highs - of.lows)[:, None] * reach
    steps = np.where(changed, (2 * dice.uniform(*start.shape) - 1) * across, 0.0)
    return _fitting(of, start + steps, start)
