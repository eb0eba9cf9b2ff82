"""What `make report` does: run, write the page and the JSON, or print a part as a table."""

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from bench.report.case_run import Found
from bench.report.contradictions import contradictions
from bench.report.page import page
from bench.report.recall import merged, read, recalled
from bench.report.record import Report, data, text
from bench.report.run import Ask, made
from bench.report.written import figure
from derive.emit.files import require_writable, write
from derive.scene import SceneError

PAGE, DATA = "report.html", "report.json"
NEEDS = "the report needs matplotlib and SciPy: `pip install -e '.[bench]'`"
SHOWN = {
    "hard_cases": ("name", "naive", "naive_found", "naive_holds", "ours", "ours_found", "holds"),
    "orders": ("method", "case", "claimed", "measured", "points", "agrees"),
    "step_and_jacobian": ("author", "flops", "instructions", "missing"),
    "gyroscopic_term": ("form", "precision", "asphericity", "median", "largest"),
    "functions": ("scene", "name", "flops", "divisions", "instructions", "median", "largest"),
    "counts": ("scene", "function", "of", "count"),
    "proposals": ("case", "scene", "precision", "part", "passes", "error"),
    "targets": ("says", "limit", "measured", "reached"),
}


def report(out: Path, kind: str, only: Sequence[str], console: Console, progress: Progress) -> int:
    """Run the report; write it to ``out``, or print the parts named by ``only``.

    Returns 0, or 1 if a sentence is contradicted by the report's own figures.
    Raises ImportError with a sentence where the extra is not installed.
    """
    _require_extra()
    if not only:
        _require_place(out)
    with progress as shown:
        task = shown.add_task("report")
        found = made(Ask(kind, out, only, lambda what: shown.update(task, description=what)))
        if not only:
            shown.update(task, description="drawing")
            found = recalled(found)
            write(out, {PAGE: page(found), DATA: text(found)})
    if only:
        _print(found, console)
        return 0
    return _told(found, out, console)


def again(out: Path, kind: str, names: Sequence[str], console: Console, progress: Progress) -> int:
    """Write the report anew from its record, of which only the parts named are measured anew.

    Returns 0, or 1 if a sentence is contradicted by the report's own figures.
    Raises SceneError where there is no record, ImportError where the extra is not installed.
    """
    _require_extra()
    try:
        found = read((out / DATA).read_text(encoding="utf-8"))
    except (OSError, ValueError, LookupError, TypeError) as reason:
        raise SceneError(f"{out / DATA} is no record to write the report from: {reason}") from None
    _require_place(out)
    with progress as shown:
        task = shown.add_task("report")
        if names:
            ask = Ask(kind, out, names, lambda what: shown.update(task, description=what))
            found = merged(found, made(ask), names)
        shown.update(task, description="drawing")
        found = recalled(found)
        write(out, {PAGE: page(found), DATA: text(found)})
    return _told(found, out, console)


def _require_place(out: Path) -> None:
    out.mkdir(parents=True, exist_ok=True)
    require_writable(out / PAGE)


def _told(found: Report, out: Path, console: Console) -> int:
    """Print targets, and the sentences that the figures contradict; return 1 if there are any."""
    _print_targets(found, console)
    console.print(f"{out / PAGE}, {out / DATA}")
    wrong = contradictions(data(found))
    for sentence in wrong:
        console.print(f"contradicted by its own figures: {sentence}", highlight=False, markup=False)
    return 1 if wrong else 0


def _require_extra() -> None:
    try:
        import matplotlib as mpl
        import scipy
    except ImportError as absent:
        raise ImportError(f"{NEEDS} ({absent})") from absent
    del mpl, scipy


def _print(found: Report, console: Console) -> None:
    for one in found.found:
        console.print(points(one))
        for n in one.not_run:
            console.print(f"not run: {n.method} {n.precision}: {n.reason}", highlight=False)
    whole = data(found)
    for name, columns in SHOWN.items():
        if whole[name]:
            table = Table(*columns, box=None, title=name.replace("_", " "))
            for row in whole[name]:
                table.add_row(*(_cell(row[c]) for c in columns))
            console.print(table)


def _print_targets(found: Report, console: Console) -> None:
    table = Table("target", "limit", "measured", "", box=None)
    for t in found.targets:
        verdict = {None: "not measured", True: "reached", False: "NOT REACHED"}[t.reached]
        table.add_row(t.says, t.limit, t.measured, verdict)
    console.print(table)


def points(found: Found) -> Table:
    """Return the points of a case as a table."""
    names = ("method", "scene", "in", "step or tolerance", "passes", "Ir", "microseconds")
    errors = ("omega", "attitude", "energy", "momentum")
    table = Table(*names, *errors, box=None, title=f"{found.case.name}: {found.case.says}")
    for p in found.points:
        wrong = (p.wrong.omega, p.wrong.attitude, p.wrong.energy, p.wrong.momentum)
        cost = "" if p.instructions is None else f"{p.instructions:.0f}"
        setting = figure(p.value) if p.setting else ""
        passed = (p.method, p.scene, p.precision, setting, str(p.passes), cost)
        table.add_row(*passed, f"{p.seconds * 1e6:.4g}", *map(figure, wrong))
    return table


def _cell(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{k}: {_cell(v)}" for k, v in value.items())
    if isinstance(value, list):
        return " / ".join(_cell(v) for v in value)
    return figure(value) if isinstance(value, float) else str(value)
