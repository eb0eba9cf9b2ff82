"""The step and its length for a wanted error, found at members that are drawn.

Each step is tried at one length in the whole time, then at halves of it. A length is taken if at
it, and at half of it, members go where a quarter of it takes them, within half of the error; then
it is stretched as far as the order seen allows. It must keep to the error at other members, too.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import ceil, inf, isfinite, log2
from time import perf_counter

from derive.emit.c.members import is_in_vectors
from derive.library.library import Library
from derive.report.price import price_of
from derive.report.sentence import MARGIN, in_time, rounded_down
from derive.scene import SceneError
from derive.solve.event import no_value
from derive.solve.simulation import steps_by_state
from derive.solve.sweep.course import Endings
from derive.solve.sweep.job import Job, endings_of
from derive.solve.sweep.judged import (
    Gap,
    gap_between,
    halved_columns,
    how_many_tried,
    judging,
    other_members,
    tried_members,
)
from derive.solve.sweep.kit import kit_of
from derive.solve.sweep.plan import SweepPlan
from derive.solve.sweep.vary import FloatColumn

MOST_STEPS = 1 << 20
"""Of the shortest length that is tried."""
FINER = 4
"""A length is held against this part of it."""
GAIN, PATIENCE, USELESS = 0.7, 3, 0.1
"""A finer step that leaves more of the gap than ``GAIN`` gains nothing; so often, it is the last.
Above ``USELESS`` nothing is said of rounding."""
PERSISTENT = 4
"""Halves of a length after which members that become no numbers by all of them have no end."""
STRETCHED = 1.02
"""More steps than the order seen says that the error needs."""
ORDERS = (0.5, 30.0)


@dataclass(frozen=True)
class Verified:
    """A plan that was tried at other members: what half the step changes, and a sentence.

    spent : s, that these members took
    """

    plan: SweepPlan
    halved: Mapping[str, float]
    spent: float
    says: str


@dataclass(frozen=True)
class _Mover:
    """Members that are moved as often as need be."""

    job: Job
    members: Mapping[str, FloatColumn]

    def moved(self, step: str, count: int) -> Endings:
        """Return where so many steps take them."""
        plan = replace(self.job.plan, step=step, length=self.job.plan.until / count)
        return endings_of(self.job, self.members, plan)

    def gap(self, one: Endings, fine: Endings) -> Gap:
        """Return how far apart two lengths take them."""
        return gap_between(self.job.plan, self.job.kit.library.vocabulary.states, one, fine)


def usable(library: Library) -> tuple[str, ...]:
    """Return the steps that a scene wants and that move members in vectors, by state alone."""
    return tuple(name for name in steps_by_state(library) if is_in_vectors(library[name]))


def verified(
    library: Library, job: Job, error: float, tell: Callable[[str], None]
) -> Verified:  # fmt: skip
    """Return the cheapest plan of the scene's own steps that is seen to keep to an error.

    Raises SceneError where none does.
    """
    steps, of = usable(library), judging(job.plan, library.vocabulary.states)
    plans = [replace(of, step=name) for name in steps]
    kit = kit_of(library, [*dict.fromkeys(n for plan in plans for n in plan.functions)])
    trial = _Mover(replace(job, kit=kit, plan=of), tried_members(job.design))
    found: dict[str, int] = {}
    least = 1.0
    for name in steps:
        tell(f"trying lengths of {name}")
        price = price_of(library[name])
        most = min((price_of(library[n]) * c for n, c in found.items()), default=None)
        limit = MOST_STEPS if most is None else min(MOST_STEPS, FINER * most // price)
        count, kept = _fewest(trial, name, error, int(limit))
        least = min(least, kept)
        if count:
            found = {name: count}
    for name, count in found.items():
        return _tried(trial, replace(job.plan, step=name), count, error)
    raise SceneError(_none(library, job.plan.until, steps, error, least))


def as_asked(job: Job) -> Verified:
    """Return the plan of a job, with what half the step changes in other members."""
    trial = _Mover(job, other_members(job.design))
    says = f"{job.plan.step} at {job.plan.length:g} s, as was asked"
    half, spent = _half(trial, job.plan)
    return Verified(job.plan, halved_columns(job.plan, *half), spent, says)


def _none(
    library: Library, until: float, steps: tuple[str, ...], error: float, least: float
) -> str:  # fmt: skip
    says = f"over {until:g} s none of {', '.join(steps)} was seen to keep below {error:g}"
    best = f"the best keeps below {rounded_down(least, 1)}" if least < 1 else (
        "none takes members near where half of it does")  # fmt: skip
    return f"scene '{library.scene.name}': {says}: {best}; --step sets a length all the same"


def _fewest(trial: _Mover, step: str, error: float, limit: int) -> tuple[int, float]:
    """Return how few steps keep to an error, 0 if none do, and what the finest that was tried does.

    limit : of steps of the shortest length
    """
    ends, gaps, count = dict[int, Endings](), list[float](), 1
    lost: list[tuple[int, frozenset[int]]] = []
    while count <= limit and _gains(gaps):
        ends[count] = trial.moved(step, count)
        if count >= FINER:
            whole, half = (trial.gap(ends[n], ends[count]) for n in (count // FINER, count // 2))
            gaps.append(max(whole.worst, half.worst) if whole.is_judged else inf)
            keeps = all(own.within(error / MARGIN) for own in (whole, half))
            if keeps and whole.is_judged:
                return _stretched(trial, step, error, ends, count // FINER), gaps[-1]
            lost = [*lost, (count // FINER, whole.astray)] if keeps else []
            if len(lost) > PERSISTENT and len({own for _, own in lost[-PERSISTENT - 1 :]}) == 1:
                return lost[-PERSISTENT - 1][0], whole.worst
            ends.pop(count // FINER // 2, None)
        count *= 2
    return 0, min(gaps, default=1.0)


def _gains(gaps: list[float]) -> bool:
    """Tell whether shorter steps may still help."""
    if len(gaps) <= PATIENCE:
        return True
    before, after = min(gaps[:-PATIENCE]), min(gaps[-PATIENCE:])
    return before > USELESS or after < GAIN * before


def _stretched(
    trial: _Mover, step: str, error: float, ends: Mapping[int, Endings], count: int
) -> int:  # fmt: skip
    """Return fewer steps than a count that keeps to an error, more than half of it, if any do."""
    fine = ends[FINER * count]
    for fewer in _between(trial, error, ends, count):
        if trial.gap(trial.moved(step, fewer), fine).within(error / MARGIN):
            return fewer
    return count


def _between(
    trial: _Mover, error: float, ends: Mapping[int, Endings], count: int
) -> Iterator[int]:  # fmt: skip
    """Yield the steps that an error needs by the order seen at a count and at half of it.

    They end at the instants of courses, where that takes no part of a step more.
    """
    if count // 2 not in ends:
        return
    more, own = (trial.gap(ends[n], ends[FINER * count]).worst for n in (count // 2, count))
    if own > 0 and isfinite(more) and ORDERS[0] < (order := log2(more / own)) < ORDERS[1]:
        need = STRETCHED * count * (own * MARGIN / error) ** (1 / order)
        parts = trial.job.plan.intervals
        fewer = parts * ceil(need / parts) if need > parts else ceil(need)
        if count // 2 < fewer < count:
            yield fewer


def _tried(trial: _Mover, plan: SweepPlan, count: int, error: float) -> Verified:
    """Return a plan of so many steps, or of twice as many, that keeps to an error at others."""
    design = trial.job.design
    others = replace(trial, members=other_members(design))
    while True:
        own = replace(plan, length=plan.until / count)
        half, spent = _half(others, replace(trial.job.plan, step=own.step, length=own.length))
        gap = others.gap(*half)
        if gap.within(error):
            break
        if 2 * count > MOST_STEPS:
            raise SceneError(
                _none(trial.job.kit.library, plan.until, (plan.step,), error, gap.worst)
            )
        count *= 2
    says = f"{own.step} at {in_time(own.length)} keeps below {error:g} over {plan.until:g} s"
    says += f" in the {how_many_tried(design)} members tried, and half of it changes the state by "
    says += f"{gap.worst:.1g} at most"
    if gap.otherwise:
        says += f"; {gap.otherwise} of them end otherwise by half of it"
    if gap.astray:
        says += f"; {len(gap.astray)} of them become no numbers, by shorter steps neither"
    return Verified(own, halved_columns(own, *half), spent, says)


def _half(trial: _Mover, plan: SweepPlan) -> tuple[tuple[Endings, Endings], float]:
    """Return where a plan and half its step take members, and s that the first took."""
    first = {name: x[:1] for name, x in trial.members.items()}
    endings_of(trial.job, first, replace(plan, length=plan.until))
    began = perf_counter()
    whole = endings_of(trial.job, trial.members, plan)
    spent = perf_counter() - began
    if plan.stop and not whole.valued.any():
        name = trial.job.kit.library.scene.name
        raise SceneError(no_value(name, plan.stop))
    half = endings_of(trial.job, trial.members, replace(plan, length=plan.seconds / 2))
    return (whole, half), spent / max(1, len(whole.time))
