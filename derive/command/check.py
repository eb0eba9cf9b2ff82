"""``derive check``: the emitted files, compiled and compared; here, or on emulated cores."""

import argparse
from collections.abc import Sequence

from rich.table import Table

import derive
from derive.command.parsed import word_of
from derive.command.scenes import samples_argument, scene_argument
from derive.command.terminal import OUT, console, print_rows, progress
from derive.solve.handle import FRESH, Handle
from derive.solve.several import checked, checked_by_eva
from derive.solve.targets import TARGETS, Tried, on_targets

WIDTH = 100
"""Columns of the table of costs, also where more are free."""


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive check``."""
    scene_argument(command)
    samples_argument(command, FRESH, "fresh samples that stated errors are tried at")
    command.add_argument(
        "--target",
        type=word_of(TARGETS),
        choices=TARGETS,
        help="run the C on an emulated core instead: the bits of this machine, and what it costs",
    )
    command.add_argument(
        "--keep",
        action="store_const",
        const=OUT,
        help="keep what it costs on the core for the comments, JSON and pages of `derive generate`",
    )
    command.add_argument(
        "--eva",
        action="store_true",
        help="let Frama-C's Eva look for run-time errors in the C instead: what is infinite or no"
        " number, divisions by zero, places outside of arrays",
    )
    command.set_defaults(run=check)


def check(given: argparse.Namespace) -> int:
    """Compile the emitted files and compare them with ball arithmetic and with each other."""
    scenes = [derive.load(source) for source in given.scenes]
    other = "--target" if given.target else "--eva" if given.eva else ""
    if other and given.samples != FRESH:
        raise derive.DeriveError(f"check: --samples does not go with {other}")
    if given.target:
        if given.eva:
            raise derive.DeriveError("check: --eva does not go with --target")
        return _on_target(scenes, given)
    if given.keep:
        raise derive.DeriveError(f"check: --keep needs --target, {' or '.join(TARGETS)}")
    table = Table("scene", "function", "in", "check", "verdict", "found", box=None)
    found: list[str] = []
    with progress() as shown:
        task = shown.add_task("Eva" if given.eva else "finding a compiler")

        def told(says: str) -> None:
            shown.update(task, description=says)

        every = (
            checked_by_eva(scenes, told) if given.eva else checked(scenes, OUT, given.samples, told)
        )
        for v in every:
            found.append(v.outcome)
            if len(scenes) == 1:
                told(f"{v.scene}: {v.function} ({len(found)} checks)")
            table.add_row(v.scene, v.function, v.precision, v.check, v.outcome, v.says)
    print_rows(table)
    return _counted(found)


def _counted(found: Sequence[str]) -> int:
    failed, skipped = found.count("FAILS"), found.count("skipped")
    console.print(f"{found.count('holds')} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0


def _on_target(scenes: Sequence[Handle], given: argparse.Namespace) -> int:
    """Run the C of scenes on a core, and print what its functions cost there."""
    with progress() as shown:
        task = shown.add_task("building")
        rows = list(
            on_targets(
                scenes, given.target, given.keep, lambda says: shown.update(task, description=says)
            )
        )
    table = Table(box=None, padding=(0, 1), collapse_padding=True)
    table.add_column("function", overflow="fold")
    for name in ("core", "in", "bits"):
        table.add_column(name, no_wrap=True)
    for name in ("instructions", "code", "tables", "stack"):
        table.add_column(name, justify="right", no_wrap=True)
    scene = ""
    for row in rows:
        if row.scene != scene:
            scene = row.scene
            table.add_row(scene, style="bold")
        figures = row.cost.figures if row.cost else ("", "", "", "")
        table.add_row(f"  {row.function}", row.core, row.precision, row.outcome, *figures)
    print_rows(table, min(WIDTH, console.width))
    for says, named in _reasons(rows).items():
        console.print(f"{named}: {says}", highlight=False, soft_wrap=True)
    console.print(
        "instructions of a call, in the emulator; bytes of code, tables and stack, without those of"
        " the C library and libgcc in code",
        highlight=False,
    )
    return _counted([row.outcome for row in rows])


def _reasons(rows: Sequence[Tried]) -> dict[str, str]:
    """Return why rows fail or are skipped, each reason once, with the rows that it is of."""
    found: dict[str, list[str]] = {}
    for row in rows:
        if row.says:
            found.setdefault(row.says, []).append(f"{row.scene} {row.function} in {row.precision}")
    return {
        says: f"{named[0]} and {len(named) - 1} more" if len(named) > 1 else named[0]
        for says, named in found.items()
    }
