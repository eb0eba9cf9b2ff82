"""``derive check``: the emitted files, compiled and compared."""

import argparse

from rich.table import Table

import derive
from derive.command.scenes import samples_argument, scene_argument
from derive.command.terminal import OUT, console, print_rows, progress
from derive.solve.handle import FRESH
from derive.solve.several import checked


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive check``."""
    scene_argument(command)
    samples_argument(command, FRESH, "fresh samples that stated errors are tried at")
    command.set_defaults(run=check)


def check(given: argparse.Namespace) -> int:
    """Compile the emitted files and compare them with ball arithmetic and with each other."""
    table = Table("scene", "function", "in", "check", "verdict", "found", box=None)
    found: list[str] = []
    with progress() as shown:
        task = shown.add_task("finding a compiler")

        def told(says: str) -> None:
            shown.update(task, description=says)

        for v in checked(
            [derive.load(source) for source in given.scenes], OUT, given.samples, told
        ):
            found.append(v.outcome)
            told(f"{v.scene}: {v.function} ({len(found)} checks)")
            table.add_row(v.scene, v.function, v.precision, v.check, v.outcome, v.says)
    print_rows(table)
    failed, skipped = found.count("FAILS"), found.count("skipped")
    console.print(f"{found.count('holds')} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0
