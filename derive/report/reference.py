"""The true end of a motion, from the lecture's equations of the state's rate alone, in long floats.

The equations of the problem are solved as they stand, block by block, and their solution is
followed by extrapolation of midpoint rules, in lengths that keep what it leaves below ``LEFT``: in
C on sums of two doubles; without a compiler, and where it is stiff, in floats of 128 bits. No step,
arrangement or program of ours has a part in it.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from flint import arb, ctx

from derive.library.library import Library
from derive.report.extrapolation import DEEPEST, Rule, extrapolated, rule_for
from derive.report.rate import RateOfState, rate_of_state
from derive.report.two_doubles import taken_in_c
from derive.verify.convergence import unit_attitude

BITS = 128
GROWN = 100
"""Times its size at the beginning, and one: what has grown so far does not stop of itself."""
INFINITE, NO_VALUE = "becomes infinite", "meets a place where its equations have no value"
GROWS, LONG = f"grows more than {GROWN} times", "takes too long to be followed"
"""What becomes of motions without an end, and of those that are not followed to it."""
LEFT = 1e-20
"""Relative: what extrapolation may leave in each of its lengths, far below u of a double."""
SHORTEST = 1e-13
"""Of the whole time: a motion that needs shorter lengths runs into a place without a value."""
WORK = {"C": 600_000_000, "Python": 40_000_000}
"""Operations that one motion may take: some five seconds."""
From = Callable[[list[Any]], Callable[[float], tuple[list[Any], float]]]
"""From a state, then a length, to the state after it, and what extrapolation leaves."""
EARLY, SLOW = 50, 0.25
"""From so many lengths on, less than so much of their share of the time says that it is long."""


class NoEndError(ArithmeticError):
    """A motion that cannot be followed to its end.

    work : operations that it took to see it
    """

    def __init__(self, why: str, work: int) -> None:
        super().__init__(why, work)  # as it goes from one process to another
        self.why, self.work = why, work


@dataclass(frozen=True)
class End:
    """Where a motion truly ends, and the largest size of each component of the state on its way.

    state : of each component two doubles, of which the second is what the first leaves
    work  : operations in long floats that it took
    """

    state: Mapping[str, tuple[float, float]]
    sizes: Mapping[str, float]
    work: int


def end_of(
    library: Library,
    values: Mapping[str, float],
    time: float,
    fast: float,
    made: Path | None = None,
) -> End:
    """Return where the motion from a state ends after ``time``, followed from ``fast`` on.

    fast : rad/s, about how fast it goes: the first length is a turn of 1 rad
    made : what takes lengths in C, as ``extrapolation_made`` gives it
    Raises NoEndError where the motion cannot be followed.
    """
    with ctx.workprec(BITS):
        given = unit_attitude(library, {c: arb(x) for c, x in values.items()})
        names = [c for q in library.vocabulary.states for c in q.components]
        start = [given[c] for c in names]
        sizes = [abs(float(x)) for x in start]
        here, large, why, part, tried = start, GROWN * (1 + max(sizes)), NO_VALUE, 0.0, 0
        rate = rate_of_state(library, given)
        rule = rule_for(rate, start, fast)
        price = rule.calls * max(1, rate.count)
        by, work = _takes(rule, rate, made)
        most = max(EARLY, work // price)
        lengths = _lengths(by, start, time, min(time, 1 / fast))
        for tried, (here, part) in enumerate(lengths, 1):
            sizes = [max(size, abs(float(x))) for size, x in zip(sizes, here, strict=True)]
            if tried >= EARLY and part < max(SLOW * tried, tried + 1 - most) / most:
                why = LONG
                break
        if part < 1:
            grown = max(sizes) > large
            raise NoEndError(
                {LONG: GROWS, NO_VALUE: INFINITE}[why] if grown else why, tried * price
            )
        ends = [(float(x), float(x - arb(float(x)))) for x in here]
        state = dict(zip(names, ends, strict=True))
        return End(state, dict(zip(names, sizes, strict=True)), tried * price)


def _takes(rule: Rule, rate: RateOfState, made: Path | None) -> tuple[From, int]:
    """Return what takes a length from a state on, and the operations that a motion may take."""
    in_c = None if made is None or rule.stiff else taken_in_c(made, rate)
    if in_c is None:
        return lambda here: partial(extrapolated, rule.begun(here)), WORK["Python"]
    return lambda here: partial(in_c, here), WORK["C"]


def _lengths(
    by: From, here: list[Any], time: float, length: float
) -> Iterator[tuple[list[Any], float]]:
    """Yield after each length that is tried where a motion is, and which part of its time is done.

    They end with the motion, or once they are nothing.
    """
    done, taken = arb(0), by(here)
    while length > SHORTEST * time:
        after, left = taken(length)
        if left > LEFT:
            length *= max(0.2, 0.9 * (LEFT / left) ** (1 / (2 * DEEPEST)))
            yield here, float(done) / time
            continue
        here, done = after, (done + arb(length)).mid()
        rest = float(arb(time) - done)
        yield here, float(done) / time if rest > 0 else 1.0
        if rest <= 0:
            return
        grown = 0.9 * (LEFT / max(left, 1e-40)) ** (1 / (2 * DEEPEST))
        length, taken = min(rest, length * min(3.0, max(1.0, grown))), by(here)
