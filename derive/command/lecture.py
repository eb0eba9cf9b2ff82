"""``derive lecture``: the derivation, verified step by step or tried without an assumption."""

import argparse
from difflib import get_close_matches

from rich.table import Table

from derive.command.terminal import console, print_rows, progress
from derive.emit.notation import expression_text
from derive.lecture.chapters import LECTURE
from derive.lecture.step import first_fall, verify
from derive.scene import SceneError


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive lecture``."""
    command.add_argument(
        "--without",
        metavar="REASON",
        help="drop one assumption; show the first step that falls and what is left over",
    )
    command.set_defaults(run=lecture)


def lecture(given: argparse.Namespace) -> int:
    """Verify every step and print the table; or drop one assumption and show what falls."""
    return _verified() if given.without is None else _without(given.without)


def _verified() -> int:
    with progress() as shown:
        shown.add_task("verifying the lecture")
        rows = tuple(verify(LECTURE))
    table = Table("step", "kind", "because of", "checked", box=None)
    for row in rows:
        verdict = "holds" if row.holds else f"FAILS: {row.fault}"
        table.add_row(row.name, row.kind, ", ".join(row.reasons), verdict)
    print_rows(table)
    fallen = sum(not row.holds for row in rows)
    deduced = sum(row.kind == "deduce" for row in rows)
    seconds = sum(row.seconds for row in rows)
    console.print(f"{len(rows)} steps, {deduced} deduced, {fallen} failed, {seconds:.1f} s")
    return 1 if fallen else 0


def _without(reason: str) -> int:
    known = [step.name for step in LECTURE.steps if step.kind == "assume"]
    if reason not in known:
        near = get_close_matches(reason, known, n=1)
        hint = "; its page lists them, and `derive lecture` calls each assume"
        hint = f"; did you mean '{near[0]}'?" if near else hint
        raise SceneError(f"--without needs an assumption of the lecture, not '{reason}'{hint}")
    fall = first_fall(LECTURE, reason)
    if fall is None:
        console.print(f"Nothing in the lecture falls without '{reason}'.")
        return 0
    step, leftover = fall
    console.print(f"Without '{reason}' the first step that falls is '{step.name}': {step.says}")
    console.print(f"What is left over: {expression_text(leftover)}", highlight=False, markup=False)
    return 0
