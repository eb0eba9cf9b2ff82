"""The files of a report, made in memory."""

from pathlib import Path

from derive.emit.reported import REPORT_PAGE
from derive.report.page import report_page
from derive.report.record import report_json
from derive.report.whole import SceneReport


def report_files(found: SceneReport, folder: Path) -> dict[str, str]:
    """Return the path below the output folder and the text of each file of a report.

    The page leads to those that lie there.
    """
    name = found.library.scene.name
    others = {
        "../index.html": "Scenes",
        f"{name}.html": name,
        f"../{REPORT_PAGE}": "Speed against error",
        "../lecture.html": "The lecture",
    }
    pages = {page: words for page, words in others.items() if (folder / name / page).is_file()}
    return {
        f"{name}/{name}_report.html": report_page(found, pages),
        f"{name}/{name}_report.json": report_json(found),
    }
