"""``derive bench``: our functions beside those of peers."""

import argparse
from pathlib import Path

from derive.command.terminal import OUT, console, progress
from derive.files import require_writable


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive bench``."""
    command.add_argument(
        "--out", type=Path, default=None, metavar="FILE", help="also write the figures as JSON"
    )
    command.set_defaults(run=bench)


def bench(given: argparse.Namespace) -> int:
    """Compare cost and error with the best hand-written forms and with peers, in one run."""
    from derive.bench import show  # the peers are an extra: nothing else needs them

    if given.out is not None:
        require_writable(given.out)
    return show.bench(OUT, given.out, console, progress())
