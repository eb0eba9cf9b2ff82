"""The report of a scene: all that is measured of it, and the sentence that says it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from multiprocessing import Pool
from pathlib import Path
from tempfile import TemporaryDirectory

from derive.check.compiler import HOW_TO_GET_ONE
from derive.library.digest import digest_of_programs
from derive.library.library import Library
from derive.program.precision import PRECISIONS
from derive.program.program import Program
from derive.report.courses import StepErrors, Tell, step_errors
from derive.report.driver import Driver, drivers
from derive.report.found import FunctionFigures, found_of, functions_of
from derive.report.hard import HardCase
from derive.report.instructions import WITHOUT, Instructions, instructions
from derive.report.machine import Machine, machine_here
from derive.report.price import FEWEST, STEPS, Nanoseconds, nanoseconds
from derive.report.sentence import choice, functions_sentence, motion_sentence, said_of
from derive.report.states import Begun
from derive.report.wishes import OTHER_FORM, Wished, in_other_form, wished
from derive.scene import SceneError

Posed = tuple[Driver, str, Sequence[Program], Begun | None, Mapping[str, float]]
"""Functions to be timed, with their form, and where and how far their steps go, by name."""
NO_MOTION = "nothing of it moves by itself: a step in time has nothing to do"


@dataclass(frozen=True)
class SceneReport:
    """What was found of a scene.

    refused  : why steps cannot be wanted, by name     motion : None where there is none
    without  : what was not measured, and why          machine : what ran it
    """

    library: Library
    digest: str
    wished: Wished
    motion: StepErrors | None
    figures: tuple[FunctionFigures, ...]
    hard: tuple[HardCase, ...]
    times: tuple[Nanoseconds, ...]
    instructions: tuple[Instructions, ...]
    without: tuple[str, ...]
    machine: Machine

    @cached_property
    def best(self) -> str:
        """Return the sentence of the report, free of measured times."""
        if self.motion is not None:
            return motion_sentence(self.motion)
        return functions_sentence(self.figures)

    @cached_property
    def sentence(self) -> str:
        """Return the sentence of the report with the times that were measured."""
        if self.motion is None:
            return self.best
        own = {(t.function, t.precision): t.median for t in self.times}
        return motion_sentence(self.motion, own)


def silent(_: str) -> None:
    """Say nothing of what is being done."""


def report(library: Library, until: float | None = None, tell: Tell = silent) -> SceneReport:
    """Return the report of a scene: its steps and functions, their errors and what they cost.

    until : s, the end at which errors of motion are taken; None for its horizon or what suits it
    tell  : hears what is being done
    Raises SceneError for a time that has no sense or a motion that cannot be followed.
    """
    tell("what else the scene could want")
    with Pool(1) as beside, TemporaryDirectory(prefix="derive-") as folder:
        awaited = beside.apply_async(in_other_form, (library.scene,))
        own, other = wished(library), awaited.get()
        functions = beside.apply_async(found_of, (library, other))
        motion, by = _of_motion(own, until, Path(folder), tell)
        tell("errors and hard cases of functions")
        figures, hard = functions.get()
        every = _posed(own, other, by, motion, Path(folder))
        tell("timing")
        times = [t for one in every for t in nanoseconds(*one)]
        tell("counting instructions")
        counts = [c for one in every for c in instructions(*one, Path(folder))]
    return SceneReport(
        library, digest_of_programs(library), own, motion, figures, hard, tuple(times),
        tuple(counts), without(times, counts), machine_here(),
    )  # fmt: skip


def _of_motion(
    own: Wished, until: float | None, folder: Path, tell: Tell
) -> tuple[StepErrors | None, list[Driver]]:
    """Return what is found of steps, None if there is none, and what runs them."""
    scene = own.library.scene
    said = "horizon" if until is None else "until"
    if (until or scene.horizon) is not None and not own.steps:
        raise SceneError(f"scene '{scene.name}': {said} is of motion, but {NO_MOTION}")
    tell("compiling")
    by = drivers(own.library, PRECISIONS, folder)
    return (step_errors(own, by, until, tell) if own.steps else None), by


def _posed(
    own: Wished,
    other: Library | None,
    by: Sequence[Driver],
    motion: StepErrors | None,
    folder: Path,
) -> list[Posed]:
    """Return what is timed and counted: the functions of each form in each precision."""
    form = own.library.scene.form
    start = None if motion is None else motion.start.at([-1])
    programs = (*(own.library[name] for name in own.steps), *functions_of(own.library))
    every: list[Posed] = [
        (driver, form, programs, start, lengths_of_use(motion, driver.precision.name))
        for driver in by
    ]
    if other is not None and by[0].shared is not None:
        more = drivers(other, PRECISIONS, folder)
        every += [(one, OTHER_FORM[form], functions_of(other), None, {}) for one in more]
    return every


def lengths_of_use(motion: StepErrors | None, precision: str) -> dict[str, float]:
    """Return the length, s, at which each step is timed: the one that it would be used at.

    It is the one that keeps to the error that the report states, as far as the motion has steps
    enough for a batch of them; where none keeps to it, the shortest that a batch may have.
    """
    if motion is None:
        return {}
    target = said_of(motion).target
    chosen = {step: choice(motion, step, precision, target) for step in motion.costs}
    counts = {step: STEPS if c is None else c.attempt.count for step, c in chosen.items()}
    return {step: motion.time / min(max(n, FEWEST), STEPS) for step, n in counts.items()}


def without(times: Sequence[Nanoseconds], counts: Sequence[Instructions]) -> tuple[str, ...]:
    """Return what was not measured, and why."""
    slow = [] if times else [f"nanoseconds: not measured, {HOW_TO_GET_ONE}"]
    uncounted = [] if counts or not times else [WITHOUT]
    return (*slow, *uncounted)
