"""How far off every output of every function is, by replaying the programs in floats.

The figures stand in the comment blocks and the JSON. The replay is vectorised over samples and the
same on every machine: float operations in numpy, sine and cosine correctly rounded. An error is
counted in u (2^-53, 2^-24) times the largest product in the output's equation; none counts
as smaller than the smallest normal number, below which floats are spaced alike.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import arb
from numpy.typing import NDArray

from derive.library.library import Library
from derive.program.arithmetic import Table, extended, paired
from derive.program.largest import largest
from derive.program.precision import Precision
from derive.program.program import Program, component_names
from derive.program.run import run
from derive.verify.equations import equations
from derive.verify.reference import BALLS, reference
from derive.verify.sample import Sample
from derive.verify.scale import base_of, columns_of
from derive.verify.solution import Known
from derive.verify.valuation import Arithmetic

DIGITS = 2  # of a printed figure, rounded up

True_ = Mapping[str, Known]


@dataclass(frozen=True)
class Errors:
    """The errors of one output, in u: a row a sample, a column a component."""

    function: str
    output: str
    rows: tuple[tuple[float, ...], ...]

    def largest(self) -> list[float]:
        """Return the largest error of each sample, infinite where one is no number."""
        return [largest(row) if row else 0.0 for row in self.rows]


def upwards(x: float) -> float:
    """Return ``x`` rounded up to two digits.

    >>> upwards(1.2301), upwards(0.0), upwards(11.0)
    (1.3, 0.0, 11.0)
    """
    if x == 0 or not math.isfinite(x):
        return x
    step = int(f"{x:e}".partition("e")[2]) - DIGITS + 1
    unit = 10.0 ** abs(step)
    return math.ceil(x * unit) / unit if step < 0 else math.ceil(x / unit) * unit


def references(
    library: Library, each: Sequence[Sample], arithmetic: Arithmetic = BALLS
) -> Iterator[tuple[Program, list[True_]]]:
    """Yield each function with what it should return, sample by sample."""
    asked = {base: equations(library.known, fact) for base, fact in library.truths.items()}
    for base, question in asked.items():
        own = [f for f in library.functions if base_of(f) == base]
        columns = tuple(dict.fromkeys(c for f in own for c in columns_of(f)))
        true: list[True_] = (
            [reference(question, s.values, columns, arithmetic) for s in each] if own else []
        )
        yield from ((program, true) for program in own)


def replayed(
    library: Library, each: Sequence[Sample], precision: Precision, table: Table
) -> dict[str, list[NDArray[Any]]]:
    """Return the results of every program at all samples, in the ``table`` of C's arithmetic."""
    pairs = extended(precision.dtype)
    names = each[0].values if each else ()
    known: dict[str, NDArray[Any]] = {
        name: np.array([s.values[name] for s in each], precision.dtype) for name in names
    }
    with np.errstate(all="ignore"):
        constants = _replay(library.setup, pairs, known)
        each_one: list[NDArray[Any]] = [
            np.broadcast_to(c, len(each)).astype(precision.dtype) for c in constants
        ]
        known |= dict(zip(component_names(library.setup), each_one, strict=True))
        return {
            p.name: _replay(p, pairs if p.arithmetic == "pairs" else table, known)
            for p in library.printed()
        }


def _replay(program: Program, table: Table, known: Mapping[str, NDArray[Any]]) -> list[Any]:
    given = [known[c] for q in program.inputs for c in q.components]
    if program.arithmetic != "pairs":
        return run(program, table, given)
    return [r[0] for r in run(program, table, paired(np.array(given)))]


def errors(
    program: Program, results: Sequence[Any], true: Sequence[True_], precision: Precision
) -> Iterator[Errors]:
    """Yield the errors of each output of a function, from its results by component."""
    columns = [np.broadcast_to(r, len(true)).tolist() for r in results]
    place = 0
    for q in program.outputs:
        own = columns[place : place + len(q.components)]
        place += len(q.components)
        rows = tuple(
            tuple(
                error(column[n], should, precision)
                for column, should in zip(own, expected(program, q.name, here), strict=True)
            )
            for n, here in enumerate(true)
        )
        yield Errors(program.name, q.name, rows)


@dataclass(frozen=True)
class Expected:
    """What a component should be, its largest product, and how far small ones are magnified."""

    value: Any
    scale: float
    gain: float


def expected(program: Program, output: str, true: True_) -> list[Expected]:
    """Return what each component of an output should be."""
    pattern = (program.sparsity or {}).get(output)
    if pattern is None:
        (q,) = (q for q in program.outputs if q.name == output)
        own = [true[c] for c in q.components]
        return [Expected(known.value, known.scale, known.gain) for known in own]
    zero: tuple[Any, float] = (arb(0), 0.0)
    entries = [(true[pattern.rows[i]], pattern.columns[k]) for i, k in pattern.places()]
    slopes = [(row.slopes.get(column, zero), row.gain) for row, column in entries]
    return [Expected(value, scale, gain) for (value, scale), gain in slopes]


def error(found: float, should: Expected, precision: Precision) -> float:
    """Return how far ``found`` is from what it should be, in u of the largest product."""
    if not math.isfinite(found):
        return math.inf
    smallest = float(np.finfo(precision.dtype).smallest_normal)
    wrong = (arb(found) - should.value).mid() / arb(max(should.scale, smallest * should.gain))
    return abs(float(wrong)) / precision.unit_roundoff
