"""The errors that are stated of every output of every function, in both precisions.

The largest stands at one of the samples that are measured in balls: hard ones and a few ordinary
ones, and the worst that the search found. The median is of the samples of the ranges.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from derive.library.library import Library
from derive.program.arithmetic import working
from derive.program.largest import largest
from derive.program.precision import PRECISIONS, Precision
from derive.program.program import Measurement, Program
from derive.verify.draw import Ranges, complete, completing, ranges
from derive.verify.measure import Errors, errors, replayed, upwards
from derive.verify.motion_error import motion_errors, with_motion
from derive.verify.reference import reference
from derive.verify.sample import Sample, samples
from derive.verify.scale import Sizing, base_of, columns_of, sizing
from derive.verify.search import Sampling, Worst, worst


@dataclass(frozen=True)
class Balls:
    """What measures a function in balls at given samples."""

    library: Library
    precision: Precision
    sizing: Sizing


def balls(library: Library, precision: Precision) -> Balls:
    """Return what measures the functions of a scene in balls."""
    smallest = float(np.finfo(precision.dtype).smallest_normal)
    return Balls(library, precision, sizing(library, smallest))


def figures(library: Library, by: Sampling) -> tuple[Measurement, ...]:
    """Return the errors of every output of every function, both precisions."""
    return tuple(m for precision in PRECISIONS for m in _of_precision(library, precision, by))


def _of_precision(library: Library, precision: Precision, by: Sampling) -> Iterator[Measurement]:
    found = worst(library, precision, by)
    measure = balls(library, precision)
    raw = ranges(library, precision)
    plain = samples(library.known, precision, by.balls, by.corners).each
    moving = samples(library.known, precision, by.motion_balls, by.motion_corners).each
    moving = with_motion(library, moving, precision) if library.motions else ()
    for program in library.printed():
        own = [w for w in found if w.function == program.name]
        hard = plain if program in library.functions else moving
        each = (*hard, *at_rows(raw, [w.rows for w in own], len(hard)))
        for errors_, w in zip(at_samples(measure, program, each), own, strict=True):
            yield _measurement(errors_, w, precision, each, by, len(hard))


def _measurement(
    found: Errors,
    searched: Worst,
    precision: Precision,
    each: Sequence[Sample],
    by: Sampling,
    hard: int,
) -> Measurement:
    worst_ = found.largest()
    most = largest(worst_)
    return Measurement(
        found.function,
        precision.name,
        found.output,
        upwards(searched.median),
        upwards(most),
        each[worst_.index(most)].number,
        each[worst_.index(most)].kind,
        by.samples,
        by.searched(),
        hard,
    )


def at_rows(of: Ranges, rows: Sequence[np.ndarray], first: int) -> list[Sample]:
    """Return raw columns as samples, complete, each once, numbered from ``first`` on."""
    every = np.concatenate([np.zeros((len(of.names), 0)), *rows], axis=1)
    once = list(dict.fromkeys(map(tuple, every.T.tolist())))
    if not once:
        return []
    at = complete(of, completing(of.library), np.array(once).T)
    columns = {name: column.tolist() for name, column in at.own.items()}
    return [
        Sample(first + n, "found", {name: column[n] for name, column in columns.items()})
        for n in range(len(once))
    ]


def at_samples(by: Balls, program: Program, each: Sequence[Sample]) -> list[Errors]:
    """Return the errors of each measured output of a function, measured in balls."""
    library, precision = by.library, by.precision
    lectured = program in library.functions
    only = replace(
        library,
        functions=(program,) if lectured else (),
        motions=() if lectured else (program,),
    )
    found = replayed(only, each, precision, working(precision.dtype))[program.name]
    if not lectured:
        columns = [np.broadcast_to(c, len(each)).tolist() for c in found]
        return list(motion_errors(by.sizing, program, columns, each, precision))
    asked = by.sizing.asked[base_of(program)]
    true = [reference(asked, s.values, columns_of(program)) for s in each]
    return list(errors(program, found, true, precision))
