"""What errors are counted in: how large the terms of every output are, sample by sample.

A function of the lecture: the largest product in the equation that the output solves, multiplied
out, by the lecture's own equations, or the output itself where it is larger. A step: the largest
component, before and after, or the largest product of what the step adds. A flow: kappa times its
largest component. No scale knows how a program is arranged.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import reduce
from typing import Any

import numpy as np
from flint import arb

from derive.motion.runge_kutta.system import FLOW, NEXT
from derive.program.program import Program, Quantity, component_names, placed
from derive.scene.wanted import JACOBIAN
from derive.verify.columns import Plan, arithmetics, doubles, in_columns, supplied
from derive.verify.draw import Sampled
from derive.verify.gains import gains
from derive.verify.hard_bodies import BODIES
from derive.verify.operators import IN_DOUBLES, Column
from derive.verify.sample import Sample, Samples
from derive.verify.solution import Solved, solution

ANGLES = "angles"
STATE_RATE = "state_rate"
UNMEASURED = ("remainder_next", "step_proposed")
"""What rounding left, and a length that is proposed: neither has a true value."""
CHANGED = 2.0**-26
"""Relative change of an input that tells how much of it an output magnifies."""
NOTHING = 1e-60
"""A part this much smaller than the rest of a plan is what rounding left, and has no true value."""

SLICE = 512
"""Samples whose matrices are inverted at a time."""
InDouble = Mapping[str, Column]


def _inverse(rows: Sequence[Sequence[Any]]) -> list[list[Any]]:
    """Return the inverses of matrices, entry by entry: Gauss and Jordan, pivots by sample."""
    n = len(rows)
    flat = np.broadcast_arrays(*(np.asarray(x, np.float64) for row in rows for x in row))
    whole = np.reshape(flat, (n, n, *flat[0].shape))
    if whole.ndim == 2:
        return [list(row) for row in _inverted(whole[..., None])[..., 0]]
    parts = [_inverted(whole[..., k : k + SLICE]) for k in range(0, whole.shape[-1], SLICE)]
    return [list(row) for row in np.concatenate([whole[..., :0], *parts], axis=-1)]


def _inverted(matrix: Column) -> Column:
    """Return the inverses of matrices, (n, n, samples), so few that they stay in the cache."""
    n, count = matrix.shape[1:]
    m = np.zeros((n, 2 * n, count))
    m[:, :n] = matrix
    m[range(n), range(n, 2 * n)] = 1.0
    for i in range(n):
        _pivoted(m, i)
        m[i] = m[i] / m[i, i]
        for k in range(n):
            if k != i:
                m[k, i + 1 :] -= m[k, i] * m[i, i + 1 :]  # before it, nobody reads on
    return m[:, n:]


def _pivoted(m: Column, i: int) -> None:
    """Bring the largest entry of column ``i``, from row ``i`` on, to row ``i``."""
    best = np.argmax(np.abs(m[i:, i]), axis=0)
    for k in np.unique(best[best > 0]):
        here = best == k
        m[i, :, here], m[i + k, :, here] = m[i + k, :, here], m[i, :, here]


DOUBLES: dict[str, Callable[..., Any]] = {
    **IN_DOUBLES,
    "inverse": _inverse,
    "size": np.abs,
    "coefficient": lambda products: reduce(np.maximum, map(np.abs, products)),
    "most": np.maximum,
    "unless_zero": lambda size, other: np.where(size == 0, other, size),
}
"""Doubles in columns, for what needs two digits: how large terms are."""


def measured_outputs(program: Program) -> list[tuple[Quantity, slice]]:
    """Return the outputs that have a true value, and where their components stand."""
    return [(q, span) for q, span in placed(program.outputs) if q.name not in UNMEASURED]


def around(program: Program) -> list[bool]:
    """Tell of each component whether it is the same a turn later: -pi and pi are one angle."""
    return [q.name == ANGLES for q in program.outputs for _ in q.components]


def base_of(program: Program) -> str:
    """Return the function of the lecture that a program is, or is the Jacobian of."""
    return program.name.removesuffix(JACOBIAN)


def columns_of(program: Program) -> tuple[str, ...]:
    """Return the columns of a program's Jacobian."""
    return tuple(c for pattern in (program.sparsity or {}).values() for c in pattern.columns)


def entries(program: Program, found: Mapping[str, Solved]) -> Iterator[tuple[str, Any, Any]]:
    """Yield of each component of a function of the lecture whose it is, value, largest product."""
    for q in program.outputs:
        pattern = (program.sparsity or {}).get(q.name)
        if pattern is None:
            yield from ((c, found[c].value, found[c].scale) for c in q.components)
            continue
        for i, k in pattern.places():
            row = pattern.rows[i]
            yield (row, *found[row].slopes.get(pattern.columns[k], (arb(0), 0.0)))


def lecture_scales(by: Sampled, program: Program, wide: InDouble) -> list[Column]:
    """Return the largest product in the equation of each component of a function of the lecture."""
    solved = solution(by.equations[base_of(program)], wide, columns_of(program), DOUBLES)
    every = [(row, scale) for row, _, scale in entries(program, solved.unknowns())]
    most = gains(solved, DOUBLES, _ends)
    if all(_ends(scale)[0] >= by.smallest * most[row] for row, scale in every):
        return [np.asarray(scale) for _, scale in every]
    gained = gains(solved, DOUBLES, lambda size: (size, size))
    return [np.maximum(scale, by.smallest * gained[row]) for row, scale in every]


