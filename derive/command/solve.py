"""``derive solve``: the answers of a scene as a table."""

import argparse

from rich.table import Table

from derive.command.terminal import console, error_console
from derive.scene import SceneError
from derive.scene.unit import behind
from derive.solve import command as answers


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive solve``."""
    answers.options(command)
    command.set_defaults(run=solve)


def solve(given: argparse.Namespace) -> int:
    """Print the answers of a scene with their units; refuse at the end what has no values."""
    found = answers.printout(given)
    for doubt in found.doubts:
        error_console.print(
            f"derive: warning: {doubt}", style="yellow", highlight=False, markup=False
        )
    table = Table("function", "answer", "value", "unit", box=None)
    for row in found.rows:
        table.add_row(*row[:3], behind(row[3]).strip())
    if found.rows or not found.unanswered:
        console.print(table)
    if found.unanswered:
        raise SceneError(f"set values by --set: {'; '.join(found.unanswered)}")
    return 0
