"""The steps of a scene beside the true motion: error at the end over lengths of step, and cost."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from math import isfinite
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from derive.library.library import Library
from derive.motion.runge_kutta.system import FLOW
from derive.program.largest import largest
from derive.program.precision import F32, F64
from derive.program.program import Program
from derive.report.apart import Ends, beside_what, errors_at_end, true_ends
from derive.report.driver import Driver
from derive.report.hardest import HARD, LOSES, Hardest, hardest, power_above
from derive.report.march import ended
from derive.report.price import price_of
from derive.report.reference import End, NoEndError, end_of
from derive.report.states import LEAST_TURNS, MOST_TURNS, Begun, fastest, horizon
from derive.report.two_doubles import extrapolation_made
from derive.report.wishes import Wished
from derive.scene import SceneError

WORKERS = 2
COARSEST = 2.0
"""rad of the longest step."""
MOST_WORK = {"C": 4e8, "NumPy": 2e5}
"""Operations of a step's longest run: about a second in C; NumPy does all states at once."""
GAIN, PATIENCE, USELESS = 0.7, 3, 0.1
"""A finer step that leaves more of the error than ``GAIN`` gains nothing; so often, it is the last.
Above ``USELESS`` nothing is said of rounding."""
CHANGED = 2.0**-26
FINEST = "step_taylor"
Tell = Callable[[str], None]


@dataclass(frozen=True)
class Attempt:
    """One length of one step: so many to the end, and how wrong each of the states is there."""

    step: str
    precision: str
    length: float
    count: int
    errors: tuple[float, ...]

    @property
    def worst(self) -> float:
        """Return the largest error of all states."""
        return largest(self.errors)

    @property
    def middle(self) -> float:
        """Return the median of the errors."""
        return float(np.median(self.errors))


@dataclass(frozen=True)
class StepErrors:
    """What was found of a scene's steps.

    time, given : s, and whether it was asked for      fast : rad/s, as ``fastest`` says
    start : the states, the ``hard`` ones first         tried, aside : how many were looked at, and
    how many of those were left aside, by the reason     costs : weighted operations of each step
    work : operations in long floats that following the true motions took
    floors : by precision, what rounding the given numbers alone makes of the end, state by state
    """

    time: float
    given: bool
    fast: float
    start: Begun
    hard: int
    tried: int
    aside: Mapping[str, int]
    work: int
    attempts: tuple[Attempt, ...]
    costs: dict[str, int]
    floors: dict[str, tuple[float, ...]]

    @property
    def lost(self) -> int:
        """Return how many states were left aside."""
        return Counter(self.aside).total()


@dataclass(frozen=True)
class Followed:
    """States whose motions the reference followed, and their ends.

    hard : how many of them are hard, which come first      aside : how many were not, by the reason
    work : operations in long floats that all took
    """

    start: Begun
    ends: list[End]
    hard: int
    aside: Counter[str]
    work: int


def step_errors(of: Wished, by: Sequence[Driver], until: float | None, tell: Tell) -> StepErrors:
    """Return what a scene's steps cost and how wrong they are at the end of a time.

    until : s, None for the scene's horizon, or for what suits it
    Raises SceneError where no motion can be followed to its end.
    """
    library, double = of.library, next(d for d in by if d.precision is F64)
    tell("looking for the hardest states")
    fast = fastest(library)
    time = time_of(library, until, fast)
    found = hardest(double, "measured", time, fast)
    tell("following the true motion")
    followed = followed_to_the_end(library, found, time, fast)
    start, true = followed.start, true_ends(library.vocabulary.states, followed.ends)
    attempts: list[Attempt] = []
    for driver in by:
        for name in of.steps:
            tell(f"{name} in {driver.precision.scalar}")
            attempts += _attempts(driver, name, start, true, time, fast)
    tell("what rounding allows")
    floors = floors_of(double, start, time, _smoothest(attempts))
    costs = {name: price_of(library[name]) for name in of.steps}
    return StepErrors(
        time, until is not None, fast, start, followed.hard, found.tried,
        Counter(found.aside) + followed.aside, followed.work, tuple(attempts), costs, floors,
    )  # fmt: skip


def time_of(library: Library, until: float | None, fast: float) -> float:
    """Return the time to the end: a float, so that its halves are floats as well."""
    name = library.scene.name
    said = "horizon" if until is None else "until"
    if until is None and library.scene.horizon is not None:
        until = float(library.scene.horizon)
    if until is None:
        return float(np.float32(horizon(fast)))
    if not (isfinite(until) and until > 0):
        rule = "until must be a positive number of seconds"
        raise SceneError(f"scene '{name}': {rule}, not {until:g}")
    turn = 2 * np.pi / fast if fast > 0 else 1.0
    least, most = (float(f"{turns * turn:.3g}") for turns in (LEAST_TURNS, MOST_TURNS))
    if not least <= until <= most:
        rule = f"{said} must be from {least:g} s to {most:g} s, at a rate of {fast:.3g} rad/s"
        raise SceneError(f"scene '{name}': {rule}, not {until:g}")
    return float(np.float32(until))


