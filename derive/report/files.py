"""The files of a report, made in memory."""

from dataclasses import replace
from pathlib import Path

from derive.emit.on_target import OnTarget
from derive.emit.reported import REPORT_PAGE, lying_beside
from derive.report.page import report_page
from derive.report.record import report_json
from derive.report.whole import SceneReport
from derive.scene import argument


def report_files(found: SceneReport, folder: Path) -> dict[str, str]:
    """Return the path below the output folder and the text of each file of a report.

    The page leads to those that lie there, and states what is kept there of cores.
    """
    name = found.library.scene.name
    others = {
        "../index.html": "Scenes",
        f"{name}.html": name,
        f"../{REPORT_PAGE}": "Speed against error",
        "../lecture.html": "The lecture",
    }
    pages = {page: words for page, words in others.items() if (folder / name / page).is_file()}
    costs = lying_beside(found.library, folder).on_target
    found = replace(found, without=(*found.without, *unknown(argument(found.library.scene), costs)))
    return {
        f"{name}/{name}_report.html": report_page(found, pages, costs),
        f"{name}/{name}_report.json": report_json(found, costs),
    }


def unknown(scene: str, costs: OnTarget) -> tuple[str, ...]:
    """Return what is not known of a scene's functions on cores, and by which command it would be.

    scene : as commands are told
    """
    measured = "`derive check --target {} --keep {}` measures it"
    stale = tuple(
        f"{core}: what is kept is of other C; {measured.format(core, scene)}"
        for core in costs.stale
    )
    if costs.each or stale:
        return stale
    never = "a Cortex-M: nothing of this scene was run on one"
    return (f"{never}; {measured.format('m4f', scene)}",)
