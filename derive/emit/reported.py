"""What lies beside the pages of scenes and is made by other commands: reports, which pages lead to.

The sentence of a scene's own report stands on its page while it is of this scene.
"""

import json
from dataclasses import dataclass
from pathlib import Path

from derive.emit.c.source import sources_of
from derive.emit.on_target import UNKNOWN, OnTarget, kept, lies
from derive.library.digest import digest_of_programs
from derive.library.library import Library

REPORT_PAGE = "report.html"
"""What `make report` writes, of many cases beside peers."""


@dataclass(frozen=True)
class Beside:
    """What files of a scene can lead to or state.

    best    : the sentence of the scene's own report, "" where there is none
    reports : where the report of many cases lies, as seen from the output folder; none or one
    on_target : what functions cost on cores
    """

    best: str = ""
    reports: tuple[str, ...] = ()
    on_target: OnTarget = UNKNOWN


NOTHING_BESIDE = Beside()


def lying_beside(library: Library, folder: Path) -> Beside:
    """Return what lies below ``folder`` beside a scene's page."""
    name = library.scene.name
    costs = kept(folder, name, sources_of(library)) if lies(folder, name) else UNKNOWN
    return Beside(reported(library, folder), reports_in(folder), costs)


def reports_in(folder: Path) -> tuple[str, ...]:
    """Return the page of many cases that lies in ``folder``, if it does."""
    return (REPORT_PAGE,) if (folder / REPORT_PAGE).is_file() else ()


def reported(library: Library, folder: Path) -> str:
    """Return the sentence of the report that lies below ``folder``, "" if it is of others."""
    name = library.scene.name
    try:
        said = json.loads((folder / name / f"{name}_report.json").read_text(encoding="utf-8"))
        own = said["digest"] == digest_of_programs(library)
        best = said["best"]
    except (OSError, ValueError, LookupError, TypeError):
        return ""
    return best if own and isinstance(best, str) else ""
