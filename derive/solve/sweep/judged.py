"""Members that lengths of step are judged at, and how far apart two lengths take them.

Attitudes and angles count in rad, all else beside the largest size on the way of what has its unit,
at every instant of a course and at the end.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from derive.program.program import Quantity, placed
from derive.report.apart import Ends, beside_what, errors_at_end
from derive.solve.sweep.course import ASTRAY, REFUSED, Endings
from derive.solve.sweep.design import Design
from derive.solve.sweep.job import ENDED_AT
from derive.solve.sweep.keep import COURSE, EXTREMES, KeptColumn
from derive.solve.sweep.plan import SweepPlan
from derive.solve.sweep.vary import FloatColumn

TRIED, OTHERS, BLOCKS = 128, 512, 64
"""Members by which a length is chosen, those by which it is tried then, and in how many places
of the sweep they stand: from the first to the last member, at no equal distances, for grids repeat.
"""
SMALL = 4 * (TRIED + OTHERS)
"""Members of a sweep of which any may be tried."""
GOLDEN = (5**0.5 - 1) / 2
NOISE = 2.0**-30
"""Of a declared range: what stays smaller on the way is beside this, not beside its own size."""
FEW = 1 / 64
"""Of the members, those that may end otherwise by half the step: what grazes an event does."""


@dataclass(frozen=True)
class Gap:
    """How far apart two lengths of step take members.

    worst : the largest error of a state        otherwise : how many end in another way, of ``many``
    astray : those that become no numbers by both
    """

    worst: float
    otherwise: int
    many: int
    astray: frozenset[int] = frozenset()

    @property
    def is_judged(self) -> bool:
        """Tell whether enough members have an end by both: a shorter step may give it to others."""
        return len(self.astray) + self.otherwise <= FEW * self.many

    def within(self, error: float) -> bool:
        """Tell whether no member is further off than an error, but for those few."""
        return self.worst <= error and self.otherwise <= FEW * self.many


def tried_members(design: Design) -> dict[str, FloatColumn]:
    """Return what varies of the members that a length is chosen by, from all places of a sweep."""
    return _from_places(design, TRIED, 0)


def other_members(design: Design) -> dict[str, FloatColumn]:
    """Return what varies of others beside these, which may be the same where there are few."""
    return _from_places(design, OTHERS, TRIED)


def how_many_tried(design: Design) -> int:
    """Return how many members both are."""
    return min(design.members, TRIED + OTHERS)


def _from_places(design: Design, count: int, behind: int) -> dict[str, FloatColumn]:
    members = design.members
    if members <= SMALL:
        shuffled = np.argsort(np.arange(members) * GOLDEN % 1)
        own = shuffled[-count:] if behind else shuffled[:count]
        return {name: x[own] for name, x in design.values(0, members).items()}
    places = [(k + k * GOLDEN % 1) / BLOCKS for k in range(BLOCKS - 1)] + [1.0]
    firsts = [int(place * (members - (TRIED + OTHERS) // BLOCKS)) for place in places]
    each = [design.values(first + behind // BLOCKS, count // BLOCKS) for first in firsts]
    return {name: np.concatenate([own[name] for own in each]) for name in each[0]}


def judging(plan: SweepPlan, states: Sequence[Quantity]) -> SweepPlan:
    """Return a plan that keeps all of the state as well."""
    kept = {k.column: k for k in plan.kept}
    for q in states:
        for c in q.components:
            for how in (COURSE, "end"):
                kept[f"{c}@{how}"] = KeptColumn(f"{c}@{how}", c, how, q.unit)
    return replace(plan, kept=tuple(kept.values()))


def gap_between(plan: SweepPlan, states: Sequence[Quantity], one: Endings, fine: Endings) -> Gap:
    """Return how far apart two lengths of step take the same members, by a plan that judges."""
    here, there = (_states(states, of) for of in (one, fine))
    differs = one.ended != fine.ended
    with np.errstate(all="ignore"):
        sizes = np.max(np.where(np.isfinite(there), np.abs(there), 0.0), axis=2, keepdims=True)
        widths = np.array([float(q.ends[1] - q.ends[0]) for q in states for _ in q.components])
        sizes = np.maximum(sizes, NOISE * widths[:, None, None])
        beside = np.broadcast_to(beside_what(states, sizes[..., 0])[..., None], there.shape)
        there_are = np.isfinite(here).all(axis=0) & np.isfinite(there).all(axis=0)
        there_are &= ~differs[:, None]
        here, there, beside = (x[:, there_are] for x in (here, there, beside))
        gaps = errors_at_end(states, here, Ends(there, np.zeros_like(there), beside))
    worst = [float(gaps.max()) if gaps.size else 0.0]
    rows = {c: k for k, c in enumerate(c for q in states for c in q.components)}
    size = beside_what(states, sizes[..., 0])
    for k in plan.kept:
        if k.how in EXTREMES and k.component in rows:
            off = np.abs(one.columns[k.column] - fine.columns[k.column]) / size[rows[k.component]]
            worst.append(float(np.max(off[np.isfinite(off) & ~differs], initial=0.0)))
    many = int(np.count_nonzero([not how.startswith(REFUSED) for how in fine.ended]))
    astray = frozenset(np.flatnonzero((fine.ended == ASTRAY) & ~differs).tolist())
    return Gap(max(worst), int(differs.sum()), many, astray)


def _states(states: Sequence[Quantity], of: Endings) -> FloatColumn:
    """Return (components, members, instants of a course and the end)."""
    names = [c for q, _ in placed(states) for c in q.components]
    return np.array([np.column_stack([of.columns[f"{c}@{COURSE}"], of.columns[f"{c}@end"]])
                     for c in names])  # fmt: skip


def halved_columns(plan: SweepPlan, one: Endings, half: Endings) -> Mapping[str, float]:
    """Return by column the most that half the step changes in it."""
    both = {k.column: (one.columns[k.column], half.columns[k.column]) for k in plan.kept}
    both[ENDED_AT] = one.time, half.time
    found = {}
    for column, (a, b) in both.items():
        gaps = np.abs(a - b)
        found[column] = float(np.max(gaps[np.isfinite(gaps)], initial=0.0))
    return found
