"""What a call costs: weighted operations, and with a compiler nanoseconds, measured in batches.

A batch is as many calls in a row as take a good part of a millisecond, so that the clock's own
steps do not count; the median of the batches stands beside their quartiles.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from derive.program.program import Program
from derive.report.driver import Driver, Storage
from derive.report.march import march
from derive.report.states import Begun
from derive.verify.draw import Dice, Sampled, complete, drawn

BATCHES, TRIED = 21, 3
"""As many as are measured, and as tell how many rounds they have."""
LASTS = 4e-4
"""s of a batch."""
MOST, STEPS, FEWEST = 1 << 22, 1 << 12, 1 << 8
"""Rounds of a batch of a function; steps of a motion in the shortest length timed, and in the
longest, which are the rounds of a batch of steps: it stays within its motion."""
ROWS = 64
"""Samples that calls of a function go through in turn; a step moves one state on and on."""
LIBM_COSTS = {"sin": 20, "cos": 20, "atan2": 40}
"""What an angle is counted as, about what a good libm takes, and a sine: with its cosine it takes
52 operations in double, 45 in float. A root is one."""
PAIR_COSTS = {"add": 20, "sub": 20, "mul": 24, "div": 131, "sqrt": 43, "sin": 1000, "cos": 1000}
"""The same on pairs of floats, as the templates of ``pair/`` do them."""


@dataclass(frozen=True)
class Nanoseconds:
    """Of a call: the median of the batches, and their quartiles."""

    function: str
    form: str
    precision: str
    median: float
    low: float
    high: float


def price_of(program: Program) -> int:
    """Return the weighted operations of a call: + - * / and roots are one, a sine its weight."""
    if program.arithmetic == "pairs":
        return sum(PAIR_COSTS.get(o, 0) * n for o, n in program.count.items())
    more = {**LIBM_COSTS, "sqrt": 1}
    return program.flops() + sum(more.get(o, 0) * n for o, n in program.count.items())


def nanoseconds(
    driver: Driver,
    form: str,
    programs: Sequence[Program],
    start: Begun | None,
    lengths: Mapping[str, float],
) -> list[Nanoseconds]:
    """Return how long calls of functions take; nothing where there is no compiler.

    lengths : s, of steps by name: their motion from ``start`` has ``STEPS`` of the shortest
    """
    if driver.shared is None:
        return []
    found = []
    for program in programs:
        length = lengths.get(program.name, 0.0)
        batch, calls = _batch(driver, program, start, length)
        most = FEWEST if calls == 1 else MOST
        low, middle, high = _quartiles(batch, calls, most)
        found.append(Nanoseconds(program.name, form, driver.precision.name, middle, low, high))
    return found


def _batch(
    driver: Driver, program: Program, start: Begun | None, length: float
) -> tuple[Callable[[int], None], int]:
    """Return what runs so many rounds of calls from the same start, and the calls of a round."""
    if start is not None and any(q.name.endswith("_next") for q in program.outputs):
        ready = march(driver, program.name, start.at([0]), length)
        kept = {name: x.copy() for name, x in ready.at.items()}

        def again(rounds: int) -> None:
            for name, x in kept.items():
                ready.at[name][...] = x
            ready.on(rounds)

        return again, 1
    at = rows_at(driver)
    into = driver.room(program, ROWS)
    return lambda rounds: driver.call(program, at, into, rounds), ROWS


def rows_at(driver: Driver) -> Storage:
    """Return rows of samples of all that the functions of a scene are given."""
    of = Sampled(driver.library, driver.precision)
    rows = drawn(of, Dice(f"derive: {driver.library.scene.name} price"), ROWS)
    own = complete(of, rows).own
    every = (*of.quantities, *(q for p in driver.library.printed() for q in p.inputs))
    names = {q.name: q for q in every if all(c in own for c in q.components)}
    at = {name: np.ascontiguousarray(np.array([own[c] for c in q.components]).T)
          for name, q in names.items()}  # fmt: skip
    return driver.with_constants(at)


def _quartiles(batch: Callable[[int], None], calls: int, most: int) -> tuple[float, float, float]:
    """Return the quartiles of the ns that a call takes in batches, less what empty ones take."""
    rounds = 1
    while (took := min(_timed(batch, rounds) for _ in range(TRIED))) < LASTS and rounds < most:
        rounds = min(most, rounds * max(2, int(1.2 * LASTS / max(took, 1e-7))))
    for _ in range(TRIED):
        idle = min(_timed(batch, 0) for _ in range(BATCHES))
        whole = [_timed(batch, rounds) - idle for _ in range(BATCHES)]
        if min(whole) > 0:  # else the machine did something else meanwhile
            break
    else:
        whole = [took + idle for took in whole]
    each = [took / (rounds * calls) * 1e9 for took in whole]
    low, middle, high = (float(x) for x in np.quantile(each, (0.25, 0.5, 0.75)))
    return low, middle, high


def _timed(batch: Callable[[int], None], rounds: int) -> float:
    before = time.perf_counter()
    batch(rounds)
    return time.perf_counter() - before
