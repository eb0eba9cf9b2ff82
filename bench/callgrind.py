"""Instructions that a call takes, counted by Valgrind's callgrind.

The difference of two runs, divided by the difference of their calls: what starts and ends a
program cancels. The loop around the call stays inside; ``LOOP`` of the table tells how much.
"""

import re
from collections.abc import Sequence
from pathlib import Path

from bench.build import BuildError, Row, pack, run
from bench.candidate import SAMPLES

FEW, MANY = 4, 68  # rounds of SAMPLES calls
TOTAL = re.compile(r"^(?:summary|totals):\s*(\d+)\s*$", re.MULTILINE)


def total(text: str) -> int:
    """Return the instruction total of a callgrind output file.

    >>> total("version: 1\\nevents: Ir\\nsummary: 4711\\n")
    4711
    """
    found = TOTAL.findall(text)
    if not found or "events: Ir" not in text:
        raise BuildError("a callgrind file without 'events: Ir' or without a total")
    return int(found[-1])


def instructions(program: Path, rows: Sequence[Row]) -> float:
    """Return the instructions of one call, on average over ``SAMPLES`` rows in turn."""
    given = pack(rows[:SAMPLES])
    return (_run(program, given, MANY) - _run(program, given, FEW)) / ((MANY - FEW) * SAMPLES)


def _run(program: Path, given: bytes, rounds: int) -> int:
    out = program.with_suffix(f".{rounds}.callgrind")
    tool = ("valgrind", "--tool=callgrind", "-q", f"--callgrind-out-file={out}")
    run((*tool, str(program), f"{rounds:03d}"), given)  # as many digits: the same start
    return total(out.read_text(encoding="utf-8"))
