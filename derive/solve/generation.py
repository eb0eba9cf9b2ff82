"""From the programs of a scene to its files: proved, measured, printed and written."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite
from pathlib import Path
from typing import Literal, get_args

from derive.check.emitted import SAMPLES, sampling_of
from derive.emit.c.comment import of_what
from derive.emit.c.members_file import OVER_MEMBERS as OVER_MEMBERS
from derive.emit.files import scene_files, unfinished, write
from derive.emit.gallery.card import Card, card, gallery
from derive.emit.page.lecture import GALLERY, lecture_page
from derive.emit.page.scene import scene_page
from derive.emit.reported import NOTHING_BESIDE, lying_beside, reports_in
from derive.library.external import CASADI as CASADI
from derive.library.external import derivatives_of_step
from derive.library.fixed import unstated_values
from derive.library.library import Library
from derive.library.saving import Saving, savings
from derive.program.precision import PRECISIONS
from derive.program.program import Measurement
from derive.scene import SceneError
from derive.scene.table import one_of
from derive.solve.told import count
from derive.verify.kept import Measuring, are_kept, figures_of
from derive.verify.prove import prove
from derive.verify.reference import NoValueError
from derive.verify.search import SAMPLING, sampled_at

FigureSource = Literal["kept", "anew"]
"""Whether stated errors are taken over from before, where nothing has changed."""
Extent = Literal["usual", "casadi-external", "batch", "all"]
"""Which files a scene becomes: the usual ones, or these and C that CasADi calls, or C of functions
over many members, or both."""
Telling = Literal["costs", "savings"]
"""What is said of functions beside their errors: what was found not to matter to answers, too."""
NUMBERS = SAMPLES
"""The numbers of samples that may be asked for."""
STATED = SAMPLING.samples
"""Samples that each stated error is looked for at."""
MANY = 1e4
"""u on the declared ranges of which a reader is warned: 4 of the 7 digits of a float are gone."""
EXTENTS: Mapping[str, tuple[str, ...]] = {
    "usual": (), CASADI: (CASADI,), OVER_MEMBERS: (OVER_MEMBERS,), "all": (CASADI, OVER_MEMBERS),
}  # fmt: skip
LECTURE_PAGE = "lecture.html"


@dataclass(frozen=True)
class CostRow:
    """What one function costs and how wrong it is.

    errors : in float and in double, in u of what ``of`` says: the median and the largest on the
             declared ranges, and the largest of all, at hard bodies and motions too
    """

    scene: str
    function: str
    flops: int
    divisions: int
    errors: tuple[tuple[float, float, float], ...]
    of: str


@dataclass(frozen=True)
class Made:
    """The texts of a scene's files, what its reader should be told, and its costs.

    stale : cores whose kept figures are not of the C that is made now
    """

    texts: dict[str, str] = field(repr=False)
    warnings: tuple[str, ...]
    costs: tuple[CostRow, ...]
    savings: tuple[Saving, ...] = ()
    card: Card | None = field(default=None, repr=False)
    stale: tuple[str, ...] = ()
    figures: tuple[Measurement, ...] = field(default=(), repr=False)


@dataclass(frozen=True)
class Generation:
    """Files that were written below a folder, and what is to be said of them.

    files   : their paths below ``folder``
    made    : of each scene its warnings, costs and savings, and its texts
    stopped : files that a run before this one was replacing when it was stopped
    left    : those of them that are still to be made
    """

    folder: Path
    files: tuple[str, ...]
    made: tuple[Made, ...] = field(repr=False)
    stopped: tuple[str, ...] = ()
    left: tuple[str, ...] = ()

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return what readers of the scenes should be told."""
        return tuple(warning for one in self.made for warning in one.warnings)


def extent_of(parts: Collection[str]) -> Extent:
    """Return which files a scene becomes with some parts more than the usual ones."""
    if OVER_MEMBERS in parts:
        return "all" if CASADI in parts else "batch"
    return "casadi-external" if CASADI in parts else "usual"


def measuring(folder: Path, samples: int, figures: FigureSource) -> Measuring:
    """Return how errors are come by: with so many samples, kept in ``folder`` or measured anew.

    Raises SceneError for a number of samples that is none.
    """
    kept = one_of(figures, "figures", get_args(FigureSource)) == "kept"
    return Measuring(sampled_at(samples_of(samples)), folder if kept else None)


def samples_of(value: object) -> int:
    """Return a number of samples. Raises SceneError for what is none."""
    return count("samples", value, SAMPLES)


def stored(folder: Path, made: Sequence[Made], more: Mapping[str, str]) -> Generation:
    """Write the texts of scenes, and others, below a folder, all or none.

    The lecture comes with them where it does not lie there: every page of a scene leads to it.
    """
    texts = {name: text for one in made for name, text in one.texts.items()} | dict(more)
    if LECTURE_PAGE not in texts and not (folder / LECTURE_PAGE).is_file():
        texts |= lecture_made(folder, [GALLERY] if (folder / GALLERY).is_file() else []).texts
    stopped = unfinished(folder)
    write(folder, texts)
    return Generation(folder, tuple(texts), tuple(made), stopped, unfinished(folder))


