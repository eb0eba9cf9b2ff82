"""``derive report``: what every function costs and how wrong it is."""

import argparse

from derive.command.costs import print_costs
from derive.command.generate import made_of
from derive.command.scenes import scene_argument
from derive.command.terminal import OUT, complain, console, progress
from derive.kept import Measuring
from derive.search import SAMPLING


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive report``."""
    scene_argument(command)
    command.add_argument(
        "--full", action="store_true", help="finer steps and more of them: about 20 minutes"
    )
    command.add_argument(
        "--only",
        nargs="+",
        default=[],
        metavar="NAME",
        help="run one case or section, print its figures and write nothing",
    )
    command.add_argument(
        "--again",
        nargs="*",
        metavar="NAME",
        help="write the report anew from generated/report.json, measuring only what is named",
    )
    command.set_defaults(run=report)


def report(given: argparse.Namespace) -> int:
    """Write the speed-against-error report; of scenes, only print what their functions cost."""
    if given.scenes:
        print_costs(made_of(given.scenes, (), Measuring(SAMPLING, OUT)))
        return 0
    from derive.report import command  # matplotlib and the peers are an extra

    kind = "full" if given.full else "small"
    try:
        if given.again is not None:
            return command.again(OUT, kind, given.again, console, progress())
        return command.report(OUT, kind, given.only, console, progress())
    except ImportError as absent:
        complain(f"derive: {absent}", "red")
        return 2
