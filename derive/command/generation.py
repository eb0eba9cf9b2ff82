"""From scenes to their texts: read, arranged, proved, measured and printed, several at a time."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, replace
from functools import partial
from math import isfinite
from typing import TypeVar

from derive.emit.files import scene_files
from derive.emit.gallery.card import Card, card, gallery
from derive.emit.page.lecture import lecture_page
from derive.library.library import Library, library
from derive.library.saving import Saving, savings
from derive.program.program import Measurement
from derive.scene import SceneError, load
from derive.verify.kept import Measuring, figures_of
from derive.verify.prove import prove
from derive.verify.reference import NoValueError

T = TypeVar("T")
LECTURE_PAGE = "lecture.html"
GALLERY_PAGE = "index.html"


@dataclass(frozen=True)
class CostRow:
    """What one function costs and how wrong it is: operations, then median and largest errors."""

    scene: str
    function: str
    flops: int
    divisions: int
    errors: tuple[str, ...]


@dataclass(frozen=True)
class Made:
    """The texts of a scene's files, what its reader should be told, and its costs."""

    texts: dict[str, str]
    warnings: tuple[str, ...]
    costs: tuple[CostRow, ...]
    savings: tuple[Saving, ...] = ()
    card: Card | None = None


def made(source: str, measuring: Measuring) -> Made:
    """Return everything that a scene becomes; its programs are proved before they are printed."""
    return _made(library(load(source)), measuring)


def made_with_savings(source: str, measuring: Measuring) -> Made:
    """Return everything that a scene becomes, and what its functions were spared."""
    programs = library(load(source))
    return replace(_made(programs, measuring), savings=tuple(savings(programs)))


def require_posed(scenes: Sequence[str]) -> None:
    """Refuse any of several scenes that can have no programs, before one of them is measured."""
    if len(scenes) > 1:
        for _ in all_made([partial(_posed, source) for source in scenes]):
            pass


def _posed(source: str) -> None:
    library(load(source))


def _made(programs: Library, measuring: Measuring) -> Made:
    scene = programs.scene
    try:
        prove(programs)
        measured = figures_of(programs, measuring)
    except NoValueError as error:
        rule = "formulas must have a value on all of the declared ranges"
        why = scene.merging or _poles(programs) or str(error)
        raise SceneError(f"scene '{scene.name}': {rule}, but {why}") from None
    _finite(programs, measured.each)
    warnings = tuple(f"scene '{scene.name}': {warning}" for warning in programs.mechanism.doubts())
    texts = scene_files(programs, measured.each, measured.digest)
    return Made(texts, warnings, cost_rows(programs, measured.each), card=card(programs))


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
                f"but {_poles(programs) or f'the error of {m.output} is {m.worst}'}"
            )


def lecture_made() -> Made:
    """Return the lecture's page."""
    return Made({LECTURE_PAGE: lecture_page()}, (), ())


def gallery_of(results: Sequence[Made]) -> dict[str, str]:
    """Return the gallery of all scenes that were made."""
    return {GALLERY_PAGE: gallery([r.card for r in results if r.card is not None])}


def cost_rows(programs: Library, measured: Sequence[Measurement]) -> tuple[CostRow, ...]:
    """Return one row a function."""
    name = programs.scene.name
    return tuple(
        CostRow(name, p.name, p.flops(), p.count.get("div", 0), _errors(p.name, measured))
        for p in programs.printed()
    )


def _errors(function: str, measured: Sequence[Measurement]) -> tuple[str, ...]:
    found: list[str] = []
    for precision in ("f32", "f64"):
        own = [m for m in measured if (m.function, m.precision) == (function, precision)]
        found += [f"{max(m.median for m in own):.2g}", f"{max(m.worst for m in own):.2g}"]
    return tuple(found)


def all_made(tasks: Sequence[Callable[[], T]]) -> Iterator[tuple[int, T]]:
    """Yield place and result of every task, as they are done; after a refusal none is begun."""
    if len(tasks) == 1:
        yield 0, tasks[0]()
        return
    with ProcessPoolExecutor() as pool:
        waiting = {pool.submit(task): place for place, task in enumerate(tasks)}
        try:
            for future in as_completed(waiting):
                yield waiting[future], future.result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
