"""``derive report``: what every function of a scene costs and how wrong it is."""

import argparse
from functools import partial

from derive.command.costs import print_costs
from derive.command.generate import made_of
from derive.command.generation import made_with_savings
from derive.command.scenes import scene_argument
from derive.command.terminal import OUT
from derive.verify.kept import Measuring
from derive.verify.search import SAMPLING


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive report``."""
    scene_argument(command)
    command.set_defaults(run=report)


def report(given: argparse.Namespace) -> int:
    """Print what the functions of scenes cost, and the errors that were measured."""
    making = partial(made_with_savings, measuring=Measuring(SAMPLING, OUT))
    print_costs(made_of(given.scenes, (), making))
    return 0
