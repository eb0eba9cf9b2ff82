"""The command line: one row a command, with what is said of it and how it is used.

Exit code 0: done. 1: something differs, or fails its check or its proof. 2: the input is bad, and
one sentence says what, by which rule, and what was found. 130: it was interrupted.
"""

import argparse
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import redirect_stdout, suppress
from io import StringIO

import numpy as np

from derive import DeriveError, __version__
from derive.command import (
    check,
    completion,
    control,
    equations,
    generate,
    lecture,
    new,
    report,
    scenes,
    schema,
    solve,
    sweep,
)
from derive.command.parsed import Parser, parsed
from derive.command.terminal import complain, console, error_console
from derive.verify.prove import ProofError

STOPPED = 130  # what a shell expects after an interrupt
COMMANDS: Mapping[str, tuple[Callable[[argparse.ArgumentParser], None], str, tuple[str, ...]]] = {
    "new": (
        new.options,
        "start a commented scene",
        ("derive new machine hoist && derive generate hoist.toml",),
    ),
    "generate": (
        generate.options,
        "write the C, CasADi, JSON and HTML of scenes",
        (
            "derive generate heavy_top",
            "derive generate brick.toml --out build --samples 256",
            "derive generate eulers_disk --fixed m=0.44,r=0.038,tilt=5deg,g=9.81 --out build",
            "derive generate heavy_top --package lib/heavy_top --for platformio,cmake",
            "derive generate --check",
        ),
    ),
    "check": (
        check.options,
        "compile what was emitted and compare it with ball arithmetic, or run it on a core",
        (
            "derive check heavy_top",
            "derive check brick.toml --samples 1000000",
            "derive check heavy_top --target m4f",
        ),
    ),
    "solve": (
        solve.options,
        "evaluate the answers of a scene, roots included",
        (
            "derive solve edge_runner_flat --set m=1200 r=0.6 width=0.3 L=0.9 W=3.2 g=9.81",
            "derive solve sleeping_top --set m=0.5 r=0.05 l=0.06 g=9.81 --limit n",
        ),
    ),
    "sweep": (
        sweep.options,
        "move a million of a scene's motions, each with its own numbers",
        (
            "derive sweep sleeping_top --vary 'alpha=uniform(1deg,3deg)' 'm=normal(0.5,0.01)' \\",
            "    --set r=0.05 l=0.06 g=9.81 n=40 beta=0 alpha_dot=0 beta_dot=0 --samples 1e6 \\",
            "    --until 0.5 --stop 'alpha = 0.06' --keep alpha,energy@end --out runs.parquet",
        ),
    ),
    "control": (
        control.options,
        "find inputs that bring a scene where it is to go, at the least cost",
        (
            "derive control craft.toml --turn 'z 180deg' --limit moment=0.4 --set I_xx=1.4 ...",
            "derive control craft.toml --turn '1,2,2 2' --cost energy=1 --until 5 --set ...",
        ),
    ),
    "equations": (
        equations.options,
        "print the equations of a scene: text, LaTeX or SymPy",
        (
            "derive equations heavy_top",
            "derive equations brick.toml --latex > brick.tex && pdflatex brick",
            "derive equations sleeping_top --sympy > top.py",
        ),
    ),
    "report": (
        report.options,
        "measure speed against error: steps, functions, hard cases",
        ("derive report heavy_top",),
    ),
    "scenes": (
        scenes.options,
        "list the catalogue",
        ("derive scenes",),
    ),
    "lecture": (
        lecture.options,
        "verify the derivation step by step",
        (
            "derive lecture",
            "derive lecture --without strong_third_law",
        ),
    ),
    "schema": (
        schema.options,
        "print the JSON Schema of a scene, for editors",
        ("derive schema > scene.schema.json",),
    ),
    "completion": (
        completion.options,
        "print what a shell needs to complete names and options",
        ('eval "$(derive completion bash)"',),
    ),
}
"""What each command is told and does, what is said of it, and how it is used."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    if sys.stdout is None:
        complain("derive: the output: it is closed, so nothing can be printed", "red")
        return 2
    try:
        options = _parsed(arguments)
        command: Callable[[argparse.Namespace], int] = options.run
        with np.errstate(all="ignore"):  # what overflows is refused or told by a sentence of ours
            code = command(options)
            sys.stdout.flush()
            return code
    except ProofError as error:
        complain(f"derive: {error}", "red")
        return 1
    except DeriveError as error:
        complain(f"derive: {error}", "red")
        return 2
    except OSError as error:
        if error.filename is None:
            _forget_output()
        if isinstance(error, BrokenPipeError):  # who read, as `head`, has had enough
            return 0
        where = "the output" if error.filename is None else f"'{error.filename}'"
        complain(f"derive: {where}: {error.strerror}", "red")
        return 2
    except KeyboardInterrupt:
        error_console.print("derive: stopped; every file is whole, some may be new")
        return STOPPED


def _parsed(arguments: Sequence[str] | None) -> argparse.Namespace:
    """Return what was asked for; help is printed as all else is, for argparse hides failures."""
    helps = StringIO()
    try:
        with redirect_stdout(helps):
            return parsed(parser(), COMMANDS, sys.argv[1:] if arguments is None else arguments)
    finally:
        sys.stdout.write(helps.getvalue())
        sys.stdout.flush()


def _forget_output() -> None:
    """Let what still waits for an output that fails go nowhere, so that nobody tries it again."""
    with suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        with console.capture():
            pass


def parser() -> Parser:
    """Return the parser of the command line."""
    top = Parser(
        prog="derive",
        description="Equations of rotating rigid bodies: derived from particles, printed as"
        " checked C and CasADi.",
        epilog="""\
a SCENE is a name from `derive scenes` or a path to a TOML file; none means the whole catalogue

begin with:
  derive new body brick                 a commented scene, brick.toml
  derive generate brick.toml            its C, CasADi, JSON and page, in generated/brick/
  derive equations brick.toml           its equations, for a terminal, LaTeX or SymPy
`derive COMMAND --help` has examples of each command

exit code: 0 done, 1 something differs or fails its check, 2 the input is bad, 130 interrupted""",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action="version", version=f"derive {__version__}")
    top.set_defaults(parser=top)
    commands = top.add_subparsers(required=True, metavar="COMMAND")
    for name, (options, says, examples) in COMMANDS.items():
        command = commands.add_parser(
            name,
            help=says,
            description=f"{says[0].upper()}{says[1:]}.",
            epilog="\n".join(["examples:", *(f"  {example}" for example in examples)]),
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        command.set_defaults(parser_of=command)
        options(command)
    return top
