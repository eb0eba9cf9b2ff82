"""How far rounding takes the functions of motion from what their own formulas say.

The same program is run in balls of 300 bits, set-up included, on the same inputs; the difference is
rounding alone. What a step leaves out by its order is another matter: tests measure the order, and
the report shows error against cost. What errors are counted in, ``scale`` says.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from flint import arb, ctx

from derive.library.library import Library
from derive.motion.compensated import REMAINDER
from derive.program.arithmetic import working
from derive.program.precision import Precision
from derive.program.program import Program, Quantity, component_names
from derive.program.run import run
from derive.verify.columns import arithmetics, known, planned
from derive.verify.measure import Errors, replayed
from derive.verify.operators import LONG_FLOATS
from derive.verify.reference import BITS
from derive.verify.sample import Sample, Source, Values, source, uniform
from derive.verify.scale import Sizing, around, measured_outputs, motion_scales

REACH = 0.3
"""Turn in rad, by omega and by its rate, that a sampled step covers at most."""
LONG = 1000.0
"""So many such steps make the longest time that a flow is sampled at."""
OMEGA_DOT = ("omega_dot_x", "omega_dot_y", "omega_dot_z")


def with_motion(
    library: Library, each: Sequence[Sample], precision: Precision
) -> tuple[Sample, ...]:
    """Return the samples with values for all that only the functions of motion are given."""
    dice = source(library.known, precision, "motion")
    own = [(c, q) for q in fresh_quantities(library) for c in q.components]
    drawn = [replace(s, values=s.values | {c: _drawn(dice, s, c, q) for c, q in own}) for s in each]
    rates = _omega_rates(library, drawn, precision)
    kept = tuple(
        replace(s, values={c: dice.held(x) for c, x in _in_reach(s.values, fast).items()})
        for s, fast in zip(drawn, rates, strict=True)
    )
    plans = any(q.role == "plan" for f in library.motions for q in f.inputs)
    return tuple(_planned(library, kept, precision)) if plans else kept


def fresh_quantities(library: Library) -> list[Quantity]:
    """Return what only the functions of motion are given, but for a plan, which is made."""
    known = {c for q in library.known.words.every() for c in q.components}
    known |= set(component_names(library.setup))
    given = {q.name: q for f in library.motions for q in f.inputs}
    return [q for q in given.values() if not known & set(q.components) and q.role != "plan"]


def telling(library: Library) -> list[Program]:
    """Return the functions, one or none, that tell how fast omega changes."""
    every = (*library.rates, *library.functions)
    return [f for f in every if any(q.name == "omega_dot" for q in f.outputs)][:1]


def _drawn(of: Source, sample: Sample, component: str, q: Quantity) -> float:
    """Return a number on a range; a remainder is what rounding may leave of its state."""
    if q.role != "remainder":
        return uniform(of.dice, q)
    state = sample.values[component.removeprefix(f"{REMAINDER}_")]
    return of.precision.unit_roundoff * abs(state) * (2 * of.dice.random() - 1)


def _omega_rates(library: Library, each: Sequence[Sample], precision: Precision) -> list[float]:
    """Return how fast omega changes at each sample, 0 where no function tells."""
    found = telling(library)
    if not found:
        return [0.0] * len(each)
    table = working(precision.dtype)
    (f,) = found
    columns = replayed(replace(library, functions=(f,), motions=()), each, precision, table)
    named = zip(component_names(f), columns[f.name], strict=True)
    own = [np.abs(np.broadcast_to(c, len(each))) for name, c in named if name in OMEGA_DOT]
    return [float(x) for x in np.max(np.nan_to_num(own), axis=0)]


def _in_reach(values: Values, fast: float) -> Values:
    """Return the values with times in which the body turns by no more than a step can take."""
    if "omega_x" not in values:
        return values
    omega = max(abs(values[f"omega_{axis}"]) for axis in "xyz")
    longest, long = (float(x) for x in bounds_of_times(omega, fast))
    step = min(values.get("time_step", 0.0), longest)
    time = max(-long, min(values.get("time", 0.0), long))
    return values | {c: x for c, x in (("time_step", step), ("time", time)) if c in values}


def bounds_of_times(omega: Any, fast: Any) -> tuple[Any, Any]:
    """Return the longest step, and the longest time of a flow, from omega and its rate."""
    longest = REACH / np.maximum(np.maximum(omega, np.sqrt(fast)), 1e-300)
    return longest, LONG * longest


def _planned(library: Library, each: Sequence[Sample], precision: Precision) -> Iterator[Sample]:
    """Yield the samples, each with the plan that the plan's own function makes of it."""
    (plan,) = (f for f in library.motions if f.makes("plan"))
    only = replace(library, functions=(), motions=(plan,))
    columns = replayed(only, each, precision, working(precision.dtype))[plan.name]
    rows = np.array([np.broadcast_to(c, len(each)) for c in columns]).T.tolist()
    names = component_names(plan)
    for s, row in zip(each, rows, strict=True):
        yield replace(s, values=s.values | dict(zip(names, row, strict=True)))


def motion_errors(
    by: Sizing,
    program: Program,
    columns: Sequence[Sequence[float]],
    each: Sequence[Sample],
    precision: Precision,
) -> Iterator[Errors]:
    """Yield the errors of each output, from the results by component and sample."""
    true = [[arb(x).mid() for x in exact(by.library, program, s)] for s in each]
    scales = _scales(by, program, true, each, precision)
    wholes = around(program)
    for q, span in measured_outputs(program):
        rows = tuple(
            tuple(
                _error(column[n], should, scale[n], whole) / precision.unit_roundoff
                for column, should, scale, whole in zip(
                    columns[span], true[n][span], scales[span], wholes[span], strict=True
                )
            )
            for n in range(len(each))
        )
        yield Errors(program.name, q.name, rows)


def _scales(
    by: Sizing,
    program: Program,
    true: Sequence[Sequence[Any]],
    each: Sequence[Sample],
    precision: Precision,
) -> list[list[float]]:
    """Return what errors are counted in: a row a component, a column a sample."""
    own: dict[str, Any] = {
        c: np.array([s.values[c] for s in each], precision.dtype) for c in each[0].values
    }
    with np.errstate(all="ignore"):
        wide = known(by.setup, own, arithmetics(precision.dtype)).wide
        values = [np.array([float(row[k]) for row in true]) for k in range(len(true[0]))]
        scales = motion_scales(by, planned(program), wide, values)
        return [np.broadcast_to(x, len(each)).tolist() for x in scales]


def exact(library: Library, program: Program, sample: Sample) -> list[Any]:
    """Return the results of a program at a sample, in balls, from the scene's parameters on."""
    with ctx.workprec(BITS):
        values = {name: arb(x) for name, x in sample.values.items()}
        setup = library.setup
        constants = run(setup, LONG_FLOATS, [values[c] for c in _inputs(setup)])
        values |= dict(zip(component_names(setup), constants, strict=True))
        return run(program, LONG_FLOATS, [values[c] for c in _inputs(program)])


def _inputs(program: Program) -> list[str]:
    return [c for q in program.inputs for c in q.components]


def _error(found: float, should: Any, scale: float, whole: object) -> float:
    if not (math.isfinite(found) and should.is_finite() and math.isfinite(scale)):
        return math.inf  # samples lie where every function has a value
    with ctx.workprec(BITS):
        gap = arb(found) - should
        if whole:
            turn = 2 * arb.pi()
            gap -= turn * round(float(gap / turn))
        return abs(float(gap / arb(scale)))
