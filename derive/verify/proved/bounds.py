"""The proved bounds of every output of every function, beside the largest errors that are seen.

Proved is how far a function's result may be from what the same program gives without rounding,
parameters and inputs being floats of their declared ranges: absolute, the largest of an output's
components. What cannot be proved says why.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from derive.library.library import Library
from derive.motion.compensated import REMAINDER
from derive.program.precision import F32, PRECISIONS, Precision
from derive.program.program import Bound, Program, Quantity
from derive.verify.columns import planned
from derive.verify.draw import Dice, Sampled
from derive.verify.measure import upwards
from derive.verify.proved.cells import Cells
from derive.verify.proved.cut import Cutting, Region
from derive.verify.proved.enclosed import BROAD
from derive.verify.proved.seen import SEARCH, Search, seen
from derive.verify.proved.sphere import UNIT
from derive.verify.proved.traits import Traits, choice_name, traits
from derive.verify.proved.unfolded import Operation, pruned, unfolded
from derive.verify.proved.waist import bounded
from derive.verify.scale import measured_outputs
from derive.verify.search import SAMPLING, Sampling

WORK = 64_000_000
"""Operations, of a box for a result, of a function, after which no part is cut any more."""
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


@dataclass(frozen=True)
class Proved:
    """An output's bound over parts of the ranges, or why it has none."""

    name: str
    most: float = 0.0
    why: str = ""
    at: Cutting | None = None
    parts: tuple[Cells, ...] = ()


def bounds_of(library: Library, program: Program, by: Proof) -> Iterator[Bound]:
    """Yield the bounds of a function, output by output: what is found for float serves double."""
    each: list[Proved] = []
    for precision in PRECISIONS:
        each = _proved(library, program, precision, by.work, {p.name: p for p in each})
        peaks = [p.at.peaks for p in each if p.at and not p.why]
        off = [0.0] * len(each)
        if peaks:
            off = seen(Sampled(library, precision), planned(program), peaks, by.search)
        for one, found in zip(each, off, strict=True):
            place = program.name, precision.name, one.name
            if one.why or one.at is None:
                yield Bound(*place, why=one.why)
            else:
                yield Bound(*place, upwards(one.most), float(f"{found:.1e}"), assumed(one.at))


def _proved(
    library: Library,
    program: Program,
    precision: Precision,
    work: int,
    known: Mapping[str, Proved],
) -> list[Proved]:
    """Return the bound of each output: the short ones first, whose work is left to the others."""
    found, ahead = dict[str, Proved](), dict[str, Cutting]()
    for q, span in measured_outputs(program):
        try:
            ahead[q.name] = cutting(library, program, span, precision, work)
        except UnprovedError as why:
            found[q.name] = Proved(q.name, why=str(why))
    for name, at in sorted(ahead.items(), key=lambda item: item[1].price):
        at.work = work // (len(measured_outputs(program)) - len(found))
        before = known.get(name)
        if before and before.at and not before.why:
            at.highest = before.at.peaks.points
        parts = bounded(at, before.parts if before else ())
        found[name] = Proved(name, *_largest(at, parts[-1]), at, parts)
        work -= at.spent
    return [found[q.name] for q, _ in measured_outputs(program)]


def cutting(
    library: Library, program: Program, span: slice, precision: Precision, work: int
) -> Cutting:
    """Return what bounds an output of a function. Raises UnprovedError where no bound is tried."""
    if any(q.role == "plan" for q in program.inputs):
        raise UnprovedError("its plan, of another function, has no enclosure here")
    trace = unfolded(library, program, precision.bits)
    trace = pruned(trace.steps, trace.results[span])
    if len(trace.steps) > LONGEST:
        raise UnprovedError(f"{len(trace.steps)} operations are more than the {LONGEST} tried")
    of = traits(trace, precision, [q.components for q in program.inputs if q.is_quaternion])
    name = f"derive: {library.scene.name} {F32.name} bound {program.name}"
    return Cutting(of, box(library, program, of), work, Dice(name))


def box(library: Library, program: Program, of: Traits) -> Region:
    """Return the ranges of what a function is given, parameters among it, and of its choices."""
    every = (*library.setup.inputs, *program.inputs)
    quantities = {c: q for q in every for c in q.components if q.role != "constants"}
    names = tuple(s.name for s in of.trace.steps if s.operator == "given")
    ends = [ends_in_floats(quantities, c, of.precision) for c in names]
    ends += [(0.0, 1.0)] * len(of.choices)
    low, high = np.array(ends).reshape(len(ends), 2).T
    places = tuple(tuple(map(names.index, each)) for each in of.quaternions)
    return Region((*names, *map(choice_name, of.choices)), low, high, places)


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


def _largest(at: Cutting, parts: Cells) -> tuple[float, str]:
    """Return the bound of an output, or why it has none."""
    found = float(parts.shifts.max(initial=0.0))
    if np.isfinite(found):
        return found, ""
    steps = at.traits.trace.steps
    return found, _why([steps[n] for n in np.unique(parts.blamed) if n >= 0])


def _why(steps: list[Operation]) -> str:
    for step in steps:
        if step.operator in WHY:
            return WHY[step.operator] + (", in set-up" if step.origin == "pairs" else "")
    return "ranges of its values grow beyond all measure"


def assumed(at: Cutting) -> tuple[str, ...]:
    """Return what a bound assumes beside the ranges."""
    kinds = {s.operator for s in at.traits.trace.steps if s.origin == "working"}
    says = []
    if at.box.quaternions:
        says.append(f"quaternions given with |q|^2 in {UNIT[0]:g} .. {UNIT[1]:g}")
    if at.traits.lengths - set(at.traits.multiples):
        says.append(f"divisors |q|^2 in {BROAD[0]:g} .. {BROAD[1]:g}")
    if kinds & {"sin", "cos"}:
        says.append("sines and cosines of our own within 0.79 ulp")
    if "power_of_two" in kinds:
        says.append("scaling by any power of two gives the same")
    return tuple(says)
