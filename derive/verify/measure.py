"""How far off every output of every function is, by replaying the programs in floats.

The figures stand in the comment blocks and the JSON. The replay is vectorised over samples and the
same on every machine: float operations in numpy, sine and cosine correctly rounded. A function of
the lecture should return what its equations say; one of motion what the same program gives in
balls, set-up included: what a step leaves out by its order is another matter, which tests measure.
An error is counted in u (2^-53, 2^-24) times what ``scale`` says, the largest product in the
output's equation; none counts as smaller than the smallest normal number.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, Decimal
from typing import Any

import numpy as np
from flint import arb, ctx
from numpy.typing import NDArray

from derive.library.library import Library
from derive.program.arithmetic import extended, paired
from derive.program.largest import largest
from derive.program.precision import Precision
from derive.program.program import Program, component_names
from derive.program.run import results_by_name, run
from derive.scene.formula import Arithmetic
from derive.verify.columns import arithmetics, planned, supplied
from derive.verify.draw import Sampled
from derive.verify.operators import LONG_FLOATS
from derive.verify.reference import BALLS, BITS, References, references
from derive.verify.sample import Sample
from derive.verify.scale import (
    around,
    base_of,
    columns_of,
    entries,
    measured_outputs,
    motion_scales,
)

DIGITS = 2  # of a printed figure, rounded up


@dataclass(frozen=True)
class Errors:
    """The errors of one output, in u: a row a sample, a column a component."""

    function: str
    output: str
    rows: tuple[tuple[float, ...], ...]

    def largest(self) -> list[float]:
        """Return the largest error of each sample, infinite where one is no number."""
        return [largest(row) if row else 0.0 for row in self.rows]


@dataclass(frozen=True)
class Expected:
    """What a component should be, its largest product, and how far small ones are magnified.

    whole : it is an angle, the same a turn later
    """

    value: Any
    scale: float
    gain: float = 0.0
    whole: bool = False


def upwards(x: float) -> float:
    """Return ``x`` rounded up to two digits.

    >>> upwards(1.2301), upwards(0.0), upwards(11.0), upwards(5.51e-29)
    (1.3, 0.0, 11.0, 5.6e-29)
    """
    if x == 0 or not math.isfinite(x):
        return x
    exact = Decimal(x)
    unit = Decimal(1).scaleb(exact.adjusted() - DIGITS + 1)
    return float(exact.quantize(unit, ROUND_CEILING))


def should(
    by: Sampled,
    functions: Sequence[Program],
    each: Sequence[Sample],
    arithmetic: Arithmetic = BALLS,
) -> Iterator[tuple[Program, list[list[Expected]]]]:
    """Yield each function of the lecture with what its components should be, sample by sample."""
    for base, equations in by.equations.items():
        own = [f for f in functions if base_of(f) == base]
        columns = tuple(dict.fromkeys(c for f in own for c in columns_of(f)))
        if not own:
            continue
        true = references(equations, [s.values for s in each], columns, arithmetic)
        for program in own:
            yield program, _by_sample(program, true, len(each))


def _by_sample(program: Program, true: References, count: int) -> list[list[Expected]]:
    """Return what each component should be, a row a sample."""
    columns = [
        (np.broadcast_to(x, count).tolist() for x in (value, scale, true.gains[row]))
        for row, value, scale in entries(program, true.known)
    ]
    each = [[Expected(*of) for of in zip(*parts, strict=True)] for parts in columns]
    return [list(row) for row in zip(*each, strict=True)]


def should_move(by: Sampled, program: Program, each: Sequence[Sample]) -> list[list[Expected]]:
    """Return what each component of a function of motion should be, sample by sample."""
    dtype = by.precision.dtype
    true = [[x.mid() for x in exact(by.library, program, s)] for s in each]
    own: dict[str, Any] = {c: np.array([s.values[c] for s in each], dtype) for c in each[0].values}
    with np.errstate(all="ignore"):
        wide = supplied(by.setup, own, arithmetics(dtype)).wide
        values = [np.array([float(row[k]) for row in true]) for k in range(len(true[0]))]
        scales = [np.broadcast_to(x, len(each)).tolist()
                  for x in motion_scales(by, planned(program), wide, values)]  # fmt: skip
    return [
        [Expected(x, size, whole=w) for x, size, w in zip(row, at, around(program), strict=True)]
        for row, at in zip(true, zip(*scales, strict=True), strict=True)
    ]


def exact(library: Library, program: Program, sample: Sample) -> list[Any]:
    """Return the results of a program at a sample, in balls, from the scene's parameters on."""
    with ctx.workprec(BITS):
        values = {name: arb(x) for name, x in sample.values.items()}
        return list(results(library, program, values).values())


def results(library: Library, program: Program, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a program gives, in balls, from the scene's parameters on."""
    constants = results_by_name(library.setup, LONG_FLOATS, values)
    return results_by_name(program, LONG_FLOATS, {**values, **constants})


def replayed(
    library: Library, each: Sequence[Sample], precision: Precision, arithmetic: Arithmetic
) -> dict[str, list[NDArray[Any]]]:
    """Return the results of every program at all samples, in C's ``arithmetic``."""
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
            p.name: _replay(p, pairs if p.arithmetic == "pairs" else arithmetic, known)
            for p in library.printed()
        }


def _replay(program: Program, by: Arithmetic, known: Mapping[str, NDArray[Any]]) -> list[Any]:
    given = [known[c] for q in program.inputs for c in q.components]
    if program.arithmetic != "pairs":
        return run(program, by, given)
    return [r[0] for r in run(program, by, paired(np.array(given)))]


def errors(
    program: Program,
    returned: Sequence[Any],
    true: Sequence[Sequence[Expected]],
    precision: Precision,
) -> list[Errors]:
    """Return the errors of each measured output of a function, from its results by component."""
    columns = [np.broadcast_to(r, len(true)).tolist() for r in returned]
    return [
        Errors(
            program.name,
            q.name,
            tuple(
                tuple(
                    error(column[n], one, precision)
                    for column, one in zip(columns[span], row[span], strict=True)
                )
                for n, row in enumerate(true)
            ),
        )
        for q, span in measured_outputs(program)
    ]


def error(found: float, true: Expected, precision: Precision) -> float:
    """Return how far ``found`` is from what it should be, in u of the largest product."""
    if not (math.isfinite(found) and true.value.is_finite() and math.isfinite(true.scale)):
        return math.inf  # samples lie where every function has a value
    smallest = float(np.finfo(precision.dtype).smallest_normal)
    with ctx.workprec(BITS):
        gap = arb(found) - true.value
        if true.whole:
            turn = 2 * arb.pi()
            gap -= turn * round(float(gap / turn))
        wrong = gap.mid() / arb(max(true.scale, smallest * true.gain))
        return abs(float(wrong)) / precision.unit_roundoff
