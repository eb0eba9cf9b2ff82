"""Where the errors of functions are largest: many samples of the ranges, then from the worst on.

Samples are drawn in columns. A search then takes the worst of each output, changes some of their
inputs by steps that shrink, keeps the worst again, and so on. What is found here is an error that
pairs of doubles see; what is stated is measured at these samples in balls (see ``measure``).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from derive.library.library import Library
from derive.program.pair_sine import PI
from derive.program.precision import Precision
from derive.verify.columns import Column, Known, Plan, arithmetics, found_and_true, planned
from derive.verify.draw import (
    Completing,
    Dice,
    Ranges,
    admitted,
    complete,
    completing,
    drawn,
    on_the_sphere,
    ranges,
)
from derive.verify.scale import (
    Sizing,
    around,
    lecture_scales,
    measured_outputs,
    motion_scales,
    sizing,
)

CHUNK = 8192
TURN = 2 * float(PI)
MIDDLE = 16384
"""Samples that a median is taken of."""


@dataclass(frozen=True)
class Sampling:
    """How widely a figure is looked for: samples of the ranges, then rounds from the worst.

    corners : samples of every hard kind, and ``balls`` ordinary ones, measured in balls besides
    """

    samples: int = 200_000
    rounds: int = 16
    batch: int = 4096
    kept: int = 8
    balls: int = 96
    corners: int = 6
    motion_balls: int = 24
    motion_corners: int = 6

    def searched(self) -> int:
        """Return how many samples of each function the search takes."""
        return self.rounds * self.batch


SAMPLING = Sampling()


def sampled_at(samples: int) -> Sampling:
    """Return a sampling with so many samples of the ranges, and a search of half as many."""
    if samples == SAMPLING.samples:
        return SAMPLING
    return Sampling(samples=max(samples, 1), batch=max(1, samples // (2 * SAMPLING.rounds)))


QUICK = Sampling(samples=2048, rounds=4, batch=512)


@dataclass(frozen=True)
class Worst:
    """The worst samples of an output, errors in u and raw columns, and the median of all."""

    function: str
    output: str
    errors: Column  # (kept,), the largest first
    rows: Column  # (raw components, kept)
    median: float


@dataclass(frozen=True)
class Field:
    """All that is needed to tell the errors of a scene's functions at columns of samples."""

    precision: Precision
    ranges: Ranges
    completing: Completing
    sizing: Sizing
    plans: tuple[Plan, ...]
    lectured: frozenset[str]


def field(library: Library, precision: Precision) -> Field:
    """Return what tells the errors of a scene's functions in one precision."""
    return Field(
        precision,
        ranges(library, precision),
        completing(library),
        sizing(library, float(np.finfo(precision.dtype).smallest_normal)),
        tuple(map(planned, library.printed())),
        frozenset(f.name for f in library.functions),
    )


def errors_at(of: Field, plan: Plan, at: Known) -> list[Column]:
    """Return the errors of each measured output: rows by component, columns by sample, in u."""
    by = arithmetics(of.precision.dtype)
    with np.errstate(all="ignore"):
        pairs = found_and_true(plan, at, by)
        if plan.program.name in of.lectured:
            scales = lecture_scales(of.sizing, plan.program, at.wide)
        else:
            single = of.precision.dtype is np.float32
            true = [t if single else t[0] for _, t in pairs]
            scales = motion_scales(of.sizing, plan, at.wide, true)
        off = [
            np.abs(_apart(by.off(f, t), whole)) / scale / of.precision.unit_roundoff
            for (f, t), scale, whole in zip(pairs, scales, around(plan.program), strict=True)
        ]
    rows = np.array([np.where(np.isfinite(x), x, np.inf) for x in off])
    return [rows[span] for _, span in measured_outputs(plan.program)]


def _apart(gaps: Column, whole: object) -> Column:
    """Return how far numbers are apart, without whole turns if they are angles."""
    return gaps - TURN * np.round(gaps / TURN) if whole else gaps


