"""``derive check``: the emitted files, compiled and compared."""

import argparse

from rich.table import Table

from derive.check import check as verdicts_on
from derive.command.generation import require_posed
from derive.command.scenes import samples_argument, scene_argument
from derive.command.terminal import OUT, console, progress
from derive.scene import catalogue

FRESH = 4096
"""Samples that take a second a scene; a release is tried with a million."""


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive check``."""
    scene_argument(command)
    samples_argument(command, FRESH, "fresh samples that stated errors are tried at")
    command.set_defaults(run=check)


def check(given: argparse.Namespace) -> int:
    """Compile the emitted files and compare them with ball arithmetic and with each other."""
    require_posed(given.scenes)
    table = Table("scene", "function", "in", "check", "verdict", "found", box=None)
    found: list[str] = []
    with progress() as shown:
        task = shown.add_task("finding a compiler")

        def told(says: str) -> None:
            shown.update(task, description=says)

        verdicts = verdicts_on(given.scenes or catalogue(), OUT, given.samples, told)
        for count, v in enumerate(verdicts, 1):
            shown.update(task, description=f"{v.scene}: {v.function} ({count} checks)")
            found.append(v.outcome)
            table.add_row(v.scene, v.function, v.precision, v.check, v.outcome, v.says)
    console.print(table)
    failed, skipped = found.count("FAILS"), found.count("skipped")
    console.print(f"{found.count('holds')} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0
