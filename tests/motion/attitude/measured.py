"""Errors of attitude functions in units of the largest component's roundoff."""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import flint
import numpy as np
from numpy.typing import NDArray

from derive.motion.attitude.functions import FUNCTIONS, attitude_program
from derive.program.arithmetic import MANTISSA, working
from derive.program.program import Program
from derive.program.run import run
from tests.motion.attitude.truth import BITS, Vector, plain

SMALLEST = {np.float64: 2.0**-1074, np.float32: 2.0**-149}
UNIT = {dtype: 2.0**-bits for dtype, bits in MANTISSA.items()}
PRECISIONS = (np.float32, np.float64)

Rows = NDArray[Any]


@cache
def program(name: str) -> Program:
    return attitude_program(name)


def called(function: Program | str, *given: Rows) -> Rows:
    """Return a function's results, samples by components, in the precision of what is given."""
    chosen = program(function) if isinstance(function, str) else function
    values = [column for rows in given for column in rows.T]
    with np.errstate(all="ignore"):
        found = run(chosen, working(given[0].dtype.type), values)
    return np.stack([np.broadcast_to(f, len(given[0])) for f in found], axis=1)


def error(found: Sequence[float], true: Vector, dtype: type) -> float:
    """Return the largest error over the largest true component, in u; denormals may lose a bit."""
    if not np.all(np.isfinite(found)):
        return float("inf")
    with flint.ctx.workprec(BITS):
        scale = max(abs(t) for t in true) * UNIT[dtype] + SMALLEST[dtype]
        return float(
            max(abs(flint.arb(float(f)) - t) for f, t in zip(found, true, strict=True)) / scale
        )


def errors(function: str, truth: Callable[..., Vector], *given: Rows) -> list[float]:
    """Return the error of every sample."""
    found = called(function, *given)
    samples = zip(*given, strict=True)
    dtype = given[0].dtype.type
    return [error(f, plain(truth, *g), dtype) for f, g in zip(found, samples, strict=True)]


def promise(name: str) -> int:
    """Return what a function promises, in u."""
    return next(f.within for f in FUNCTIONS if f.name == name)
