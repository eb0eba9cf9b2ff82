"""``derive solve``: the answers of a scene as a table."""

import argparse

from rich.table import Table

from derive.command.terminal import console
from derive.solve import command as answers


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive solve``."""
    answers.options(command)
    command.set_defaults(run=solve)


def solve(given: argparse.Namespace) -> int:
    """Print the answers of a scene with their units."""
    table = Table("function", "answer", "value", "unit", box=None)
    for row in answers.solved(given):
        table.add_row(*row)
    console.print(table)
    return 0