def page_anew(programs: Library, folder: Path) -> dict[str, str]:
    """Return the page of a scene whose files lie below a folder, as what lies beside it is now.

    Nothing where no page lies, or where the files are of a scene since changed.
    """
    name = programs.scene.name
    page = f"{name}/{name}.html"
    by = Measuring(sampling_of(folder, name), folder)
    if not (folder / page).is_file() or not are_kept(programs, by):
        return {}
    figures = figures_of(programs, by).each
    return {page: scene_page(programs, figures, lying_beside(programs, folder))}


def made_and_told(
    programs: Library, by: Measuring, tell: Telling, reports: Path, parts: Extent = "usual"
) -> Made:
    """Return everything that a scene becomes, with what its answers were spared if asked to.

    reports : the folder below which the scene's report may lie, whose sentence pages show
    """
    spared = tuple(savings(programs)) if tell == "savings" else ()
    return replace(made(programs, by, reports, parts), savings=spared)


def made(
    programs: Library, by: Measuring, reports: Path | None = None, parts: Extent = "usual"
) -> Made:
    """Return everything that a scene becomes; its programs are proved before they are printed.

    Raises SceneError for formulas without a value in the ranges, ProofError for a wrong program.
    """
    scene = programs.scene
    whole = EXTENTS[one_of(parts, "parts", get_args(Extent))]
    of = derivatives_of_step(programs) if CASADI in whole else None
    try:
        prove(programs)
        measured = figures_of(programs, by)
    except NoValueError as error:
        rule = "formulas must have a value on all of the declared ranges"
        why = scene.merging or _poles(programs) or str(error)
        raise SceneError(f"scene '{scene.name}': {rule}, but {why}") from None
    _finite(programs, measured.each)
    doubts = (*programs.mechanism.doubts(), *few_digits(measured.each), *unstated_values(programs))
    warnings = tuple(f"scene '{scene.name}': {warning}" for warning in doubts)
    lies = NOTHING_BESIDE if reports is None else lying_beside(programs, reports)
    texts = scene_files(programs, measured.each, measured.digest, lies, of, whole)
    costs, shown = cost_rows(programs, measured.each), card(programs, lies.best)
    stale, stated = lies.on_target.stale, tuple(measured.each)
    return Made(texts, warnings, costs, card=shown, stale=stale, figures=stated)


def _poles(programs: Library) -> str:
    """Return what a machine divides by that vanishes in its ranges, and where; "" if nothing."""
    return next(filter(None, map(programs.mechanism.pole, programs.problems)), "")


def _finite(programs: Library, measured: Sequence[Measurement]) -> None:
    """Refuse a scene whose declared ranges hold a pole or overflow one of the float types."""
    scene = programs.scene.name
    for m in measured:
        if not isfinite(m.worst):
            raise SceneError(
                f"scene '{scene}': ranges must keep '{m.function}' within {m.precision}, "
                f"but {_poles(programs) or _overflown(m)}"
            )


def _overflown(m: Measurement) -> str:
    aside = "a value on the way to it, in set-up too, is too large or too small"
    return f"the error of {m.output} is {m.worst}: {aside}"


def few_digits(measured: Sequence[Measurement]) -> Iterator[str]:
    """Yield what functions lose more digits on the declared ranges than anyone would think."""
    scalars = {p.name: p.scalar for p in PRECISIONS}
    worst = {m.function: m for m in sorted(measured, key=lambda m: m.within) if m.within > MANY}
    for m in worst.values():
        yield (
            f"{m.function}: rounding makes {m.output} wrong by up to {m.within:.2g} u in"
            f" {scalars[m.precision]}; `derive report` tells at which state, why, and what to do"
        )


def lecture_made(folder: Path, galleries: Sequence[str] = (GALLERY,)) -> Made:
    """Return the lecture's page, which leads to what lies in the folder that it is written to.

    galleries : the page of all scenes, if it is there or is made with it
    """
    return Made({LECTURE_PAGE: lecture_page(reports_in(folder), galleries)}, (), ())


def gallery_of(results: Sequence[Made], folder: Path) -> dict[str, str]:
    """Return the gallery of all scenes that were made, for the folder it is written to."""
    cards = [r.card for r in results if r.card is not None]
    return {GALLERY: gallery(cards, reports_in(folder))}


def cost_rows(programs: Library, measured: Sequence[Measurement]) -> tuple[CostRow, ...]:
    """Return one row a function."""
    name = programs.scene.name
    return tuple(
        CostRow(
            name,
            p.name,
            p.flops(),
            p.count.get("div", 0),
            tuple(_errors(p.name, precision, measured) for precision in ("f32", "f64")),
            of_what(p),
        )
        for p in programs.printed()
    )


def _errors(
    function: str, precision: str, measured: Sequence[Measurement]
) -> tuple[float, float, float]:
    """Return the largest median of the outputs of a function, and their largest errors."""
    own = [m for m in measured if (m.function, m.precision) == (function, precision)]
    return max(m.median for m in own), max(m.within for m in own), max(m.worst for m in own)
