"""What becomes of motions that equal steps do not follow: they end, become infinite, or stop.

RK4 with lengths of its own for each state, by halves, tells it in doubles. A motion that reaches
the end has one, however wrong equal steps are on its way; so has one that is slow only because its
steps must be short beside what they follow. Lengths that shrink to nothing are met where there is
no value any more; what grows a hundred times over, beside a pole or without bound, is told apart,
and so is what goes like other motions for most of the time, and far faster on a part of its way.
What is stiff does not: it is quiet for most of the time, and a usual step is unstable all the same.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from derive.program.program import Quantity
from derive.report.apart import beside_what
from derive.report.driver import Driver, Storage
from derive.report.march import march
from derive.report.reference import GROWN, GROWS, INFINITE, NO_VALUE
from derive.report.states import Begun
from derive.verify.operators import Column

STEP = "step_rk4"
KEPT = 1e-7
"""What halves may leave of a length, relative."""
MEAN = 8
"""Lengths in a row, about, of which a mean is taken."""
ROUNDS = {"C": 6000, "NumPy": 200}
SHORTEST = 1e-13
"""Of the whole time: below, a length is nothing."""
VAST, ENDS = 1e100, ""
PASSES = "needs much shorter steps on a part of its way, as in a sharp turn or beside a pole"
EASY = 1 / 64
"""rad: a length that is usual among motions that equal steps follow."""
MOST = 0.5
NUDGE, TAKEN, GREW = 1e-6, 16, 100.0
"""A small change of a state, relative, grows more than so many times in so many unstable steps."""


@dataclass(frozen=True)
class Fates:
    """Of each state: what becomes of its motion, ENDS where it has an end, and how hard it is.

    shortest : the shortest length that was needed, of the whole time, a mean of some in a row: one
    that was made too short and let grow again says nothing
    """

    each: tuple[str, ...]
    shortest: Column


@dataclass
class _UnderWay:
    """Motions under way: rows of the step's arguments, time and length of each, of the whole.

    usual : the logarithm of lengths, a mean that forgets        least : the smallest that it was
    peak  : the largest size of any component on the way
    easy  : the part of the time that was done in usual lengths
    """

    at: Storage
    done: Column
    length: Column
    usual: Column
    least: Column
    peak: Column
    easy: Column


def fates(driver: Driver, start: Begun, time: float, fast: float) -> Fates:
    """Return what becomes of motions over a time; ``fast`` is about the rate that they go with."""
    whole = march(driver, STEP, start, time).at
    count = len(start)
    usual = min(1.0, EASY / max(time * fast, 1e-9))
    length = np.full(count, usual)
    logs, first = np.log(length), _largest(driver, whole)
    begun_at = {n: x.copy() for n, x in whole.items()}
    way = _UnderWay(whole, np.zeros(count), length, logs, logs.copy(), first.copy(),
                    np.zeros(count))  # fmt: skip
    states = driver.library.vocabulary.states
    for _ in range(ROUNDS["NumPy" if driver.shared is None else "C"]):
        on = np.flatnonzero((way.done < 1) & (way.length > SHORTEST)
                            & (_largest(driver, whole) < VAST))  # fmt: skip
        if not len(on):
            break
        done = way.done.copy()
        _advanced(driver, way, on, time, states)
        way.easy += np.where(way.done - done >= usual, way.done - done, 0.0)
        way.peak = np.maximum(way.peak, _largest(driver, whole))
    grown = way.peak > GROWN * np.maximum(first, 1.0)
    stopped, ended = way.length <= SHORTEST, way.done >= 1
    ends = (_is_stable(driver, at, begun_at, 2 * usual * time) for at in (begun_at, way.at))
    passes = (way.easy > MOST) & (np.exp(way.least) < usual / 2) & np.any([*ends], axis=0)
    each = [
        (INFINITE if g else NO_VALUE) if s and not e else GROWS if g else PASSES if p else ENDS
        for e, s, g, p in zip(ended, stopped, grown, passes, strict=True)
    ]
    return Fates(tuple(each), np.exp(way.least))


def _is_stable(driver: Driver, at: Storage, begun_at: Storage, length: float) -> Column:
    """Tell of each state whether equal steps from it keep what is changed by little so."""
    names = [q.name for q in driver.library.vocabulary.states]
    far = {n: np.maximum(np.abs(at[n]), np.abs(begun_at[n])).max(axis=1)[:, None] for n in names}
    every = np.full(len(far[names[0]]), length)
    moved = at | {n: at[n] + NUDGE * far[n] for n in names}
    one, other = (_taken(driver, rows, every, TAKEN, names) for rows in (at, moved))
    with np.errstate(all="ignore"):
        stays = [np.all(np.abs(one[n] - other[n]) <= GREW * NUDGE * far[n], axis=1) for n in names]
    found: Column = np.all(stays, axis=0)
    return found


def _largest(driver: Driver, at: Storage) -> Column:
    """Return the largest size of all components of a state."""
    own = [np.max(np.abs(at[q.name]), axis=1) for q in driver.library.vocabulary.states]
    worst: Column = np.max(np.array(own), axis=0)
    return np.where(np.isnan(worst), np.inf, worst)


def _advanced(
    driver: Driver, way: _UnderWay, on: Column, time: float, states: Sequence[Quantity]
) -> None:
    """Take one length of those that are on their way, or shorten it where halves say so."""
    names = [q.name for q in states]
    rows = {n: x[on] if len(x) == len(way.done) > 1 else x for n, x in way.at.items()}
    length = np.minimum(way.length[on], 1 - way.done[on])
    once = _taken(driver, rows, length * time, 1, names)
    twice = _taken(driver, rows, length * time / 2, 2, names)
    flat = [np.concatenate([x[n].T for n in names]) for x in (rows, once, twice)]
    with np.errstate(all="ignore"):
        sizes = beside_what(states, np.maximum(np.abs(flat[0]), 1e-9 * np.abs(flat[2])))
        left = np.max(np.abs(flat[1] - flat[2]) / sizes, axis=0)
    left = np.where(np.isfinite(left), left, np.inf)
    good = left <= KEPT
    for n in names:
        way.at[n][on[good]] = twice[n][good]
    way.done[on[good]] += length[good]
    way.done[on[good & (way.done[on] > 1 - 1e-12)]] = 1.0
    whole = on[good & (length == way.length[on])]  # not what is left to the end
    way.usual[whole] += (np.log(way.length[whole]) - way.usual[whole]) / MEAN
    way.least[whole] = np.minimum(way.least[whole], way.usual[whole])
    with np.errstate(all="ignore"):
        factor = np.clip(0.9 * (KEPT / np.maximum(left, 1e-300)) ** 0.2, 0.2, 4.0)
    way.length[on] = length * np.where(np.isfinite(left), factor, 0.2)


def _taken(driver: Driver, rows: Storage, length: Column, count: int, names: list[str]) -> Storage:
    """Return the states after steps, each state's of a length of its own."""
    own = {n: x.copy() if n in names else x for n, x in rows.items()}
    own["time_step"] = np.ascontiguousarray(length[:, None], driver.precision.dtype)
    program = driver.library[STEP]
    driver.call(program, own, driver.over(program, own), count)
    return {n: own[n] for n in names}
