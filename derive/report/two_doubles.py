"""Lengths of a motion in C, on sums of two doubles, where there is a compiler.

The equations go to it as they are done in long floats: line by line, as a table that it reads. It
takes a fiftieth of the time, and keeps 30 digits of them.
"""

import ctypes
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from flint import arb, ctx

from derive.check.compiler import CompilerError, callable_library, compiled, find_compiler
from derive.emit.templates import TEMPLATES
from derive.report.extrapolation import DEEPEST
from derive.report.rate import RateOfState
from derive.verify.operators import Column

OPERATIONS = ("mul", "sum", "inverse", "solve", "sin", "cos", "sqrt")
LARGEST = 16
"""Unknowns of a block."""
TERMS = 34
"""Of the series of a sine: of half a right angle, the last is below 1e-33."""
DIGITS = 256
"""Binary, of constants."""
SOURCE = "extrapolation.c"
TakenFrom = Callable[[list[Any], float], tuple[list[Any], float]]
"""From a state and a length to the state after it, and what extrapolation leaves."""


def extrapolation_made(folder: Path) -> Path | None:
    """Return the library that takes lengths of motions, None where there is no compiler."""
    try:
        with_ = find_compiler()
    except CompilerError:
        return None
    with ctx.workprec(DIGITS):
        inverses = _apart([1 / arb(i * (i + 1)) for i in range(1, TERMS)])
        right = _apart([arb.pi() / 2], 3)
    text = TEMPLATES.get_template("report_extrapolation.c.jinja").render(
        operations=OPERATIONS, deepest=DEEPEST, largest=LARGEST,
        right=_written(right)[0], inverses=_written(inverses),
    )  # fmt: skip
    return compiled({SOURCE: text}, SOURCE, folder, with_)


def taken_in_c(made: Path, rate: RateOfState) -> TakenFrom | None:
    """Return what takes lengths of a motion, None if its equations have what C is not told."""
    for name, places in rate.lines:
        if name not in OPERATIONS or (name == "solve" and places[1] > LARGEST):
            return None
    table = [n for name, places in rate.lines
             for n in (1 + OPERATIONS.index(name), 2 + len(places), *places)]  # fmt: skip
    lines = np.array([*table, 0], np.intc)
    numbers = _apart([arb(0) if x is None else x for x in rate.numbers])
    size, function = len(rate.states), _function(made)
    ours = np.array([*rate.states, *rate.rates], np.intc)
    room, end, left = np.zeros((2 * DEEPEST + 4, size, 2)), np.zeros((size, 2)), np.zeros(1)

    def taken(state: list[Any], length: float) -> tuple[list[Any], float]:
        start = _apart(state)
        own = (x.ctypes.data for x in (ours, start, end, left, room))
        before, begin, *rest = map(ctypes.c_void_p, own)
        function(ctypes.c_void_p(lines.ctypes.data), ctypes.c_void_p(numbers.ctypes.data),
                 ctypes.c_int(size), before, begin, ctypes.c_double(length), *rest)  # fmt: skip
        return [arb(a) + arb(b) for a, b in end.tolist()], float(left[0])

    return taken


@cache
def _function(made: Path) -> Any:
    function = callable_library(made).one_length
    function.restype = None
    return function


def _written(rows: Column) -> list[list[str]]:
    return [[float(x).hex() for x in row] for row in rows]


def _apart(numbers: list[Any], count: int = 2) -> Column:
    """Return numbers as sums of doubles, the largest first."""
    every = np.zeros((len(numbers), count))
    for row, x in zip(every, numbers, strict=True):
        for k in range(count):
            row[k] = float(x)
            x = x - arb(row[k])
    return every
