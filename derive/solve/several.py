"""Several scenes at a time, or the whole catalogue: generated, or compared with what lies there."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeVar, get_args

from derive.check.eva import require_eva, shown_by_eva
from derive.check.verdict import Verdict
from derive.emit.files import Difference, differences, folders_left_over, require_folder
from derive.scene import SceneError, catalogue
from derive.scene.table import one_of
from derive.solve.generation import (
    STATED,
    Extent,
    FigureSource,
    Generation,
    Made,
    Telling,
    gallery_of,
    lecture_made,
    made_and_told,
    measuring,
    stored,
)
from derive.solve.handle import FRESH, Handle, silent
from derive.solve.loaded import load
from derive.solve.told import listener, met, path
from derive.verify.kept import Measuring

T = TypeVar("T")


@dataclass(frozen=True)
class Comparison:
    """How many files a scene or several become, which lie there otherwise, and what is doubted."""

    files: int
    differences: tuple[Difference, ...]
    warnings: tuple[str, ...]


def generate(
    scenes: Sequence[Handle],
    folder: str | Path,
    samples: int = STATED,
    figures: FigureSource = "kept",
    tell: Telling = "costs",
    told: Callable[[str], None] = silent,
    parts: Extent = "usual",
) -> Generation:
    """Write the files of scenes below a folder, several processes at a time.

    scenes  : none means the whole catalogue, with the lecture's page and the gallery
    samples : that each stated error is looked for at; 256 are quick
    figures : "kept" takes over those in ``folder`` that nothing has changed, "anew" measures all
    tell    : "savings" also says what was found not to matter to each answer
    told    : hears how far it is
    parts   : "casadi-external" adds C by which CasADi takes all steps of a horizon at once,
              "batch" C of functions over many members, "all" both
    Raises DeriveError for scenes of one name, for any that can have no programs, before one of
    them is measured, and for a folder that cannot be written to. Files are replaced all or none.
    """
    into = path("folder", folder)
    results = made_of(scenes, into, samples, figures, tell, told, parts)
    return stored(into, results, {} if scenes else gallery_of(results, into))


def compare(
    scenes: Sequence[Handle],
    folder: str | Path,
    samples: int = STATED,
    figures: FigureSource = "kept",
    told: Callable[[str], None] = silent,
    parts: Extent = "usual",
) -> Comparison:
    """Return how the files that lie below a folder differ from what ``generate`` would write."""
    into = path("folder", folder)
    results = made_of(scenes, into, samples, figures, "costs", told, parts)
    texts = {name: text for one in results for name, text in one.texts.items()}
    texts |= {} if scenes else gallery_of(results, into)
    found = list(differences(into, texts))
    found += [] if scenes else folders_left_over(into, texts)
    return Comparison(len(texts), tuple(found), tuple(w for one in results for w in one.warnings))


def made_of(
    scenes: Sequence[Handle],
    folder: str | Path,
    samples: int = STATED,
    figures: FigureSource = "kept",
    tell: Telling = "costs",
    told: Callable[[str], None] = silent,
    parts: Extent = "usual",
) -> list[Made]:
    """Return what ``generate`` would write, with what each function costs; write nothing."""
    _require_scenes(scenes)
    into, hears = path("folder", folder), listener(told)
    by = measuring(into, samples, figures)
    costs: Telling = "savings" if one_of(tell, "tell", get_args(Telling)) == "savings" else "costs"
    tasks: list[Callable[[], Made]] = [
        partial(_made, s, by, costs, into, parts) for s in every(scenes)
    ]
    return _of_all(scenes, into, tasks, hears)


def _require_scenes(scenes: object) -> None:
    """Refuse what is no list of scenes, of which an empty one means the whole catalogue."""
    if not isinstance(scenes, list | tuple):
        rule = "must be a list of what derive.load returns, empty for the whole catalogue"
        raise SceneError(f"scenes {rule}, not {met(scenes)}")
    strange = [scene for scene in scenes if not isinstance(scene, Handle)]
    if strange:
        raise SceneError(f"a scene is what derive.load returns, not {met(strange[0])}")


def every(scenes: Sequence[Handle]) -> tuple[Handle, ...]:
    """Return scenes, none meaning all of the catalogue."""
    return tuple(scenes) or tuple(map(load, catalogue()))


def _made(scene: Handle, by: Measuring, tell: Telling, reports: Path, parts: Extent) -> Made:
    return made_and_told(scene.library, by, tell, reports, parts)


def _posed(scene: Handle) -> None:
    _ = scene.library


def _of_all(
    scenes: Sequence[Handle],
    folder: Path,
    tasks: list[Callable[[], Made]],
    told: Callable[[str], None],
) -> list[Made]:
    """Return what scenes become, none meaning all of the catalogue and the lecture's page."""
    require_folder(folder)
    _require_distinct(scenes)
    require_posed(scenes)
    tasks = [*tasks, *([] if scenes else [partial(lecture_made, folder)])]
    found: dict[int, Made] = {}
    for place, result in all_made(tasks):
        found[place] = result
        told(f"{len(found)} of {len(tasks)} done")
    return [found[place] for place in sorted(found)]


def checked(
    scenes: Sequence[Handle],
    folder: str | Path,
    samples: int = FRESH,
    told: Callable[[str], None] = silent,
) -> Iterator[Verdict]:
    """Yield the verdicts on the files of scenes in their order, none meaning all of the catalogue.

    Raises DeriveError for any that can have no programs, before one is begun.
    """
    require_posed(scenes)
    if len(scenes) == 1:
        yield from scenes[0].check(folder, samples, told)
    else:
        yield from _in_order([partial(_checked, s, folder, samples) for s in every(scenes)], told)


def checked_by_eva(
    scenes: Sequence[Handle], told: Callable[[str], None] = silent
) -> Iterator[Verdict]:
    """Yield whether Frama-C's Eva finds run-time errors in the C of scenes, as ``checked`` does.

    Raises DeriveError where Frama-C is missing.
    """
    require_eva()
    require_posed(scenes)
    yield from _in_order([partial(_eva, scene) for scene in every(scenes)], told)


def _in_order(
    tasks: Sequence[Callable[[], list[Verdict]]], told: Callable[[str], None]
) -> Iterator[Verdict]:
    found: dict[int, list[Verdict]] = {}
    for place, verdicts in all_made(tasks):
        found[place] = verdicts
        told(f"{len(found)} of {len(tasks)} scenes")
    for place in range(len(tasks)):
        yield from found[place]


def _eva(scene: Handle) -> list[Verdict]:
    return list(shown_by_eva(scene.library))


def _checked(scene: Handle, folder: str | Path, samples: int) -> list[Verdict]:
    return list(scene.check(folder, samples))


def require_posed(scenes: Sequence[Handle]) -> None:
    """Refuse any of several scenes that can have no programs, before one of them is measured."""
    if len(scenes) > 1:
        for _ in all_made([partial(_posed, scene) for scene in scenes]):
            pass


def _require_distinct(scenes: Sequence[Handle]) -> None:
    """Refuse two scenes of one name: their files would lie over each other."""
    named: dict[str, str] = {}
    for scene in scenes:
        if scene.name in named:
            raise SceneError(
                f"scenes must have names of their own, but '{named[scene.name]}' and "
                f"'{scene.source}' are both '{scene.name}'"
            )
        named[scene.name] = scene.source


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
