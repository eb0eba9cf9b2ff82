"""The proved bounds of every output of every function, beside the largest errors that are seen.

Proved is how far a function's result may be from what the same program gives without rounding,
parameters and inputs being floats of their declared ranges: absolute, the largest of an output's
components. What cannot be proved says why.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from derive.library.library import Library
from derive.motion.compensated import REMAINDER
from derive.program.precision import F32, PRECISIONS, Precision
from derive.program.program import Bound, Program, Quantity
from derive.verify.columns import planned
from derive.verify.draw import Dice, Sampled
from derive.verify.measure import upwards
from derive.verify.operators import Column
from derive.verify.proved.cut import UNIT, Cells, Cutting, Region
from derive.verify.proved.enclosed import BROAD
from derive.verify.proved.seen import SEARCH, Search, seen
from derive.verify.proved.traits import Traits, choice_name, traits
from derive.verify.proved.unfolded import Operation, unfolded
from derive.verify.scale import measured_outputs
from derive.verify.search import SAMPLING, Sampling

WORK = 48_000_000
"""Operations, of a box for a result, after which no part is cut any more."""
LONGEST = 2000
"""Operations of a function that bounds are tried of."""
WHY = {
    "atan2": "angles of atan2 have no enclosure here",
    "floor": "a whole number next to a value may be another for a rounded one",
    "low": "what rounding leaves of a value has no bound here",
    "select": "a choice between values may turn out otherwise for rounded ones",
    "div": "a divisor may vanish for all that ranges tell",
    "sqrt": "a root may be of nothing for all that ranges tell",
    "sin": "an angle may be beyond those that sines of our own serve",
    "cos": "an angle may be beyond those that sines of our own serve",
}


class UnprovedError(ValueError):
    """Why a function has no proved bound, in one sentence."""


@dataclass(frozen=True)
class Proof:
    """How bounds are come by: the work of a function, and the search for what is seen."""

    work: int = WORK
    search: Search = SEARCH


PROOF = Proof()


def proof_of(sampling: Sampling) -> Proof:
    """Return how bounds are come by where errors are sampled so widely."""
    if sampling.samples >= SAMPLING.samples:
        return PROOF
    share = sampling.samples / SAMPLING.samples
    few = Search(max(256, int(SEARCH.samples * share)), SEARCH.rounds // 2, 512)
    return Proof(max(WORK // 128, int(WORK * share)), few)


def proved_bounds(library: Library, by: Proof) -> tuple[Bound, ...]:
    """Return the bound of every measured output of every function, in both precisions."""
    return tuple(b for program in library.printed() for b in bounds_of(library, program, by))


def bounds_of(library: Library, program: Program, by: Proof) -> Iterator[Bound]:
    """Yield the bounds of a function: parts cut for float serve double as well."""
    parts: Cells | None = None
    for precision in PRECISIONS:
        outputs = [q.name for q, _ in measured_outputs(program)]
        try:
            at = cutting(library, program, precision, by.work)
            parts = at.run() if parts is None else at.valued(parts.lows, parts.highs)
            proved, names = _largest(at, parts, program), at.box.names
        except UnprovedError as why:
            yield from (Bound(program.name, precision.name, o, why=str(why)) for o in outputs)
            continue
        found = seen(
            Sampled(library, precision), planned(program), (names, _worst(at, parts)), by.search
        )
        for output, most, off in zip(outputs, proved, found, strict=True):
            told = upwards(most), float(f"{off:.1e}")
            yield Bound(program.name, precision.name, output, *told, assumed(at))


def cutting(library: Library, program: Program, precision: Precision, work: int) -> Cutting:
    """Return what bounds a function. Raises UnprovedError where no bound is tried."""
    if any(q.role == "plan" for q in program.inputs):
        raise UnprovedError("its plan, of another function, has no enclosure here")
    trace = unfolded(library, program, precision.bits)
    if len(trace.steps) > LONGEST:
        raise UnprovedError(f"{len(trace.steps)} operations are more than the {LONGEST} tried")
    whole = any(q.is_quaternion for q in program.inputs)
    of = traits(trace, precision, quaternions=whole)
    name = f"derive: {library.scene.name} {F32.name} bound {program.name}"
    outputs = [span for _, span in measured_outputs(program)]
    return Cutting(of, box(library, program, of), work, Dice(name), outputs)


def box(library: Library, program: Program, of: Traits) -> Region:
    """Return the ranges of what a function is given, parameters among it, and of its choices."""
    every = (*library.setup.inputs, *program.inputs)
    quantities = {c: q for q in every for c in q.components if q.role != "constants"}
    names = tuple(s.name for s in of.trace.steps if s.operator == "given")
    ends = [ends_in_floats(quantities, c, of.precision) for c in names]
    ends += [(0.0, 1.0)] * len(of.choices)
    low, high = np.array(ends).reshape(len(ends), 2).T
    whole = [q.components for q in program.inputs if q.is_quaternion]
    places = [tuple(map(names.index, each)) for each in whole if set(each) <= set(names)]
    return Region((*names, *map(choice_name, of.choices)), low, high, tuple(places))


def ends_in_floats(of: dict[str, Quantity], name: str, precision: Precision) -> tuple[float, float]:
    """Return the ends of a range; a remainder is at most what rounding leaves of its state."""
    q = of[name]
    if q.role != "remainder":
        low, high = map(float, q.ends)
        # a float of the range may be next to an end that is none
        return low - abs(low) * 2.0**-52, high + abs(high) * 2.0**-52
    state = of.get(name.removeprefix(f"{REMAINDER}_"))
    most = max(map(abs, map(float, state.ends))) if state else np.inf
    return -most * precision.unit_roundoff, most * precision.unit_roundoff


def _largest(at: Cutting, parts: Cells, program: Program) -> list[float]:
    """Return the bound of each measured output. Raises UnprovedError if it has none."""
    each = parts.shifts.max(axis=1, initial=0.0)
    found = [float(each[span].max()) for _, span in measured_outputs(program)]
    if not np.all(np.isfinite(found)):
        steps = at.traits.trace.steps
        raise UnprovedError(_why([steps[n] for n in np.unique(parts.blamed) if n >= 0]))
    return found


def _why(steps: list[Operation]) -> str:
    for step in steps:
        if step.operator in WHY:
            return WHY[step.operator] + (", in set-up" if step.origin == "pairs" else "")
    return "ranges of its values grow beyond all measure"


def _worst(at: Cutting, parts: Cells, count: int = 96) -> Column:
    """Return points of the parts with the largest bounds: corners, and points between."""
    order = np.argsort(-at.scores(parts), kind="stable")[:count]
    which = np.resize(order, 8 * count)
    dice = at.dice.uniform(len(at.box.names), len(which))
    dice[:, : 4 * count] = np.round(dice[:, : 4 * count])
    return np.asarray(parts.lows[:, which] + (parts.highs - parts.lows)[:, which] * dice)


def assumed(at: Cutting) -> tuple[str, ...]:
    """Return what a bound assumes beside the ranges."""
    kinds = {s.operator for s in at.traits.trace.steps if s.origin == "working"}
    says = []
    if at.box.quaternions:
        says.append(f"quaternions given with |q|^2 in {UNIT[0]:g} .. {UNIT[1]:g}")
    if at.traits.lengths:
        says.append(f"divisors |q|^2 in {BROAD[0]:g} .. {BROAD[1]:g}")
    if kinds & {"sin", "cos"}:
        says.append("sines and cosines of our own within 0.79 ulp")
    if "power_of_two" in kinds:
        says.append("scaling by any power of two gives the same")
    return tuple(says)
