"""``make bench``: cost and error beside the best hand-written forms and peers, in one run."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from bench import show
from derive.command.terminal import OUT, complain, console, progress
from derive.emit.files import OutputError, require_writable


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table of costs and errors; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m bench", description=__doc__)
    parser.add_argument(
        "--out", type=Path, default=None, metavar="FILE", help="also write the figures as JSON"
    )
    given = parser.parse_args(arguments)
    try:
        if given.out is not None:
            require_writable(given.out)
        return show.bench(OUT, given.out, console, progress())
    except (ImportError, OutputError) as error:
        complain(f"bench: {error}", "red")
        return 2


if __name__ == "__main__":
    sys.exit(main())
