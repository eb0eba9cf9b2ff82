"""How far a program's answers are from the truth, block by block, in units of 2^-53."""

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from flint import arb

from bench.problem import Problem
from bench.truth import Column
from derive.program.largest import largest

UNIT = 2.0**-53


@dataclass(frozen=True)
class Accuracy:
    """The error of the worst block of each sample: half of the samples stay below ``middle``."""

    middle: float
    largest: float


def accuracy(
    problem: Problem, found: Sequence[Sequence[float]], true: Sequence[Column]
) -> Accuracy:
    """Return the norm of each block's error over the norm of the block, median and largest."""
    errors = [
        largest(_error(block.places, row, column) for block in problem.blocks)
        for row, column in zip(found, true, strict=True)
    ]
    return Accuracy(median(errors), largest(errors))


def _error(places: Sequence[int], row: Sequence[float], column: Column) -> float:
    if any(value != value for value in (row[n] for n in places)):
        return float("inf")
    size = sum((arb(column[n]) ** 2 for n in places), arb(0))
    wrong = sum(((arb(row[n]) - column[n]) ** 2 for n in places), arb(0))
    if size > 0:
        return float((wrong / size).sqrt()) / UNIT
    return 0.0 if wrong == 0 else float("inf")
