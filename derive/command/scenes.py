"""``derive scenes``: the catalogue; and how other commands are told which scenes are meant."""

import argparse

from rich.table import Table

import derive
from derive.command.parsed import whole
from derive.command.terminal import print_rows
from derive.solve.generation import NUMBERS


def options(command: argparse.ArgumentParser) -> None:
    """Declare ``derive scenes``, which has no options."""
    command.set_defaults(run=list_scenes)


def scene_argument(command: argparse.ArgumentParser) -> None:
    """Let a command take scenes; none means the whole catalogue."""
    command.add_argument(
        "scenes", nargs="*", metavar="SCENE", help="catalogue name or path to a TOML file"
    )


def list_scenes(_: argparse.Namespace) -> int:
    """Print the catalogue: name, title, wanted functions."""
    table = Table("scene", "what it is", "functions", box=None)
    for scene in map(derive.load, derive.catalogue()):
        table.add_row(scene.name, scene.title, ", ".join(scene.wanted))
    print_rows(table)
    return 0


def samples_argument(command: argparse.ArgumentParser, default: int, says: str) -> None:
    """Let a command be told how many samples to take."""
    command.add_argument(
        "--samples",
        type=whole(NUMBERS[-1]),
        default=default,
        metavar="N",
        help=f"{says} (default: {default})",
    )
