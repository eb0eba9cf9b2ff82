"""Instructions that a call takes, counted by Valgrind's callgrind.

The difference of two runs, divided by the difference of their calls: what starts and ends a
program cancels. The loop around the call stays inside; ``LOOP`` of the table tells how much.
"""

from collections.abc import Sequence
from pathlib import Path

from bench.build import BuildError, Row, pack
from bench.candidate import SAMPLES
from derive.check.callgrind import CallgrindError, Stretch, stretches

FEW, MANY = 4, 68  # rounds of SAMPLES calls


def instructions(program: Path, rows: Sequence[Row]) -> float:
    """Return the instructions of one call, on average over ``SAMPLES`` rows in turn."""
    given = pack(rows[:SAMPLES])
    return (_run(program, given, MANY) - _run(program, given, FEW)) / ((MANY - FEW) * SAMPLES)


def _run(program: Path, given: bytes, rounds: int) -> int:
    command = (str(program), f"{rounds:03d}")  # as many digits: the same start
    _, found = counted(command, given, program.parent)
    return found[-1].instructions


def counted(command: Sequence[str], given: bytes, folder: Path) -> tuple[bytes, list[Stretch]]:
    """Return what a program prints and its parts, as the reports of scenes count them.

    Raises FileNotFoundError without valgrind, BuildError if the run fails.
    """
    try:
        return stretches(command, given, folder)
    except CallgrindError as error:
        raise BuildError(str(error)) from None
