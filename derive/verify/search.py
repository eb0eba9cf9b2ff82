"""Where the errors of functions are largest: many samples of the ranges, then from the worst on.

Samples are drawn in columns. A search then takes the worst of each output, changes some of their
inputs by steps that shrink, keeps the worst again, and so on. What is found here is an error that
pairs of doubles see; what is stated is measured at these samples in balls (see ``measure``).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from derive.program.pair_sine import PI
from derive.program.program import Program
from derive.verify.columns import Plan, Supplied, arithmetics, found_and_true
from derive.verify.draw import Dice, Sampled, admitted, complete, drawn, on_the_sphere
from derive.verify.operators import Column
from derive.verify.scale import around, lecture_scales, measured_outputs, motion_scales

CHUNK = 8192
TURN = 2 * float(PI)
MIDDLE = 16384
"""Samples that a median is taken of."""
LEAST = 1024
"""Samples of a round of the search, however few are drawn: it is what finds the largest error."""


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

    def at_hard_bodies(self) -> "Sampling":
        """Return how widely motions of hard bodies are searched."""
        return replace(self, batch=max(1, self.batch // 8))


SAMPLING = Sampling()


def sampled_at(samples: int) -> Sampling:
    """Return a sampling with so many samples of the ranges, and a search of half as many at least.

    A figure is a promise to samples that nobody has drawn: those of few are searched for as well.
    """
    if samples == SAMPLING.samples:
        return SAMPLING
    return Sampling(samples=max(samples, 1), batch=max(LEAST, samples // (2 * SAMPLING.rounds)))


@dataclass
class Worst:
    """The worst samples so far of an output, and errors for its median.

    errors : (kept,) in u, the largest first      rows : (raw components, kept)
    """

    function: str
    output: str
    errors: Column
    rows: Column
    middle: list[Column]

    @property
    def median(self) -> float:
        """Return the median of the errors at the first samples."""
        return float(np.median(np.concatenate(self.middle)))

    def add(self, found: Column, rows: Column, kept: int) -> None:
        """Take in the errors of more samples."""
        worst = np.concatenate([self.errors, found.max(axis=0)])
        order = np.argsort(-worst, kind="stable")[:kept]
        every = np.concatenate([self.rows, rows], axis=1)
        self.errors, self.rows = worst[order], every[:, order]


def worst_of(program: Program, output: str, height: int) -> Worst:
    """Return what holds the worst samples of an output, none so far."""
    return Worst(program.name, output, np.zeros(0), np.zeros((height, 0)), [])


def errors_at(of: Sampled, plan: Plan, at: Supplied) -> list[Column]:
    """Return the errors of each measured output: rows by component, columns by sample, in u."""
    by = arithmetics(of.precision.dtype)
    with np.errstate(all="ignore"):
        pairs = found_and_true(plan, at, by)
        if plan.program in of.library.functions:
            scales = lecture_scales(of, plan.program, at.wide)
        else:
            single = of.precision.dtype is np.float32
            true = [t if single else t[0] for _, t in pairs]
            scales = motion_scales(of, plan, at.wide, true)
        off = [
            np.abs(_apart(by.off(f, t), whole)) / scale / of.precision.unit_roundoff
            for (f, t), scale, whole in zip(pairs, scales, around(plan.program), strict=True)
        ]
    rows = np.array([np.where(np.isfinite(x), x, np.inf) for x in off])
    return [rows[span] for _, span in measured_outputs(plan.program)]


def _apart(gaps: Column, whole: object) -> Column:
    """Return how far numbers are apart, without whole turns if they are angles."""
    return gaps - TURN * np.round(gaps / TURN) if whole else gaps


def sampled(of: Sampled, seed: str, count: int, kept: int) -> Iterator[tuple[int, list[Worst]]]:
    """Yield how many samples are done, and the worst so far of each output of each function."""
    dice = Dice(f"derive: {of.library.scene.name} {of.precision.name} {seed}")
    best = [
        worst_of(plan.program, q.name, len(of.names))
        for plan in of.plans
        for q, _ in measured_outputs(plan.program)
    ]
    done = 0
    while done < count:
        rows = drawn(of, dice, min(CHUNK, count - done))
        at = complete(of, rows)
        every = chain.from_iterable(errors_at(of, plan, at) for plan in of.plans)
        for own, found in zip(best, every, strict=True):
            own.add(found, rows, kept)
            if done < MIDDLE:
                own.middle.append(found.ravel())
        done += rows.shape[1]
        yield done, best


def searched(of: Sampled, plan: Plan, best: Sequence[Worst], by: Sampling, free: Column) -> None:
    """Look for worse samples of a function from the worst of its outputs on.

    free : (names,) which components are changed; the others stay, be they in their ranges or not
    """
    scene, name = of.library.scene.name, plan.program.name
    dice = Dice(f"derive: {scene} {of.precision.name} search {name}")
    for turn in range(by.rounds):
        parents = np.concatenate([own.rows for own in best], axis=1)
        for done in range(0, by.batch, CHUNK):
            count = min(CHUNK, by.batch - done)
            rows = _changed(of, dice, parents, count, turn / by.rounds, free)
            for own, found in zip(best, errors_at(of, plan, complete(of, rows)), strict=True):
                own.add(found, rows, by.kept)


def _changed(
    of: Sampled, dice: Dice, parents: Column, count: int, share: float, free: Column
) -> Column:
    """Return samples beside some of the parents, the nearer the more of the search is done."""
    which = (dice.uniform(count) * parents.shape[1]).astype(int)
    start = parents[:, which]
    reach = 2.0 ** (-1 - 14 * share * dice.uniform(count))
    many = dice.uniform(count)
    moved = dice.uniform(*start.shape) < np.maximum(many * many, 1.5 / len(of.names))
    across = (of.highs - of.lows)[:, None] * reach
    steps = np.where(moved, (2 * dice.uniform(*start.shape) - 1) * across, 0.0)
    rows = np.clip(start + steps, of.lows[:, None], of.highs[:, None])
    rows = on_the_sphere(of, np.where(free[:, None], rows, start))
    return np.where(admitted(of, rows), rows, start)


def worst_motions(of: Sampled, plan: Plan, at: Column, by: Sampling) -> Column:
    """Return the samples, of those given and beside them, at which a function is worst.

    at : raw samples, a row a component; their parameters stay, so that hard bodies stay hard
    """
    found = errors_at(of, plan, complete(of, at))
    outputs = measured_outputs(plan.program)
    best = [worst_of(plan.program, q.name, len(of.names)) for q, _ in outputs]
    for own, errors in zip(best, found, strict=True):
        own.add(errors, at, by.kept)
    fixed = {c for q in of.library.vocabulary.parameters for c in q.components}
    free = np.array([name not in fixed for name in of.names])
    if at.shape[1] and free.any():
        searched(of, plan, best, by, free)
    return np.concatenate([own.rows for own in best], axis=1)


def worst(of: Sampled, by: Sampling) -> list[Worst]:
    """Return the worst samples of every output of every function in one precision."""
    best: list[Worst] = []
    for _, best in sampled(of, "measured", by.samples, by.kept):  # noqa: B007 - the last is kept
        pass
    for plan in of.plans:
        own = [each for each in best if each.function == plan.program.name]
        searched(of, plan, own, by, np.full(len(of.names), fill_value=True))
    return best