def followed_to_the_end(library: Library, given: Hardest, time: float, fast: float) -> Followed:
    """Return the states that the reference follows to their end, the hard ones first.

    Those beside the hardest are followed, all at once, where these have no end.
    """
    hard, both = given.hard, given.hard.joined(given.plain)
    first = [*range(min(HARD, len(hard))), *range(len(hard), len(both))]
    with TemporaryDirectory(prefix="derive-") as folder, ProcessPoolExecutor(WORKERS) as pool:
        work = partial(_one_end, library, time, fast, extrapolation_made(Path(folder)))
        found: dict[int, End | NoEndError]
        found = dict(zip(first, pool.map(work, map(both.values, first)), strict=True))
        if not all(isinstance(found[k], End) for k in first[:HARD]):
            more = range(HARD, len(hard))
            found |= dict(zip(more, pool.map(work, map(both.values, more)), strict=True))
    ended = {place: end for place, end in sorted(found.items()) if isinstance(end, End)}
    aside = Counter(error.why for error in found.values() if isinstance(error, NoEndError))
    if not ended:
        why = ", or ".join({**given.aside, **aside})
        rule = f"no motion of {time:g} s could be followed to its end: it {why}"
        raise SceneError(f"scene '{library.scene.name}': {rule}; give a shorter until")
    if given.unmet and not any(isinstance(found.get(k), End) for k in range(HARD)):
        aside = Counter({LOSES: given.unmet})  # none of them was measured, so that all are aside
    spent = sum(one.work for one in found.values())
    hardest_of_all = sum(k < len(hard) for k in ended)
    return Followed(both.at([*ended]), [*ended.values()], hardest_of_all, aside, spent)


def _one_end(
    library: Library, time: float, fast: float, made: Path | None, values: dict[str, float]
) -> End | NoEndError:
    """Return the true end of a motion, or what becomes of it instead."""
    try:
        return end_of(library, values, time, fast, made)
    except NoEndError as error:
        return error


def _attempts(
    driver: Driver, name: str, start: Begun, true: Ends, time: float, fast: float
) -> Iterator[Attempt]:
    """Yield a step's attempts, coarse to fine, until nothing is gained or it takes too long."""
    states = driver.library.vocabulary.states
    program, found = driver.library[name], list[float]()
    count = 1 if name == FLOW else power_above(time * fast / COARSEST)
    while not found or (name != FLOW and _gains(found) and _affordable(driver, program, count)):
        end = ended(driver, name, start, time, count)
        errors = tuple(errors_at_end(states, end, true).tolist())
        found.append(largest(errors))
        yield Attempt(name, driver.precision.name, time / count, count, errors)
        count *= 2


def _affordable(driver: Driver, program: Program, count: int) -> bool:
    if driver.shared is None:
        return count * len(program.ops) <= MOST_WORK["NumPy"]
    return count * price_of(program) <= MOST_WORK["C"]


def _gains(found: Sequence[float]) -> bool:
    """Tell whether shorter steps may still help, from the errors so far, coarse to fine."""
    if len(found) <= PATIENCE:
        return True
    before, after = min(found[:-PATIENCE]), min(found[-PATIENCE:])
    return before > USELESS or after < GAIN * before


def _smoothest(attempts: Sequence[Attempt]) -> Attempt:
    """Return what is used for slopes: the step of the highest order, else the least wrong."""
    own = [a for a in attempts if a.precision == F64.name]
    finest = [a for a in own if a.step == FINEST]
    return min(finest or own, key=lambda a: a.worst)


def floors_of(
    driver: Driver, start: Begun, time: float, by: Attempt
) -> dict[str, tuple[float, ...]]:
    """Return what rounding the given numbers makes of each end: u times all of their slopes.

    Each number is changed by 2^-26 of itself, and the motion taken again by the step and in as
    many as ``by`` took.
    """
    states = driver.library.vocabulary.states
    every = np.repeat(start.columns[:, :, None], 1 + len(start.names), axis=2)
    for k in range(len(start.names)):
        every[k, :, 1 + k] *= 1 + CHANGED
    for q in states:
        if q.is_quaternion:
            own = [start.names.index(c) for c in q.components]
            every[own] /= np.sqrt(np.sum(every[own] ** 2, axis=0))
    shape = every.shape[1:]
    moved = Begun(start.names, every.reshape(len(start.names), -1))
    end = ended(driver, by.step, moved, time, by.count).reshape(-1, *shape)
    total = np.zeros(len(start))
    for k in range(1, shape[1]):
        sizes = np.maximum(np.abs(end[:, :, 0]), 1e-300)
        true = Ends(end[:, :, 0], np.zeros_like(end[:, :, 0]), beside_what(states, sizes))
        total += errors_at_end(states, end[:, :, k], true) / CHANGED
    return {p.name: tuple((total * p.unit_roundoff).tolist()) for p in (F32, F64)}
