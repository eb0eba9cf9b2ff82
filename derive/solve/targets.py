"""Generated C on its targets: built, run in emulators and measured; figures may be kept."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

from derive.check.target import Tried as Tried
from derive.check.target import tried_on
from derive.check.target.core import ALL, CORES, Core, require_tools
from derive.emit.c.source import sources_of
from derive.emit.files import write
from derive.emit.on_target import kept, path_of, to_text
from derive.scene.table import one_of
from derive.solve.handle import Handle, silent
from derive.solve.several import all_made, every, require_posed
from derive.solve.told import path

TARGETS = (*CORES, ALL)
"""The cores that C can be tried on, and the word for all of them."""


def on_targets(
    scenes: Sequence[Handle],
    target: str,
    keep_in: str | Path | None = None,
    told: Callable[[str], None] = silent,
) -> Iterator[Tried]:
    """Yield what each function of scenes does on a core, or on all of them.

    scenes  : none means the whole catalogue
    target  : one of TARGETS
    keep_in : the folder of generated files in which figures are kept, None for nowhere
    Raises DeriveError, before one is begun, where compilers or emulators are missing.
    """
    named = one_of(target, "target", TARGETS)
    cores = list(CORES.values()) if named == ALL else [CORES[named]]
    require_tools(cores)
    require_posed(scenes)
    folder = None if keep_in is None else path("folder", keep_in)
    runs = [(scene, core) for scene in every(scenes) for core in cores]
    found: dict[int, list[Tried]] = {}
    for place, rows in all_made([partial(_tried, *run) for run in runs]):
        found[place] = rows
        told(f"{len(found)} of {len(runs)} runs, {runs[place][0].name} on {runs[place][1].title}")
        first = place - place % len(cores)
        of_scene = [found.get(n) for n in range(first, first + len(cores))]
        if folder is not None and None not in of_scene:
            keep(runs[place][0], [row for some in of_scene for row in some or ()], cores, folder)
    for place in range(len(runs)):
        yield from found[place]


def _tried(scene: Handle, core: Core) -> list[Tried]:
    return tried_on(scene.library, core)


def keep(scene: Handle, rows: Sequence[Tried], cores: Sequence[Core], folder: Path) -> None:
    """Write the figures of a scene; those of other cores stay while they are of the same C.

    Nothing is kept of a core of which anything fails.
    """
    sources = sources_of(scene.library)
    failed = {row.core for row in rows if row.outcome == "FAILS"}
    new = [row.cost for row in rows if row.cost is not None and row.core not in failed]
    measured_now = {core.name for core in cores}
    old = [c for c in kept(folder, scene.name, sources).each if c.core not in measured_now]
    if not new:
        return
    order = [*CORES]
    costs = sorted((*old, *new), key=lambda cost: order.index(cost.core))
    file = path_of(folder, scene.name).relative_to(folder).as_posix()
    write(folder, {file: to_text(scene.name, costs, sources)})
