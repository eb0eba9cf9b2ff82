"""Instructions of a call of each function of a scene, counted by callgrind on the compiled code.

A part of so many calls from one part of twice as many leaves what as many calls take: what comes
once cancels. The loop around a call and its pointer stay inside, some three instructions for each
argument and ten more.
"""

import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.check.callgrind import MARKING, is_there, stretches
from derive.check.compiler import find_compiler, program_made
from derive.emit.templates import TEMPLATES
from derive.motion.runge_kutta.system import NEXT
from derive.program.program import Program
from derive.report.driver import Driver
from derive.report.march import march
from derive.report.price import rows_at
from derive.report.states import Begun

WITHOUT = "instructions: not counted, no valgrind"


@dataclass(frozen=True)
class Instructions:
    """Of a call, on average over the samples that it is timed at."""

    function: str
    form: str
    precision: str
    count: float


def instructions(
    driver: Driver,
    form: str,
    programs: Sequence[Program],
    start: Begun | None,
    lengths: Mapping[str, float],
    folder: Path,
) -> list[Instructions]:
    """Return the instructions of calls; nothing without a compiler or without valgrind.

    start, lengths : where steps begin, and s of theirs, by name
    Raises CallgrindError if a program cannot be counted.
    """
    if driver.shared is None or not is_there():
        return []
    text = TEMPLATES.get_template("report_count.c.jinja").render(mark=MARKING)
    program = program_made(text, "count.c", folder, find_compiler())
    given = [_given(driver, p, start, lengths.get(p.name, 0.0)) for p in programs]
    command = (str(program), str(driver.path))
    _, found = stretches(command, b"".join(data for data, _ in given), folder)
    few, many = found[1::3], found[2::3]  # each ends at a mark: what comes before, N calls, 2N
    return [
        Instructions(p.name, form, driver.precision.name, (b.instructions - a.instructions) / calls)
        for p, (_, calls), a, b in zip(programs, given, few, many, strict=True)
    ]


def _given(
    driver: Driver, program: Program, start: Begun | None, length: float
) -> tuple[bytes, int]:
    """Return a function's name and arguments as they are read, and the calls of a round."""
    at = rows_at(driver)
    if start is not None and any(q.name.endswith(NEXT) for q in program.outputs):
        at = march(driver, program.name, start, length).at
    count = max([1, *(at[q.name].shape[0] for q in program.inputs)])
    into = driver.room(program, count)
    every = [*(at[q.name] for q in program.inputs), *(into[q.name] for q in program.outputs)]
    name = f"{driver.library.scene.name}_loop_{program.name}".encode()
    head = struct.pack("=3q", len(name), len(every), count) + name
    return head + b"".join(map(_argument, every)), count


def _argument(rows: NDArray[Any]) -> bytes:
    apart = rows.shape[1] if rows.shape[0] > 1 else 0
    data = np.ascontiguousarray(rows).tobytes()
    return struct.pack("=2q", apart, len(data)) + data
