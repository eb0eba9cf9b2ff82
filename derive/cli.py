"""The command line: derive lecture | generate | check | report | solve | scenes.

Exit code 0: done. 1: something differs, or fails its check or its proof. 2: the input is bad, and
one sentence says what, by which rule, and what was found.
"""

import argparse
from collections.abc import Callable, Sequence

import numpy as np

from derive import __version__
from derive.check.compiler import CompilerError
from derive.command import check, generate, lecture, report, scenes, solve
from derive.command.terminal import complain, error_console
from derive.emit.files import OutputError
from derive.scene import SceneError
from derive.verify.prove import ProofError
from derive.verify.reference import NoValueError

STOPPED = 130  # what a shell expects after an interrupt
COMMANDS = {
    "lecture": (lecture.options, "verify the derivation step by step"),
    "generate": (generate.options, "write the C, CasADi, JSON and HTML of scenes"),
    "check": (check.options, "compile what was emitted and compare it with ball arithmetic"),
    "report": (report.options, "show what every function costs and how wrong it is"),
    "solve": (solve.options, "evaluate the answers of a scene, roots included"),
    "scenes": (scenes.options, "list the catalogue"),
}
"""What each command is told and does, and what is said of it."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    options = parser().parse_args(arguments)
    command: Callable[[argparse.Namespace], int] = options.run
    try:
        with np.errstate(all="ignore"):  # what overflows is refused or told by a sentence of ours
            return command(options)
    except ProofError as error:
        complain(f"derive: {error}", "red")
        return 1
    except (SceneError, OutputError, CompilerError, NoValueError) as error:
        complain(f"derive: {error}", "red")
        return 2
    except OSError as error:
        if error.filename is None:
            raise
        complain(f"derive: '{error.filename}': {error.strerror}", "red")
        return 2
    except KeyboardInterrupt:
        error_console.print("derive: stopped; every file is whole, some may be new")
        return STOPPED


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    top = argparse.ArgumentParser(
        prog="derive",
        description="Equations of rotating rigid bodies: derived from particles, printed as"
        " checked C and CasADi.",
        epilog="A SCENE is a name from `derive scenes` or a path to a TOML file; none means the"
        " whole catalogue.",
    )
    top.add_argument("--version", action="version", version=f"derive {__version__}")
    commands = top.add_subparsers(required=True, metavar="COMMAND")
    for name, (options, says) in COMMANDS.items():
        options(commands.add_parser(name, help=says))
    return top
