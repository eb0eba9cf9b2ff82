"""What becomes of members: moved in blocks to their end or an event, what is kept of each.

Events are found in the step that crosses them, once all members of a block are through: halves of
halves of that step are taken, all of one length, by those that have not crossed yet. A sign that
changes at a pole is no event; members that meet one go again, with each crossing looked at as it
comes. A residual that turns back near zero is looked at as soon as it does.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from derive.library.library import Library
from derive.program.status import RIGHT, SAYS
from derive.solve.crossing import crossed_in, turn_back
from derive.solve.sweep.beginning import FAR_OFF, UNCLOSED, lanes_begun
from derive.solve.sweep.keep import COURSE, EXTREMES
from derive.solve.sweep.kit import ByMembers
from derive.solve.sweep.lanes import ByQuantity, Lanes
from derive.solve.sweep.plan import SweepPlan
from derive.solve.sweep.vary import FloatColumn

TOGETHER = 2048
"""Members that move together: their states and constants stay in the cache of a core."""
UNTIL, STOPPED, ASTRAY, REFUSED = "until", "stop", "not finite", "refused: "
WHY = {
    **SAYS,
    UNCLOSED: "no start nearby fulfils the constraints",
    FAR_OFF: "a start that fulfils the constraints is further off than --near allows",
}
Refining = Literal["later", "at once"]
StepsAround = Literal["both", "the last"]
"""Which steps a residual may have turned back in: around an instant, or before it."""
MostSoFar = Mapping[str, FloatColumn]


@dataclass(frozen=True)
class Endings:
    """What became of members: a column of numbers each, a course (members, instants).

    ended : "until", "stop", "not finite" or why set-up refuses        time : s, the end
    valued : whether what is to be zero at an event had a value anywhere
    """

    columns: dict[str, FloatColumn]
    ended: NDArray[np.object_]
    time: FloatColumn
    valued: NDArray[np.bool_]


@dataclass(frozen=True)
class _Met:
    """Lanes at the start of a step in which an event may be.

    number : of the step, of each lane      left, right : residuals around it      turns : whether
    the residual turns back in it
    """

    lanes: Lanes
    number: NDArray[np.int64]
    left: FloatColumn
    right: FloatColumn
    turns: NDArray[np.bool_]


def endings(
    by: ByMembers,
    library: Library,
    plan: SweepPlan,
    given: Mapping[str, FloatColumn | float],
    count: int,
) -> Endings:
    """Return what becomes of ``count`` members; of each component a number, or one for each."""
    many = len(plan.instants)
    columns = {
        k.column: np.full((count, many) if k.how == COURSE else count, np.nan) for k in plan.kept
    }
    whole = Endings(columns, np.full(count, UNTIL, object), np.full(count, np.nan),
                    np.zeros(count, bool))  # fmt: skip
    with np.errstate(all="ignore"):
        for first in range(0, count, TOGETHER):
            ids = np.arange(first, min(first + TOGETHER, count))
            lanes, status = lanes_begun(by, library, plan, given, ids)
            for number in np.unique(status[status != RIGHT]):
                whole.ended[ids[status == number]] = f"{REFUSED}{WHY[int(number)]}"
            again = _to_their_ends(lanes.chosen(status == RIGHT), whole, "later")
            if len(again):
                _to_their_ends(lanes_begun(by, library, plan, given, again)[0], whole, "at once")
    return whole


@dataclass
class _BetweenSteps:
    """Lanes between two steps: who still runs, extremes and residuals, now and a step ago."""

    lanes: Lanes
    whole: Endings
    refining: Refining
    runs: NDArray[np.bool_]
    most: MostSoFar
    left: FloatColumn
    most_before: MostSoFar
    left_before: FloatColumn
    valued: NDArray[np.bool_]
    met: list[_Met] = field(default_factory=list)

    def on(self, number: int) -> None:
        """Take a step, and see to what may have stopped in it or in the one before."""
        self.lanes.on(self.lanes.plan.seconds)
        if not self.lanes.plan.stop:
            return
        right = self.lanes.residual()
        self.valued |= np.isfinite(right)
        crossed = self.runs & ((self.left * right < 0) | ((right == 0) & (self.left != 0)))
        self._turned(number, right)
        if (crossed := crossed & self.runs).any():
            own = self._meeting(crossed, self.lanes.before, number, self.left, right)
            _flush(own.lanes.ids, _of(self.most, crossed), self.whole)
            if self.refining == "at once":
                crossed[crossed] = _refined(own, self.whole)
            else:
                self.met.append(own)
            self.runs &= ~crossed
        self.left_before, self.left = self.left, right

    def beyond(self, number: int) -> None:
        """Look a step further, for what turned back in the last one."""
        self.lanes.on(self.lanes.plan.seconds)
        self._turned(number, self.lanes.residual(), "the last")
        self.lanes.undo()

    def _turned(self, number: int, right: FloatColumn, of: StepsAround = "both") -> None:
        """Stop those whose residual turned back around the start of a step and was zero there."""
        turned = self.runs & turn_back(self.left_before, self.left, right)
        ways = [(self.lanes.earlier, number - 1, self.left_before, self.left, self.most_before)]
        ways += [(self.lanes.before, number, self.left, right, self.most)] if of == "both" else []
        for state, step, left, after, most in ways:
            if step > 0 and turned.any():
                own = self._meeting(turned, state, step, left, after, turned)
                _flush(own.lanes.ids, _of(most, turned), self.whole)
                stopped = turned.copy()
                stopped[turned] = _refined(own, self.whole)
                self.runs &= ~stopped
                turned &= ~stopped

    def _meeting(
        self, which: NDArray[np.bool_], state: ByQuantity, number: int, left: FloatColumn,
        right: FloatColumn, turns: NDArray[np.bool_] | None = None,
    ) -> _Met:  # fmt: skip
        there = np.full(which.sum(), number)
        turned = np.zeros(len(there), bool) if turns is None else turns[which]
        return _Met(self.lanes.chosen(which, state), there, left[which], right[which], turned)

    def follow(self) -> None:
        """Take what is largest and smallest so far."""
        if self.lanes.plan.stop:
            self.most_before = {c: x.copy() for c, x in self.most.items()}
        for k in self.lanes.plan.kept:
            if k.how in EXTREMES:
                own = self.most[k.column]
                EXTREMES[k.how](own, self.lanes.value(k.component), out=own)

    def keep_at(self, marks: Sequence[tuple[float, float]]) -> None:
        """Keep what is asked for at instants of the last step."""
        for time, rest in marks:
            if rest == 0:
                _at_instant(self.lanes, self.whole, time, self.runs)
            elif self.runs.any():
                aside = self.lanes.chosen(self.runs, self.lanes.before)
                aside.on(rest)
                _at_instant(aside, self.whole, time, np.ones(len(aside), bool))

    def without_the_ended(self) -> None:
        """Go on without those that have ended, once they are half of all."""
        if 2 * np.count_nonzero(self.runs) < len(self.lanes):
            runs, stop = self.runs, self.lanes.plan.stop
            self.whole.valued[self.lanes.ids] |= self.valued
            self.lanes = self.lanes.chosen(runs, back=2 if stop else 0)
            self.most, self.most_before = _of(self.most, runs), _of(self.most_before, runs)
            if stop:
                self.left, self.left_before = self.left[runs], self.left_before[runs]
            self.runs, self.valued = np.ones(len(self.lanes), bool), self.valued[runs]


def _begun(lanes: Lanes, whole: Endings, refining: Refining) -> _BetweenSteps:
    """Return members at their start; the residual a step before it tells which way it goes."""
    most = {k.column: np.array(lanes.value(k.component))
            for k in lanes.plan.kept if k.how in EXTREMES}  # fmt: skip
    left, before = np.zeros(len(lanes)), np.zeros(len(lanes))
    if lanes.plan.stop:
        left = lanes.residual()
        lanes.on(-lanes.plan.seconds)
        before = lanes.residual()
        lanes.undo()
    every = np.ones(len(lanes), bool)
    return _BetweenSteps(lanes, whole, refining, every, most, left, most, before, np.isfinite(left))


def _to_their_ends(lanes: Lanes, whole: Endings, refining: Refining) -> NDArray[np.int64]:
    """Move members to their ends; return those that a pole was taken for an event of."""
    plan, way = lanes.plan, _begun(lanes, whole, refining)
    way.keep_at(plan.marks.get(0, ()))
    for before, number in pairwise((0, *plan.looked)):
        if not len(way.lanes):
            break
        way.lanes.on(plan.seconds, number - before - 1)
        way.on(number)
        way.keep_at(plan.marks.get(number, ()))
        way.follow()
        way.without_the_ended()
    whole.valued[way.lanes.ids] |= way.valued
    if plan.stop and len(way.lanes):
        way.beyond(plan.steps + 1)
    _finished(way.lanes.chosen(way.runs), _of(way.most, way.runs), whole)
    again = [own.lanes.ids[~_refined(own, whole)] for own in _joined(way.met)]
    return np.concatenate([np.zeros(0, np.int64), *again])


def _of(most: MostSoFar, which: NDArray[np.bool_]) -> MostSoFar:
    return {column: x[which] for column, x in most.items()}


def _at_instant(lanes: Lanes, whole: Endings, time: float, which: NDArray[np.bool_]) -> None:
    """Keep what is asked for at an instant, of some lanes."""
    _put_at(whole, lanes.plan, time, lanes.ids[which], lambda name: lanes.value(name)[which])


def _put_at(
    whole: Endings, plan: SweepPlan, time: float, ids: NDArray[np.int64],
    value: Callable[[str], FloatColumn | float],
) -> None:  # fmt: skip
    for k in plan.kept:
        if k.how == "at" and k.time == time:
            whole.columns[k.column][ids] = value(k.component)
        elif k.how == COURSE and time in plan.instants:
            whole.columns[k.column][ids, plan.instants.index(time)] = value(k.component)


def _flush(ids: NDArray[np.int64], most: MostSoFar, whole: Endings) -> None:
    for column, values in most.items():
        whole.columns[column][ids] = values


def _finished(lanes: Lanes, most: Mapping[str, FloatColumn], whole: Endings) -> None:
    """Keep what is asked for at the end of members that nothing stopped."""
    _flush(lanes.ids, most, whole)
    right = lanes.are_finite()
    whole.time[lanes.ids[right]] = lanes.plan.until
    whole.ended[lanes.ids[~right]] = ASTRAY
    for k in lanes.plan.kept:
        if k.how == "end":
            whole.columns[k.column][lanes.ids] = lanes.value(k.component)


def _joined(met: list[_Met]) -> list[_Met]:
    """Return crossings together, as one that all are in; none if there are none."""
    if not met:
        return []
    first, *more = met
    every = [np.concatenate([getattr(own, name) for own in met])
             for name in ("number", "left", "right", "turns")]  # fmt: skip
    return [_Met(first.lanes.beside([own.lanes for own in more]), *every)]


def _refined(of: _Met, whole: Endings) -> NDArray[np.bool_]:
    """Find events within their steps and keep what is asked for there; tell which are no poles."""
    lanes, plan = of.lanes, of.lanes.plan
    start = lanes.chosen(np.ones(len(lanes), bool))
    rest, good = crossed_in(lanes, of.left, plan.seconds, of.turns)
    good &= np.abs(lanes.residual()) <= np.maximum(np.abs(of.left), np.abs(of.right))
    ids, time = lanes.ids[good], ((of.number - 1) * plan.seconds + rest)[good]
    whole.ended[ids], whole.time[ids] = STOPPED, time
    for k in plan.kept:
        if k.how == "end":
            whole.columns[k.column][ids] = lanes.value(k.component)[good]
        elif k.how in EXTREMES:
            before = whole.columns[k.column][ids]
            whole.columns[k.column][ids] = EXTREMES[k.how](before, lanes.value(k.component)[good])
    for number in np.unique(of.number[good]):
        own = good & (of.number == number)
        for instant, part in plan.marks.get(int(number), ()):
            _put_at(whole, plan, instant, lanes.ids[own], lambda _: np.nan)
            early = start.chosen(own & (part > 0) & (rest >= part))
            if len(early):
                early.on(part)
                _at_instant(early, whole, instant, np.ones(len(early), bool))
    return good