def _ends(sizes: Column) -> tuple[float, float]:
    """Return the smallest and the largest of sizes."""
    return float(np.min(sizes, initial=np.inf)), float(np.max(sizes, initial=0.0))


def with_values(of: Sampled, drawn: Samples) -> Samples:
    """Return samples without the hard bodies at which a function of the lecture has no value.

    The wobble of a sphere has no period.
    """
    hard = {body.kind for body in BODIES}
    if not hard & {s.kind for s in drawn.each}:
        return drawn
    valued = zip(drawn.each, _have_values(of, drawn.each), strict=True)
    each = [s for s, fits in valued if fits or s.kind not in hard]
    lost = {s.kind for s in drawn.each} - {s.kind for s in each}
    kept = tuple(replace(s, number=n) for n, s in enumerate(each))
    return Samples(kept, (*drawn.skipped, *(b.kind for b in BODIES if b.kind in lost)))


def _have_values(of: Sampled, each: Sequence[Sample]) -> Sequence[bool]:
    """Tell of each sample whether all functions of the lecture have a value there."""
    dtype = of.precision.dtype
    own: dict[str, Column] = {
        c: np.array([s.values[c] for s in each], dtype) for c in each[0].values
    }
    with np.errstate(all="ignore"):
        wide = supplied(of.setup, own, arithmetics(dtype)).wide
        sizes = [x for f in of.library.functions for x in lecture_scales(of, f, wide)]
    fits = [np.broadcast_to(np.isfinite(x), len(each)) for x in sizes]
    found: list[bool] = np.all([np.full(len(each), fill_value=True), *fits], axis=0).tolist()
    return found


def motion_scales(by: Sampled, plan: Plan, wide: InDouble, true: Sequence[Column]) -> list[Column]:
    """Return the scale of each component of a function of motion, from its true values."""
    program, sizes = plan.program, [np.abs(x) for x in true]
    if program.name == FLOW:
        return _magnified(by, plan, wide, sizes)
    added = _added(by, wide) if any(q.name.endswith(NEXT) for q in program.outputs) else {}
    scales: list[Column] = []
    for q, span in placed(program.outputs):
        own = sizes[span]
        before = [added[c] for c in _states_of(q) if c in added]
        most = reduce(np.maximum, (*own, *before), np.asarray(by.smallest))
        if q.role == "plan":
            scales += [np.where(x > most * NOTHING, np.maximum(x, by.smallest), most) for x in own]
        else:
            scales += [most] * len(own)
    return scales


def _states_of(q: Quantity) -> list[str]:
    """Return the components of the state that an output is after the step."""
    return [c.replace(NEXT, "") for c in q.components] if q.name.endswith(NEXT) else []


def _added(by: Sampled, wide: InDouble) -> dict[str, Column]:
    """Return the largest term of each state in a step: it, and what the step adds to it.

    What is added is sized twice: a rate may be made of states that themselves begin at zero.
    """
    names = [c for q in by.library.vocabulary.states for c in q.components]
    largest = {c: np.abs(wide[c]) for c in names if c in wide}
    if STATE_RATE not in by.equations or "time_step" not in wide:
        return largest
    rates = [c for q in by.library.problems[STATE_RATE].outputs for c in q.components]
    step = np.abs(wide["time_step"])
    for _ in range(2):
        found = solution(by.equations[STATE_RATE], wide, (), DOUBLES, largest).unknowns()
        grown = {c: step * found[rate].scale for c, rate in zip(names, rates, strict=True)}
        largest = {c: np.maximum(np.abs(wide[c]), grown[c]) for c in largest}
    return largest


def _magnified(by: Sampled, plan: Plan, wide: InDouble, sizes: Sequence[Column]) -> list[Column]:
    """Return kappa times the largest component of each output: what its inputs' changes make."""
    inputs = (*by.setup.program.inputs, *plan.program.inputs)
    names = {c: None for q in inputs for c in q.components if q.role != "constants"}
    start = _values(by, plan, wide)
    spans = [span for _, span in placed(plan.program.outputs)]
    total = [np.asarray(by.smallest) for _ in spans]
    for c in names:
        moved = _values(by, plan, dict(wide) | {c: wide[c] * (1 + CHANGED)})
        change = [np.abs(a - b) / CHANGED for a, b in zip(moved, start, strict=True)]
        total = [grown + reduce(np.maximum, change[span])
                 for grown, span in zip(total, spans, strict=True)]  # fmt: skip
    return [
        np.maximum(grown, reduce(np.maximum, sizes[span]))
        for grown, span in zip(total, spans, strict=True)
        for _ in sizes[span]
    ]


def _values(by: Sampled, plan: Plan, wide: InDouble) -> list[Any]:
    made = in_columns(by.setup, doubles(), wide)
    known = dict(wide) | dict(zip(component_names(by.setup.program), made, strict=True))
    return in_columns(plan, doubles(), known)
