"""``make report``: speed against error of everything that is emitted, beside peers."""

import argparse
import sys
from collections.abc import Sequence

from bench.report import command
from derive.check.compiler import CompilerError
from derive.command.terminal import OUT, complain, console, progress
from derive.emit.files import OutputError
from derive.scene import SceneError


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the report, or print a part of it; return the exit code."""
    given = parser().parse_args(arguments)
    kind = "full" if given.full else "small"
    try:
        if given.again is not None:
            return command.again(OUT, kind, given.again, console, progress())
        return command.report(OUT, kind, given.only, console, progress())
    except (CompilerError, ImportError, OutputError, SceneError) as error:
        complain(f"report: {error}", "red")
        return 2


def parser() -> argparse.ArgumentParser:
    """Return the parser of the report's options."""
    parser = argparse.ArgumentParser(prog="python -m bench.report", description=__doc__)
    parser.add_argument(
        "--full", action="store_true", help="finer steps and more of them: about 20 minutes"
    )
    parser.add_argument(
        "--only",
        nargs="+",
        default=[],
        metavar="NAME",
        help="run one case or section, print its figures and write nothing",
    )
    parser.add_argument(
        "--again",
        nargs="*",
        metavar="NAME",
        help="write the report anew from generated/report.json, measuring only what is named",
    )
    return parser


if __name__ == "__main__":
    sys.exit(main())
