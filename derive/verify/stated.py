"""The errors that are stated of every output of every function, in both precisions.

The largest stands at one of the samples that are measured in balls: hard ones and a few ordinary
ones, the worst that the search found, and the worst motions of the hard bodies. The median is of
the samples of the ranges.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from derive.library.library import Library
from derive.program.arithmetic import working
from derive.program.largest import largest
from derive.program.precision import PRECISIONS, Precision
from derive.program.program import Measurement, Program
from derive.verify.draw import Sampled, complete, with_motion
from derive.verify.hard_bodies import BODIES
from derive.verify.measure import Errors, errors, replayed, should, should_move, upwards
from derive.verify.sample import Sample, Samples, samples
from derive.verify.scale import with_values
from derive.verify.search import Sampling, Worst, worst, worst_motions

KINDS = frozenset(hard.kind for hard in BODIES)
WITHIN = ("ordinary", "found")
"""The kinds of samples that lie in the declared ranges; the others are hard ones."""


def figures(library: Library, by: Sampling) -> tuple[Measurement, ...]:
    """Return the errors of every output of every function, both precisions."""
    return tuple(m for precision in PRECISIONS for m in _of_precision(library, precision, by))


def _of_precision(library: Library, precision: Precision, by: Sampling) -> Iterator[Measurement]:
    of = Sampled(library, precision)
    found = worst(of, by)
    plain, moving = (
        with_values(of, samples(library.mechanism, precision, *count)).each
        for count in ((by.balls, by.corners), (by.motion_balls, by.motion_corners))
    )
    moving = with_motion(library, moving, precision)
    bodies = [s for s in moving if s.kind in KINDS]
    for plan in of.plans:
        program = plan.program
        own = [w for w in found if w.function == program.name]
        hard = plain if program in library.functions else moving
        beside = worst_motions(of, plan, _raw(of, bodies), by.at_hard_bodies())
        rows = [*(w.rows for w in own), beside]
        each = with_values(of, Samples((*hard, *at_rows(of, rows, len(hard), bodies)), ())).each
        count = len(hard) + (by.at_hard_bodies().searched() if bodies else 0)
        for errors_, w in zip(at_samples(of, program, each), own, strict=True):
            yield _measurement(errors_, w, precision, each, by, count)


def _raw(of: Sampled, each: Sequence[Sample]) -> np.ndarray:
    """Return samples as raw columns, without remainders."""
    left = {c for q in of.quantities if q.role == "remainder" for c in q.components}
    rows = [[0.0 if name in left else s.values[name] for name in of.names] for s in each]
    return np.array(rows, np.float64).reshape(len(each), len(of.names)).T


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
    own = [x for x, s in zip(worst_, each, strict=True) if s.kind in WITHIN]
    return Measurement(
        found.function,
        precision.name,
        found.output,
        upwards(searched.median),
        upwards(largest(own or [0.0])),
        upwards(most),
        each[worst_.index(most)].number,
        each[worst_.index(most)].kind,
        by.samples,
        by.searched(),
        hard,
    )


def at_rows(
    of: Sampled, rows: Sequence[np.ndarray], first: int, bodies: Sequence[Sample] = ()
) -> list[Sample]:
    """Return raw columns as samples, complete, each once, numbered from ``first`` on.

    bodies : hard ones; a sample that has the parameters of one is of its kind
    """
    every = np.concatenate([np.zeros((len(of.names), 0)), *rows], axis=1)
    once = list(dict.fromkeys(map(tuple, every.T.tolist())))
    if not once:
        return []
    at = complete(of, np.array(once).T)
    columns = {name: column.tolist() for name, column in at.own.items()}
    own = [c for q in of.library.vocabulary.parameters for c in q.components]
    kinds = {tuple(s.values[c] for c in own): s.kind for s in bodies if own}
    found = [{name: column[n] for name, column in columns.items()} for n in range(len(once))]
    return [
        Sample(first + n, kinds.get(tuple(values[c] for c in own), "found"), values)
        for n, values in enumerate(found)
    ]


def at_samples(by: Sampled, program: Program, each: Sequence[Sample]) -> list[Errors]:
    """Return the errors of each measured output of a function, measured in balls."""
    only = replace(by.library, functions=(), motions=(program,))
    found = replayed(only, each, by.precision, working(by.precision.dtype))[program.name]
    if program not in by.library.functions:
        return errors(program, found, should_move(by, program, each), by.precision)
    ((_, true),) = should(by, (program,), each)
    return errors(program, found, true, by.precision)
