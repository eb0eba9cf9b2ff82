"""How far off every output of every function is, by replaying the programs in floats.

The figures stand in the comment blocks and the JSON. The replay is vectorised over samples and the
same on every machine: float operations in numpy, sine and cosine correctly rounded. An error is
counted in u (2^-53, 2^-24) times the largest term of the sum that the output is; no term counts
as smaller than the smallest normal number, below which floats are spaced alike.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import median
from typing import Any

import numpy as np
from flint import arb
from numpy.typing import NDArray

from derive.arithmetic import Table, extended, paired, working
from derive.c_text import PRECISIONS, Precision
from derive.equations import equations
from derive.largest import largest
from derive.library import Library
from derive.program import Measurement, Program, component_names, run
from derive.reference import Known, reference
from derive.sample import Sample, samples
from derive.scene.wanted import JACOBIAN

ORDINARY, CORNERS = 96, 3
DIGITS = 2  # of a printed figure, rounded up

True_ = Mapping[str, Known]


@dataclass(frozen=True)
class Errors:
    """The errors of one output, in u: a row a sample, a column a component."""

    function: str
    output: str
    rows: tuple[tuple[float, ...], ...]


def figures(library: Library) -> tuple[Measurement, ...]:
    """Return the errors of every output of every function, both precisions."""
    found: list[Measurement] = []
    for precision in PRECISIONS:
        each = samples(library.known, precision, ORDINARY, CORNERS).each
        lectured = replace(library, motions=())
        results = replayed(lectured, each, precision, working(precision.dtype))
        for program, true in references(library, each):
            every = errors(program, results[program.name], true, precision)
            found += [measurement(one, precision, each) for one in every]
    return tuple(found)


def measurement(found: Errors, precision: Precision, each: Sequence[Sample]) -> Measurement:
    """Return median and largest of errors, rounded up to the digits that are printed."""
    worst = [largest(row) if row else 0.0 for row in found.rows]
    most = largest(worst)
    middle = median([error for row in found.rows for error in row] or [0.0])
    number = each[worst.index(most)].number
    return Measurement(
        found.function,
        precision.name,
        found.output,
        upwards(middle),
        upwards(most),
        number,
        len(each),
    )


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


def references(library: Library, each: Sequence[Sample]) -> Iterator[tuple[Program, list[True_]]]:
    """Yield each function with what it should return, sample by sample."""
    for base, fact in library.truths.items():
        question, columns = equations(library.known, fact), _columns(library, base)
        true: list[True_] = [reference(question, s.values, columns) for s in each]
        for program in library.functions:
            if program.name.removesuffix(JACOBIAN) == base:
                yield program, true


def _columns(library: Library, base: str) -> tuple[str, ...]:
    program = next((f for f in library.functions if f.name == base + JACOBIAN), None)
    patterns = (program.sparsity or {}).values() if program else ()
    return tuple(c for pattern in patterns for c in pattern.columns)


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
    in_pairs = program.name == "setup" or program.arithmetic == "pairs"
    results = run(program, table, paired(np.array(given)) if in_pairs else given)
    return [r[0] for r in results] if in_pairs else results


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
    """What a component should be, its largest term, and how far small terms are magnified."""

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
    zero = (arb(0), 0.0)
    entries = [(true[pattern.rows[i]], pattern.columns[k]) for i, k in pattern.places()]
    return [Expected(*row.slopes.get(column, zero), row.gain) for row, column in entries]


def error(found: float, should: Expected, precision: Precision) -> float:
    """Return how far ``found`` is from what it should be, in u of the largest term."""
    if not math.isfinite(found):
        return math.inf
    smallest = float(np.finfo(precision.dtype).smallest_normal)
    wrong = (arb(found) - should.value).mid() / arb(max(should.scale, smallest * should.gain))
    return abs(float(wrong)) / precision.unit_roundoff