@dataclass
class Best:
    """The worst samples so far of each output of one program, and errors for the medians."""

    kept: int
    errors: list[Column]
    rows: list[Column]
    middle: list[list[Column]]

    def add(self, found: Sequence[Column], rows: Column) -> None:
        for n, own in enumerate(found):
            worst = np.concatenate([self.errors[n], own.max(axis=0)])
            order = np.argsort(-worst, kind="stable")[: self.kept]
            every = np.concatenate([self.rows[n], rows], axis=1)
            self.errors[n], self.rows[n] = worst[order], every[:, order]


def _best(plan: Plan, kept: int, height: int) -> Best:
    count = len(measured_outputs(plan.program))
    return Best(
        kept,
        [np.zeros(0) for _ in range(count)],
        [np.zeros((height, 0)) for _ in range(count)],
        [[] for _ in range(count)],
    )


def sampled(of: Field, seed: str, count: int, kept: int) -> Iterator[tuple[int, list[Best]]]:
    """Yield how many samples are done, and the worst so far of each program."""
    scene = of.ranges.library.known.scene.name
    dice = Dice(f"derive: {scene} {of.precision.name} {seed}")
    best = [_best(plan, kept, len(of.ranges.names)) for plan in of.plans]
    done = 0
    while done < count:
        rows = drawn(of.ranges, dice, min(CHUNK, count - done))
        at = complete(of.ranges, of.completing, rows)
        for plan, own in zip(of.plans, best, strict=True):
            found = errors_at(of, plan, at)
            own.add(found, rows)
            if done < MIDDLE:
                for middle, errors in zip(own.middle, found, strict=True):
                    middle.append(errors.ravel())
        done += rows.shape[1]
        yield done, best


def searched(of: Field, plan: Plan, best: Best, by: Sampling) -> None:
    """Look for worse samples of a program from the worst on."""
    scene, name = of.ranges.library.known.scene.name, plan.program.name
    dice = Dice(f"derive: {scene} {of.precision.name} search {name}")
    for turn in range(by.rounds):
        parents = np.concatenate(best.rows, axis=1)
        for done in range(0, by.batch, CHUNK):
            count = min(CHUNK, by.batch - done)
            rows = _changed(of.ranges, dice, parents, count, turn / by.rounds)
            best.add(errors_at(of, plan, complete(of.ranges, of.completing, rows)), rows)


def _changed(of: Ranges, dice: Dice, parents: Column, count: int, share: float) -> Column:
    """Return samples beside some of the parents, the nearer the more of the search is done."""
    which = (dice.uniform(count) * parents.shape[1]).astype(int)
    start = parents[:, which]
    reach = 2.0 ** (-1 - 14 * share * dice.uniform(count))
    many = dice.uniform(count)
    moved = dice.uniform(*start.shape) < np.maximum(many * many, 1.5 / len(of.names))
    across = (of.highs - of.lows)[:, None] * reach
    steps = np.where(moved, (2 * dice.uniform(*start.shape) - 1) * across, 0.0)
    rows = np.clip(start + steps, of.lows[:, None], of.highs[:, None])
    rows = on_the_sphere(of, rows)
    return np.where(admitted(of, rows), rows, start)


def worst(library: Library, precision: Precision, by: Sampling) -> list[Worst]:
    """Return the worst samples of every output of every function in one precision."""
    of = field(library, precision)
    best: list[Best] = []
    for _, best in sampled(of, "measured", by.samples, by.kept):  # noqa: B007 - the last is kept
        pass
    for plan, own in zip(of.plans, best, strict=True):
        searched(of, plan, own, by)
    return worst_of(of, best)


def worst_of(of: Field, best: Sequence[Best]) -> list[Worst]:
    """Return the worst samples of every output of every function, as they are known by now."""
    found = []
    for plan, own in zip(of.plans, best, strict=True):
        for n, (q, _) in enumerate(measured_outputs(plan.program)):
            middle = float(np.median(np.concatenate(own.middle[n])))
            found.append(Worst(plan.program.name, q.name, own.errors[n], own.rows[n], middle))
    return found
