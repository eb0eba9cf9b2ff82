"""``derive sweep``: very many motions, each with its own numbers, and what becomes of them."""

import argparse
from collections.abc import Callable, Sequence
from typing import Any

from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.table import Table

import derive
from derive.command.parsed import location, seconds, typed
from derive.command.solve import values_named
from derive.command.terminal import complain, console, error_console, print_rows
from derive.solve.sweep.request import ERROR, FARTHEST_START

INSTANTS = 20
LONGEST = 16
"""Digits and signs of a count that is typed."""
ABOUT = """\
Each member of a sweep has its own numbers: a point of a scrambled Sobol sequence, which its number
and the seed alone decide. Chunks, processes and machines change no bit of it.

how a number scatters (--vary NAME=...; quote it, for shells read parentheses):
  uniform(1, 2)              anywhere between two ends; 'uniform(1deg, 3deg)' too
  normal(0.1, 0.01)          mean and standard deviation; normal(0.1, 0.01, 0, 0.2) cut off at ends
  loguniform(1, 10)          its logarithm is uniform
  0..1:11                    a grid of eleven; grids are crossed, each point has all --samples

what is kept (--keep, by commas or spaces): theta is its course at --instants, theta@end,
theta@max, theta@min and theta@2.5 (after 2.5 s) are numbers; states, and answers known on the way

The length of the step is the one that the report of the scene finds to keep to --error, or --step.
Results are a folder of Parquet with a page beside it; the same command goes on where one was cut
off. The page needs nothing else; sensitivities are on it with --pairs."""


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive sweep``."""
    several: dict[str, Any] = {"action": "extend", "nargs": "+", "default": []}
    command.description = f"{command.description}\n\n{ABOUT}"
    command.add_argument("scene", metavar="SCENE", help="catalogue name or path to a TOML file")
    command.add_argument(
        "--vary", metavar="NAME=HOW", help="parameters, inputs, states at the start", **several
    )
    says = "what does not vary, as derive solve takes it"
    command.add_argument("--set", metavar="NAME=VALUE", help=says, **several)
    command.add_argument(
        "--samples", type=number_of, default=1, metavar="N", help="draws, as 1e6 (default: 1)"
    )
    command.add_argument(
        "--until", type=seconds, required=True, metavar="SECONDS", help="the end of all motions"
    )
    command.add_argument(
        "--stop", metavar="EQUATION", help="end where this is met first, as 'theta = 0'"
    )
    command.add_argument("--keep", metavar="WHAT", help="what is kept of each", **several)
    command.add_argument(
        "--instants", type=number_of, default=INSTANTS, metavar="N",
        help=f"instants of a course beside its start (default: {INSTANTS})",
    )  # fmt: skip
    length = command.add_mutually_exclusive_group()
    length.add_argument(
        "--error", type=seconds, metavar="E", help=f"that steps keep to (default: {ERROR:g})"
    )
    length.add_argument("--step", type=seconds, metavar="SECONDS", help="their length instead")
    command.add_argument(
        "--pairs", type=number_of, default=0, metavar="N",
        help="pairs of points for sensitivities, a power of two: N (inputs + 2) members more",
    )  # fmt: skip
    command.add_argument("--seed", type=number_of, default=0, metavar="N", help="of the draws (0)")
    command.add_argument(
        "--workers", type=number_of, metavar="N", help="processes of this machine (all cores)"
    )
    command.add_argument(
        "--scheduler", metavar="ADDRESS", help="of Dask: its workers move the members instead"
    )
    command.add_argument(
        "--chunk", type=number_of, metavar="N", help="members a task and file (a second's work)"
    )
    command.add_argument(
        "--near", type=seconds, metavar="PART",
        help=f"of its range, that a start is moved at most onto constraints ({FARTHEST_START:g})",
    )  # fmt: skip
    command.add_argument(
        "--out", type=location, required=True, metavar="DIR",
        help="folder for the results, as runs.parquet; the page is runs.html",
    )  # fmt: skip
    command.set_defaults(run=sweep)


def number_of(text: str) -> int:
    """Return a whole number of something, also as 1e6."""
    mantissa, _, exponent = text.lower().partition("e")
    if len(text) <= LONGEST and mantissa.isascii() and mantissa.isdecimal():
        if not exponent and "e" not in text.lower():
            return int(mantissa)
        if exponent.isascii() and exponent.isdecimal() and len(exponent) <= 2:
            return int(mantissa + int(exponent) * "0")
    raise argparse.ArgumentTypeError(f"must be a whole number, as 1000 or 1e6, not {typed(text)}")


def sweep(given: argparse.Namespace) -> int:
    """Move all members, print how they ended; an exit code of 0 also where some have no end."""
    scene = derive.load(given.scene)
    vary = values_named(given.vary, "--vary", "'m=uniform(1,2)'")
    values = values_named(given.set)
    keep = [name for text in given.keep for name in text.split(",") if name.strip()]
    with _progress() as shown:
        told = follower(shown, scene.name)
        found = scene.sweep(
            vary, given.out, given.until, keep, values, given.samples, given.stop, given.error,
            given.step, given.seed, given.instants, given.pairs, given.workers, given.scheduler,
            given.chunk, given.near, told,
        )  # fmt: skip
    for doubt in found.doubts:
        complain(f"derive: warning: {doubt}", "yellow")
    console.print(f"{scene.name}: {found.says}", highlight=False, soft_wrap=True)
    print_rows(_endings(found.ended.items()))
    for place in (found.folder, found.page):
        console.print(f"  {place}", highlight=False, soft_wrap=True)
    return 0


def follower(shown: Progress, name: str) -> Callable[[str, int, int], None]:
    """Return what hears how far a sweep is: what was done before it began takes it no time."""
    task = shown.add_task(name, total=None)
    last: list[str] = []

    def told(says: str, done: int, of: int) -> None:
        if says not in last:
            last[:] = [says]
            shown.reset(task, description=f"{name}: {says}", completed=done, total=of)
        shown.update(task, completed=done)

    return told


def _endings(ended: Any) -> Table:
    table = Table("members ended", "how many", box=None)
    said = {"until": "at the end of the time", "stop": "where the event was met"}
    for how, count in ended:
        table.add_row(said.get(how, f"without an end: {how}"), f"{count}")
    return table


def _progress() -> Progress:
    """Return a line with what is done and the time left; none where nobody looks on."""
    columns: Sequence[Any] = (
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(),
        TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn(),
    )  # fmt: skip
    hidden = not error_console.is_terminal
    return Progress(*columns, console=error_console, transient=True, disable=hidden)
