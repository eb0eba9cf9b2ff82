"""A scene that was loaded, with all that can be done with it; what was made once is kept."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache, partial, reduce
from pathlib import Path
from typing import Any

from derive.check import check
from derive.check.verdict import Verdict
from derive.emit.equations import FORMS, equations
from derive.emit.files import require_folder, require_writable, write
from derive.library.library import Library, library
from derive.program.program import Quantity
from derive.report import SceneReport, report, report_files
from derive.scene import Scene, SceneError, parse_scene
from derive.scene.table import one_of
from derive.scene.unit import behind
from derive.solve.answers import Answered, every_answer, motions_around, small_motion_of
from derive.solve.arguments import one_number
from derive.solve.bound import Accuracy, By, bound, evaluation, kernel_of, program_of
from derive.solve.function import Kernel, SceneFunction
from derive.solve.generation import (
    STATED,
    Extent,
    FigureSource,
    Generation,
    made_and_told,
    measuring,
    page_anew,
    samples_of,
    stored,
)
from derive.solve.instrument import Instrument, instrument
from derive.solve.motions import limits, roots
from derive.solve.settings import NamedValues, settable, settings
from derive.solve.simulation import Simulation, plot_of, simulated
from derive.solve.sweep import Ensemble, Request, ToldOfSweep, swept_and_shown, unheard
from derive.solve.told import listener, met, path, require_another_file
from derive.verify.reference import NoValueError

KEPT = 64
"""Scenes that are kept ready, those that were asked for last."""
FRESH = 4096
"""Samples that take a second a scene; a release is tried with a million."""
STEP = 1e-3  # s
Alterations = tuple[Callable[[Library], Library], ...]


def silent(_: str) -> None:
    """Hear how far something is, and say nothing."""


@dataclass(frozen=True, repr=False, eq=False)
class Handle:
    """A scene that was read: everything else is derived when it is first asked for, and kept.

    Values are given by name, in SI units: {"m": 1200, "omega": [0, 0, 3]}, or {"omega_z": 3} by
    component. What is refused is refused by a DeriveError, with the sentence of the command line.

    scene : what was declared         source : what it was loaded by
    changes : what is made of its programs: parameters fixed, ranges tried
    """

    scene: Scene
    source: str
    kernels: dict[tuple[str, str, str], Kernel] = field(default_factory=dict)
    changes: Alterations = ()

    @property
    def name(self) -> str:
        """Return what the scene is called: its files and C symbols begin with it."""
        return self.scene.name

    @property
    def title(self) -> str:
        """Return the scene's own title."""
        return self.scene.title

    @property
    def wanted(self) -> tuple[str, ...]:
        """Return the functions that the scene asks for."""
        return self.scene.wanted

    @property
    def quantities(self) -> tuple[Quantity, ...]:
        """Return everything that may be given a value: shape, unit, range and meaning of each."""
        return self.library.vocabulary.given()

    @cached_property
    def library(self) -> Library:
        """Return the programs of the scene. Raises DeriveError if there can be none."""
        return reduce(lambda made, change: change(made), self.changes, library(self.scene))

    @cached_property
    def _instrument(self) -> Instrument:
        return instrument(self.library)

    def function(
        self,
        name: str,
        parameters: Mapping[str, float] | None = None,
        precision: Accuracy = "double",
        by: By = "any",
    ) -> SceneFunction:
        """Return a wanted function of the scene, for NumPy arrays.

        name       : as in ``wanted``; ``..._jacobian_dense`` returns the whole matrix
        parameters : values that hold for all calls; others are named in each
        precision  : "float" computes as the C in float does, which CasADi cannot
        by         : "any" is a C compiler, where there is one, and CasADi elsewhere: the same bits
        Raises DeriveError for a name that the scene does not want, for parameters that it does not
        have or that set-up refuses, and if a compiler is needed and there is none.
        """
        of = program_of(self.library, name)
        key = (name, *evaluation(self.name, precision, by))
        if key not in self.kernels:
            self.kernels[key] = kernel_of(self.library, of, lambda: self._instrument.module, *key)
        again = partial(self.function, name, precision=precision, by=by)
        given = {} if parameters is None else parameters
        return bound(self.library, of, name, self.kernels[key], given, again)

    def solve(self, values: NamedValues) -> Answered:
        """Return all that the values let the scene answer, roots and frequencies among it.

        Raises DeriveError for values that make no sense or have no answer.
        """
        return every_answer(self._instrument, self._settings(values))

    def roots(self, values: NamedValues, steady: str = "steady") -> list[dict[str, float]]:
        """Return the unknowns of every steady motion in the declared ranges.

        values : all that ``steady`` needs but its unknowns; of several, ``steady_NAME``
        """
        return roots(self._instrument, self._settings(values), steady)

    def frequencies(self, values: NamedValues) -> list[float]:
        """Return the circular frequencies of small motion, rising, in rad/s."""
        return small_motion_of(self._instrument, self._settings(values)).frequencies

    def growth(self, values: NamedValues) -> float:
        """Return the fastest growth of small motion, in 1/s; 0 if it is no more than rounding."""
        return small_motion_of(self._instrument, self._settings(values)).growth

    def limits(self, values: NamedValues, name: str) -> list[float]:
        """Return the values of one quantity, in its range, at which stability changes."""
        if not isinstance(name, str):
            raise SceneError(f"scene '{self.name}': a limit is of a name, not {met(name)}")
        q = settable(self.name, self.quantities, name)
        if name not in q.components:
            says = f"the limit of one component is found, of {', '.join(q.components)}"
            raise SceneError(f"scene '{self.name}': {says}, not of {name}")
        return limits(self._instrument, self._settings(values), name, motions_around)

    def doubts(self, values: NamedValues) -> tuple[str, ...]:
        """Return warnings about values: inertias that no masses have, motions off equilibrium."""
        return self._instrument.doubts(self._settings(values))

    def simulate(
        self, values: NamedValues, until: float, step: float = STEP,
        plot: str | Path | None = None, stop: str | None = None, by: str = "step_rk4",
    ) -> Simulation:  # fmt: skip
        """Return the motion from the state in ``values``, other inputs held.

        until : s, the end        step : s, at most the length of a step, all being equal
        plot  : a file that the motion is drawn to, as SVG
        stop  : an equation such as "theta = 0", at which the motion ends if it comes before
        by    : the step, one of those that the scene wants
        """
        file = None if plot is None else path("plot", plot)
        if file is not None:
            require_another_file(file, self.scene.text)
            require_writable(file)
        motion = simulated(self._instrument, self._settings(values), until, step, stop, by)
        if file is not None:
            write(file.parent, {file.name: plot_of(motion)})
        return motion

    def sweep(
        self, vary: Mapping[str, str], folder: str | Path, until: float, keep: Sequence[str],
        values: NamedValues | None = None, samples: float = 1, stop: str | None = None,
        error: float | None = None, step: float | None = None, seed: int = 0, instants: int = 20,
        pairs: int = 0, workers: int | None = None, scheduler: str | None = None,
        chunk: int | None = None, near: float | None = None, told: ToldOfSweep = unheard,
    ) -> Ensemble:  # fmt: skip
        """Move very many members, each with its own numbers, and keep what becomes of them.

        vary    : how components scatter: {"m": "uniform(1, 2)", "theta": "0..1:11"}
        folder  : for results, as Parquet; a sweep that was stopped goes on there
        keep    : "theta", a course at so many ``instants``, "theta@end", "@max", "@min", "@2.5"
        values  : what does not vary      samples : draws, at each point of the grids if any
        error   : that the length of the step is to keep to, or ``step``, s, is told
        pairs   : of points that sensitivities are estimated from, a power of two, or 0
        near    : parts of its range, by which a start is moved at most onto constraints (0.5)
        workers : processes here, or ``scheduler``, the address of one of Dask's
        """
        own = self._settings({} if values is None else values)
        asked = Request(vary, samples, until, keep, stop, error, step, seed, instants, pairs,
                        workers, scheduler, chunk, near)  # fmt: skip
        into = path("folder", folder)
        listener(told)
        return swept_and_shown(self._instrument, self.source, own, asked, into, told)

    def generate(
        self,
        folder: str | Path,
        samples: int = STATED,
        figures: FigureSource = "kept",
        parts: Extent = "usual",
    ) -> Generation:
        """Write the scene's C, CasADi, JSON and HTML below a folder, proved and measured.

        samples : that each stated error is looked for at; 256 are quick
        figures : "kept" takes over those in ``folder`` that nothing has changed, "anew" measures
        parts   : "casadi-external" adds C by which CasADi takes all steps of a horizon at once,
                  "batch" C of functions over many members, "all" both
        Raises DeriveError for a scene whose ranges hold a pole, and for a folder that cannot be
        written to. Files are replaced all or none.
        """
        require_folder(into := path("folder", folder))
        by = measuring(into, samples, figures)
        return stored(into, [made_and_told(self.library, by, "costs", into, parts)], {})

    def report(
        self,
        folder: str | Path,
        until: float | None = None,
        told: Callable[[str], None] = silent,
    ) -> SceneReport:
        """Measure the scene's speed against error, and write its page and JSON below a folder.

        The scene's own page, if it lies there, is made anew: it shows the sentence of the report.

        until : s, the end of the motions; None for the scene's horizon, or about ten turns
        told  : hears what is being done
        Raises DeriveError for a time that has no sense, and for a motion without an end.
        """
        into = path("folder", folder)
        require_folder(into)
        end = None if until is None else one_number(f"scene '{self.name}'", "until", until)
        found = report(self.library, end, listener(told))
        write(into, report_files(found, into))
        write(into, page_anew(self.library, into))
        return found

    def check(
        self, folder: str | Path, samples: int = FRESH, told: Callable[[str], None] = silent
    ) -> Iterator[Verdict]:
        """Yield what compiling and comparing finds of the scene's files, made anew.

        folder  : where files may lie, which must be those       told : hears how far it is
        samples : fresh ones that stated errors are tried at
        Raises DeriveError if there is no C compiler.
        """
        return self._checked(path("folder", folder), samples_of(samples), listener(told))

    def _checked(
        self, folder: Path, samples: int, told: Callable[[str], None]
    ) -> Iterator[Verdict]:
        try:
            yield from check(self.library, self.source, folder, samples, told)
        except NoValueError as error:
            raise SceneError(str(error)) from None

    def equations(self, form: str = "text") -> str:
        """Return the scene's equations: the lecture's law, what it becomes here, its solution.

        form : "text" or "ascii", for a terminal; "latex", a document; "sympy", a module of Python
        Raises DeriveError for any other form.
        """
        return equations(self.library, one_of(form, "form", FORMS))

    def _settings(self, values: NamedValues) -> dict[str, float]:
        return settings(self.name, self.quantities, values)

    def __reduce__(self) -> Any:
        """Return how another process loads the same scene, by its text."""
        return handle, (self.scene.text, self.name, self.source, self.changes)

    def __repr__(self) -> str:
        """Return what the scene is, what it wants, and what may be given to it."""
        own = [("parameter", q.name, q.unit, q.meaning) for q in self.scene.parameters
               if q.value is None]  # fmt: skip
        own += [(q.kind, q.name, q.unit, q.meaning) for q in self.scene.moving]
        wide = max((len(name) for _, name, _, _ in own), default=0)
        rows = [f"  {what:10} {name:{wide}}{behind(unit)}  {says}".rstrip()
                for what, name, unit, says in own]  # fmt: skip
        wanted = ", ".join(self.wanted)
        return "\n".join([f"scene '{self.name}': {self.title}", f"  functions {wanted}", *rows])


@lru_cache(KEPT)
def handle(text: str, name: str, source: str, changes: Alterations) -> Handle:
    """Return the scene that a text declares; the same text is read once."""
    scene = parse_scene(text, name)
    if scene.text != text:
        return handle(scene.text, name, source, changes)
    return Handle(scene, source, changes=changes)
