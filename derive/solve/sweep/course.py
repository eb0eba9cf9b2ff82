"""What becomes of members: moved in blocks to their end or an event, what is kept of each.

Events are found in the step that crosses them, once all members of a block are through: halves of
halves of that step are taken, all of one length, by those that have not crossed yet. A sign that
changes at a pole is no event; members that meet one go again, with each crossing looked at as it
comes.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from derive.library.library import Library
from derive.program.status import RIGHT, SAYS
from derive.solve.sweep.keep import COURSE
from derive.solve.sweep.kit import ByMembers
from derive.solve.sweep.lanes import UNCLOSED, Lanes, lanes_begun
from derive.solve.sweep.plan import SweepPlan
from derive.solve.sweep.vary import FloatColumn

TOGETHER = 2048
"""Members that move together: their states and constants stay in the cache of a core."""
HALVINGS = 45
"""Of a step, until an event in it is found."""
UNTIL, STOPPED, ASTRAY, REFUSED = "until", "stop", "not finite", "refused: "
WHY = {**SAYS, UNCLOSED: "no start nearby fulfils the constraints"}
Refining = Literal["later", "at once"]
EXTREMES: Mapping[str, Any] = {"max": np.maximum, "min": np.minimum}


@dataclass(frozen=True)
class Endings:
    """What became of members: a column of numbers each, a course (members, instants).

    ended : "until", "stop", "not finite" or why set-up refuses        time : s, the end
    """

    columns: dict[str, FloatColumn]
    ended: NDArray[np.object_]
    time: FloatColumn


@dataclass(frozen=True)
class _Met:
    """Lanes in the step that crosses an event: since when, how long it is, residuals around it."""

    lanes: Lanes
    since: FloatColumn
    length: float
    left: FloatColumn
    right: FloatColumn


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
    whole = Endings(columns, np.full(count, UNTIL, object), np.full(count, np.nan))
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


def _to_their_ends(lanes: Lanes, whole: Endings, refining: Refining) -> NDArray[np.int64]:
    """Move members to their ends; return those that a pole was taken for an event of."""
    plan, met = lanes.plan, list[_Met]()
    _at_instant(lanes, whole, 0.0, np.ones(len(lanes), bool))
    runs = np.ones(len(lanes), bool)
    most = {k.column: np.array(lanes.value(k.component)) for k in plan.kept if k.how in EXTREMES}
    left = lanes.residual() if plan.stop else np.zeros(0)
    for mark, (start, count, length) in zip(plan.marks[1:], plan.parts(), strict=True):
        for n in range(count):
            if not len(lanes):
                break
            lanes.on(length)
            if plan.stop:
                right = lanes.residual()
                crossed = runs & ((left * right < 0) | ((right == 0) & (left != 0)))
                if crossed.any():
                    own = _Met(lanes.chosen(crossed, lanes.before),
                               np.full(crossed.sum(), start + n * length), length,
                               left[crossed], right[crossed])  # fmt: skip
                    _flush(own.lanes.ids, {c: x[crossed] for c, x in most.items()}, whole)
                    if refining == "at once":
                        crossed[crossed] = _refined(own, whole)
                    else:
                        met.append(own)
                    runs &= ~crossed
                left = right
            _follow(lanes, most)
            if 2 * runs.sum() < len(lanes):
                lanes, left = lanes.chosen(runs), left[runs] if plan.stop else left
                most = {c: x[runs] for c, x in most.items()}
                runs = np.ones(len(lanes), bool)
        _at_instant(lanes, whole, mark, runs)
    _finished(lanes.chosen(runs), {c: x[runs] for c, x in most.items()}, whole)
    again = [own.lanes.ids[~_refined(own, whole)] for own in _joined(met)]
    return np.concatenate([np.zeros(0, np.int64), *again])


def _follow(lanes: Lanes, most: Mapping[str, FloatColumn]) -> None:
    for k in lanes.plan.kept:
        if k.how in EXTREMES:
            EXTREMES[k.how](most[k.column], lanes.value(k.component), out=most[k.column])


def _at_instant(lanes: Lanes, whole: Endings, time: float, runs: NDArray[np.bool_]) -> None:
    """Keep what is asked for at an instant, of those that have not ended before."""
    for k in lanes.plan.kept:
        if k.how == "at" and k.time == time:
            whole.columns[k.column][lanes.ids[runs]] = lanes.value(k.component)[runs]
        elif k.how == COURSE and time in lanes.plan.instants:
            place = lanes.plan.instants.index(time)
            whole.columns[k.column][lanes.ids[runs], place] = lanes.value(k.component)[runs]


def _flush(ids: NDArray[np.int64], most: Mapping[str, FloatColumn], whole: Endings) -> None:
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
    """Return crossings, those in steps of one length together."""
    found = []
    for length in dict.fromkeys(own.length for own in met):
        same = [own for own in met if own.length == length]
        found.append(
            _Met(same[0].lanes.beside([own.lanes for own in same[1:]]),
                 np.concatenate([own.since for own in same]), length,
                 np.concatenate([own.left for own in same]),
                 np.concatenate([own.right for own in same]))
        )  # fmt: skip
    return found


def _refined(of: _Met, whole: Endings) -> NDArray[np.bool_]:
    """Find events within their steps and keep what is asked for there; tell which are no poles."""
    lanes, time, length = of.lanes, of.since.copy(), of.length
    for _ in range(HALVINGS):
        length /= 2
        lanes.on(length)
        same = lanes.residual() * of.left > 0
        lanes.back(~same)
        time[same] += length
    lanes.on(length)
    time += length
    value = np.abs(lanes.residual())
    good: NDArray[np.bool_] = value <= np.maximum(np.abs(of.left), np.abs(of.right))
    ids = lanes.ids[good]
    whole.ended[ids], whole.time[ids] = STOPPED, time[good]
    for k in lanes.plan.kept:
        if k.how == "end":
            whole.columns[k.column][ids] = lanes.value(k.component)[good]
        elif k.how in EXTREMES:
            before = whole.columns[k.column][ids]
            whole.columns[k.column][ids] = EXTREMES[k.how](before, lanes.value(k.component)[good])
    return good
