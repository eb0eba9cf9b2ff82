"""``derive check``: the emitted files, compiled and compared."""

import argparse

from rich.table import Table

from derive.check import check as verdicts_on
from derive.command.scenes import scene_argument
from derive.command.terminal import OUT, console, progress
from derive.scene import catalogue


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive check``."""
    scene_argument(command)
    command.set_defaults(run=check)


def check(given: argparse.Namespace) -> int:
    """Compile the emitted files and compare them with ball arithmetic and with each other."""
    table = Table("scene", "function", "in", "check", "verdict", "found", box=None)
    found: list[str] = []
    with progress() as shown:
        task = shown.add_task("finding a compiler")
        verdicts = verdicts_on(given.scenes or catalogue(), OUT)
        for count, v in enumerate(verdicts, 1):
            shown.update(task, description=f"{v.scene}: {v.function} ({count} checks)")
            found.append(v.outcome)
            table.add_row(v.scene, v.function, v.precision, v.check, v.outcome, v.says)
    console.print(table)
    failed, skipped = found.count("FAILS"), found.count("skipped")
    console.print(f"{found.count('holds')} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0
