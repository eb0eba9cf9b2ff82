"""How far results are seen to be off: samples of the ranges and of the worst parts of a bound.

Figures are absolute, as proved bounds are, so that the two can be held against each other. From
the worst samples the search goes on to others beside them, nearer and nearer.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from operator import add

import numpy as np

from derive.motion.compensated import REMAINDER
from derive.program.program import Program, placed
from derive.verify.columns import Plan, arithmetics, found_and_true, supplied
from derive.verify.draw import Dice, Sampled, admitted, drawn
from derive.verify.operators import Column
from derive.verify.proved.cut import Peaks
from derive.verify.proved.sphere import of_about_unit_length
from derive.verify.scale import measured_outputs


@dataclass(frozen=True)
class Search:
    """How widely a search goes: samples to begin with, then rounds of more from the worst.

    kept   : of these, for each output
    finest : halvings of the ranges that steps come down to     operations : of a round, at most
    """

    samples: int = 4096
    rounds: int = 120
    batch: int = 4096
    kept: int = 32
    finest: int = 24
    operations: int = 600_000

    def of(self, program: Program) -> "Search":
        """Return a search of as many samples a round as so many operations take, or 128."""
        few = max(128, self.operations // reduce(add, program.count.values(), 1))
        return replace(self, samples=min(self.samples, 4 * few), batch=min(self.batch, few))


SEARCH = Search()
ABOUT = 20
"""Samples that are tried about a point."""


@dataclass(frozen=True)
class Hunt:
    """What a search moves: what a function rests on alone, quaternions of about unit length."""

    of: Sampled
    plan: Plan
    moved: Column

    def gaps(self, rows: Column) -> Column:
        """Return how far each measured output is off at samples: the largest of its components."""
        by, outputs = arithmetics(self.of.precision.dtype), measured_outputs(self.plan.program)
        with np.errstate(all="ignore"):
            at = supplied(self.of.setup, by_component(self.of, rows), by)
            each = np.array([np.abs(by.off(f, t)) for f, t in found_and_true(self.plan, at, by)])
        each = np.where(np.isfinite(each), each, 0.0)
        return np.array([each[span].max(axis=0) for _, span in outputs])

    def fitting(self, rows: Column, start: Column) -> Column:
        """Return samples on the ranges, of bodies that can be, else those that they came from."""
        rows = np.clip(rows, self.of.lows[:, None], self.of.highs[:, None])
        for q, span in placed(self.of.quantities):
            if q.is_quaternion:
                rows[span] = of_about_unit_length(rows[span])
        return np.where(admitted(self.of, rows), rows, start)

    def beside(self, dice: Dice, parents: Column, by: Search, share: float) -> Column:
        """Return samples beside parents, the nearer the more of the search is done.

        Most differ by few components: what rounding does to the others' values stays.
        """
        start = parents[:, (dice.uniform(by.batch) * parents.shape[1]).astype(int)]
        few = np.maximum(dice.uniform(by.batch) ** 4, 1.5 / len(self.moved))
        changed = dice.uniform(len(self.moved), by.batch) < few
        return self.shaken(dice, start, 1 + by.finest * share * dice.uniform(by.batch), changed)

    def shaken(self, dice: Dice, start: Column, fine: Column, changed: Column) -> Column:
        """Return samples moved by parts of the ranges that are so many times halved."""
        reach = np.ldexp(1.0, -fine.astype(int))
        across = (self.of.highs - self.of.lows)[self.moved, None] * reach
        by, rows = (2 * dice.uniform(*changed.shape) - 1) * across, start.copy()
        rows[self.moved] += np.where(changed, by, 0.0)
        return self.fitting(rows, start)


def by_component(of: Sampled, rows: Column) -> dict[str, Column]:
    """Return samples by component, remainders as parts of their states, as floats."""
    dtype = of.precision.dtype
    own: dict[str, Column] = dict(zip(of.names, rows.astype(dtype), strict=True))
    return own | {
        c: own[c] * np.abs(own[c.removeprefix(f"{REMAINDER}_")]) * dtype(of.precision.unit_roundoff)
        for q in of.quantities
        for c in q.components
        if q.role == "remainder"
    }


def seen(of: Sampled, plan: Plan, peaks: Sequence[Peaks], by: Search) -> list[float]:
    """Return the largest error that is found of each measured output, absolute.

    peaks : where bounds are largest, to begin from besides
    """
    by, name = by.of(plan.program), plan.program.name
    dice = Dice(f"derive: {of.library.scene.name} {of.precision.name} seen {name}")
    met = {n for each in peaks for n in each.names}
    hunt = Hunt(of, plan, np.flatnonzero([n in met for n in of.names]))
    start = drawn(of, dice, by.samples)
    every = [hunt.fitting(start, start), *(_at(hunt, dice, each, by) for each in peaks)]
    rows = np.concatenate(every, axis=1)
    found = hunt.gaps(rows)
    best, kept = found.max(axis=1), _worst(rows, found, by.kept)
    for turn in range(by.rounds if len(hunt.moved) else 0):
        rows = np.concatenate([kept, hunt.beside(dice, kept, by, turn / by.rounds)], axis=1)
        found = hunt.gaps(rows)
        best, kept = np.maximum(best, found.max(axis=1)), _worst(rows, found, by.kept)
    return [float(x) for x in best]


def _worst(rows: Column, found: Column, kept: int) -> Column:
    """Return the samples at which each output is worst."""
    each = [np.argsort(-row, kind="stable")[:kept] for row in found]
    return rows[:, np.unique(np.concatenate(each))]


def _at(hunt: Hunt, dice: Dice, peaks: Peaks, by: Search) -> Column:
    """Return samples about points, or how it rounds just there would decide who is kept.

    Of a remainder, whose sample is a part of its state, any.
    """
    points = np.repeat(peaks.points, ABOUT, axis=1)
    start = drawn(hunt.of, dice, points.shape[1])
    rows = start.copy()
    for name, row in zip(peaks.names, points, strict=True):
        if name in hunt.of.names and not name.startswith(REMAINDER):
            rows[hunt.of.names.index(name)] = row
    rows, count = hunt.fitting(rows, start), points.shape[1]
    fine = by.finest * (1 + 3 * dice.uniform(count)) / 4
    return hunt.shaken(dice, rows, fine, np.ones((len(hunt.moved), count), bool))
