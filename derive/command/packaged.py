"""``derive generate --package``: one scene's C as a folder that drops into a firmware project."""

import argparse
from collections.abc import Callable

import derive
from derive.command.parsed import location, typed, word_of
from derive.solve.handle import Handle
from derive.solve.packages import TOOLS, TYPES_OF_C, package


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options by which ``derive generate`` makes a package."""
    command.add_argument(
        "--package",
        type=location,
        metavar="DIR",
        help="write one scene's C, a test and manifests of build tools to DIR instead",
    )
    command.add_argument(
        "--for",
        type=_tools,
        dest="tools",
        metavar="TOOLS",
        help=f"build tools that the package is for (default: {','.join(TOOLS)})",
    )
    command.add_argument(
        "--precision",
        type=word_of(TYPES_OF_C),
        choices=tuple(TYPES_OF_C),
        help="type in which the package computes (default: both)",
    )


def _tools(text: str) -> tuple[str, ...]:
    tools = tuple(dict.fromkeys(text.split(",")))
    strange = next((tool for tool in tools if tool not in TOOLS), None)
    if strange is None:
        return tuple(tool for tool in TOOLS if tool in tools)
    rule = f"must be some of {', '.join(TOOLS)}, with commas between"
    raise argparse.ArgumentTypeError(f"{rule}, not {typed(strange)}")


def require_sense(given: argparse.Namespace) -> None:
    """Refuse options of a package without one, and a package of other than one scene."""
    asked = {"--for": given.tools, "--precision": given.precision}
    without = next((option for option, value in asked.items() if value), "")
    if given.package is None:
        if without:
            raise derive.DeriveError(f"generate: {without} needs --package DIR")
        return
    other = {"--check": given.check, **{f"--{part}": True for part in given.parts}}
    if beside := next((option for option, value in other.items() if value), ""):
        raise derive.DeriveError(f"generate: --package does not go with {beside}")
    if len(given.scenes) != 1:
        said = f"{len(given.scenes)} were named" if given.scenes else "none was named"
        raise derive.DeriveError(f"generate: --package takes one scene, but {said}")


def made(
    scene: Handle, given: argparse.Namespace, told: Callable[[str], None]
) -> derive.Generation:
    """Write the package of a scene."""
    tools, precision = given.tools or TOOLS, given.precision or "both"
    return package(
        scene, given.package, tools, precision, given.out, given.samples, given.figures, told
    )
