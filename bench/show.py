"""What `make bench` prints and writes: one row an author and problem, and the same as JSON."""

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from bench.build import versions
from bench.contest import COLUMNS, Entry, authors, contest, overhead
from bench.problem import PROBLEMS, Problem
from bench.sample import SETS
from derive import __version__
from derive.emit.files import write

SAMPLES_IN_A_SET = 1000


def bench(generated: Path, out: Path | None, console: Console, progress: Progress) -> int:
    """Run every author on every problem, print the table, write the figures; return 0.

    generated : folder of our own files      out : file for the figures, None for none
    """
    who = authors(generated)
    entries: list[Entry] = []
    with progress, TemporaryDirectory() as folder:
        total = sum(len(author.problems) for author in who)
        task = progress.add_task("bench", total=total)
        loop = overhead(Path(folder))
        for entry in contest(who, PROBLEMS, SAMPLES_IN_A_SET, Path(folder)):
            entries.append(entry)
            progress.update(task, advance=1, description=f"{entry.problem}: {entry.author}")
    console.print(table(entries, PROBLEMS))
    console.print(caption(loop), highlight=False)
    for line in missing(entries):
        console.print(line, highlight=False, markup=False)
    if out is not None:
        write(out.parent, {out.name: figures(entries, loop)})
    return 0


def table(entries: Sequence[Entry], problems: Sequence[Problem]) -> Table:
    """Return the figures as a table, one section a problem."""
    shown = Table("problem", "by", box=None)
    for name in ("+ - * /", "div", "sin cos", *(f"Ir {c.name}" for c in COLUMNS), *SETS):
        shown.add_column(name, justify="right")
    for problem in problems:
        for place, entry in enumerate(e for e in entries if e.problem == problem.name):
            shown.add_row(problem.says if place == 0 else "", entry.author, *cells(entry))
        shown.add_row()
    return shown


def cells(entry: Entry) -> tuple[str, ...]:
    """Return what an entry shows after its problem and author.

    >>> cells(Entry("A", "free_body", None, {}, {}, "not run: no compiler"))[:3]
    ('not run', '', '')
    """
    if entry.flops is None:
        return ("not run", *[""] * (2 + len(COLUMNS) + len(SETS)))
    trig = entry.flops.sin + entry.flops.cos + entry.flops.tan
    counts = (str(entry.flops.total), str(entry.flops.div), str(trig))
    cost = (_instructions(entry, c.name) for c in COLUMNS)
    errors = (_error(entry, kind) for kind in SETS)
    return (*counts, *cost, *errors)


def _instructions(entry: Entry, column: str) -> str:
    return f"{entry.instructions[column]:.0f}" if column in entry.instructions else ""


def _error(entry: Entry, kind: str) -> str:
    found = entry.accuracy.get(kind)
    return f"{found.middle:.2g} / {found.largest:.2g}" if found else ""


def caption(loop: float | None) -> str:
    """Return what the columns mean, with the measured cost of the loop around a call."""
    inside = f"of which {loop:.0f} for the loop around it" if loop else "no valgrind: not counted"
    return (
        f"Ir: instructions of one call (callgrind), {inside}. Errors: median / largest of "
        f"{SAMPLES_IN_A_SET} samples, norm of the worst output's error over its norm, in 2^-53."
    )


def missing(entries: Sequence[Entry]) -> list[str]:
    """Return a line for each author who could not be run, with the reason."""
    return list(dict.fromkeys(f"{e.author}: {e.missing}" for e in entries if e.missing))


def figures(entries: Sequence[Entry], loop: float | None) -> str:
    """Return the JSON of a run."""
    whole = {
        "generator": f"derive {__version__}",
        "tools": versions(),
        "loop_instructions": loop,
        "samples_in_a_set": SAMPLES_IN_A_SET,
        "unit_of_error": "2^-53 of the norm of the output",
        "entries": [as_data(entry) for entry in entries],
    }
    return json.dumps(whole, indent=1) + "\n"


def as_data(entry: Any) -> dict[str, Any]:
    """Return an entry of any contest as plain values, the total of its operations first."""
    flops = None if entry.flops is None else {"total": entry.flops.total, **asdict(entry.flops)}
    return {**asdict(entry), "flops": flops}
