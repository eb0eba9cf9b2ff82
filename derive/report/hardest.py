"""The states of the declared ranges from which motions are hardest to compute, looked for widely.

RK4 at two lengths of step tells in doubles how wrong it is at the longer one; the worst states, and
those beside them that are worse, are then measured against the reference. What neither length
follows is hardest of all, and counts, unless its motion has no end: ``fate`` tells which.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from derive.report.apart import Ends, beside_what, errors_at_end
from derive.report.driver import Driver
from derive.report.fate import ENDS, STEP, fates
from derive.report.march import ended
from derive.report.states import Begun, begun, nearby
from derive.verify.operators import Column

DRAWN, NEARBY = 256, 256
TURN = 1 / 32
"""rad of the longer step."""
FINER = 4
LOST = 0.5
"""A gap above which neither of the two steps says where a motion goes."""
LOSES = f"RK4 loses at 1/{round(FINER / TURN)} rad a step"
HARD, PLAIN = 2, 2
REACH = 0.1


@dataclass(frozen=True)
class Hardest:
    """States to measure at: the hardest found, then some as they came.

    hard  : first those that RK4 did not follow, then those that it did
    tried : how many were looked at        aside : how many of those have a motion without an end,
    by what becomes of it                  unmet : how many others RK4 did not follow
    """

    hard: Begun
    plain: Begun
    tried: int
    aside: Mapping[str, int]
    unmet: int


def hardest(driver: Driver, seed: str, time: float, fast: float) -> Hardest:
    """Return the hardest states of a scene for a motion over ``time``."""
    library = driver.library
    every = begun(library, seed, DRAWN)
    hard, what = how_hard(driver, every, time, fast)
    kept = [n for n in np.argsort(-hard, kind="stable") if what[n] == ENDS]
    worst = every.at(kept[:HARD])
    more = nearby(library, worst, seed, NEARBY, REACH) if kept else worst
    both = worst.joined(more)
    hard_beside, what_beside = how_hard(driver, both, time, fast)
    order = [n for n in np.argsort(-hard_beside, kind="stable") if what_beside[n] == ENDS]
    plain = every.at([n for n in range(DRAWN) if what[n] == ENDS][:PLAIN])
    aside = Counter([w for w in (*what, *what_beside[len(worst) :]) if w != ENDS])
    followed = every.at([n for n in kept if hard[n] <= LOST][:HARD])
    own = [*order[:HARD], *[n for n in order[HARD:] if hard_beside[n] <= LOST][:HARD]]
    beside = [n for n in order if n >= len(worst)]
    unmet = int(np.sum(hard[kept] > LOST) + np.sum(hard_beside[beside] > LOST))
    return Hardest(both.at(own).joined(followed), plain, len(every) + len(more), aside, unmet)


def how_hard(
    driver: Driver, start: Begun, time: float, fast: float
) -> tuple[Column, tuple[str, ...]]:
    """Return how hard each state is, and what becomes of its motion.

    Where RK4 follows it is how wrong it is, at most ``LOST``; else more, the more the shorter the
    lengths must be that follow.
    """
    wrong, lost = how_wrong(driver, start, time, fast)
    places, what = np.flatnonzero(lost), [ENDS] * len(start)
    if len(places):
        found = fates(driver, start.at(places), time, fast)
        wrong[places] = 1 / found.shortest
        for place, one in zip(places, found.each, strict=True):
            what[place] = one
    return wrong, tuple(what)


def how_wrong(driver: Driver, start: Begun, time: float, fast: float) -> tuple[Column, Column]:
    """Return how far two lengths of RK4 end apart, and which states neither can follow."""
    states = driver.library.vocabulary.states
    count = power_above(time * fast / TURN)
    coarse, fine = (ended(driver, STEP, start, time, n) for n in (count, FINER * count))
    begin = np.concatenate([in_order(start, q.components) for q in states])
    sizes = np.maximum(np.abs(begin), np.abs(fine))
    sizes = np.where(np.isfinite(sizes), sizes, 1.0)
    true = Ends(fine, np.zeros_like(fine), beside_what(states, sizes))
    wrong = errors_at_end(states, coarse, true)
    return wrong, wrong > LOST


def in_order(start: Begun, names: Sequence[str]) -> Column:
    """Return some components of states, in this order."""
    return start.columns[[start.names.index(name) for name in names]]


def power_above(x: float) -> int:
    """Return the power of two at or above a number: a float's part of a time is then a float.

    >>> power_above(1000.0), power_above(0.3)
    (1024, 1)
    """
    return 1 << max(0, int(np.ceil(np.log2(max(x, 1.0)))))
