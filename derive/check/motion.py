"""The functions of motion beside the motion that the lecture's equations give.

Orders are measured in balls of 500 bits, so they are free of rounding; what rounding does is
``motion_accuracy``'s part. Power and momentum need no reference: without torque they are kept.
"""

from collections.abc import Iterator, Sequence
from typing import Any

from flint import arb, ctx
from mpmath import mp

from derive.check.particles import digits, fulfilling
from derive.check.verdict import JUDGED, Verdict
from derive.library.library import Library
from derive.program.largest import largest
from derive.scene.wanted import COMPENSATED, STEP_FUNCTIONS, step_of
from derive.verify.cloud import CloudAnswers
from derive.verify.cloud.series import DIGITS
from derive.verify.convergence import (
    BITS,
    CLAIMED,
    CLOSED_FORM,
    LEVELS,
    Course,
    course,
    exactness,
    order,
    right_hand_side,
    stepped,
)
from derive.verify.differences import GAP, slopes
from derive.verify.sample import Sample

FEW = 2
PART, LEFT = 0.02, 1e-25
"""What two corrections leave at most where states move by a part of their ranges: the fourth power
of what the step is off by, some 1e-7."""


def orders_hold(library: Library, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether every step converges as fast as it claims, and every flow is exact.

    Motions of machines with constraints begin where these hold, and steps end there.
    """
    ordinary = [s for s in each if s.kind == "ordinary"][:FEW]
    ordinary = list(fulfilling(library.scene, ordinary)) if library.motions else ordinary
    for program in library.motions:
        if program.name == "flow_exact":
            yield _exact(library, ordinary)
        elif program.name in (*STEP_FUNCTIONS, *COMPENSATED):
            yield from _order(library, program.name, ordinary)


def _exact(library: Library, each: Sequence[Sample]) -> Verdict:
    worst = largest(exactness(library, s.values) for s in each)
    says = f"relative error {worst:.1g} without rounding, {BITS} bits, {LEVELS} levels"
    outcome = JUDGED[worst <= CLOSED_FORM]
    return Verdict(library.scene.name, "flow_exact", "exact", "is the motion", outcome, says)


def _order(library: Library, name: str, each: Sequence[Sample]) -> Iterator[Verdict]:
    courses = [course(library, name, s.values) for s in each]
    found = [order(library, name, one) for one in courses]
    measured = ", ".join(map(str, found))
    closed = any(one.closed for one in found)
    claimed = f"claimed {CLAIMED[step_of(name)]}, measured {measured}"
    says = f"in closed form, errors {measured}" if closed else claimed
    outcome = JUDGED[all(one.holds for one in found)]
    if not found:
        outcome, says = "skipped", "no state was found at which the constraints hold"
    yield Verdict(library.scene.name, name, "exact", "order", outcome, says)
    if found and library.scene.constraints:
        yield _ends_on_constraints(library, name, courses)


def _ends_on_constraints(library: Library, name: str, each: Sequence[Course]) -> Verdict:
    """Return whether constraints hold after a step, by what a cloud of particles says of them."""
    worst = 0.0
    for one in each:
        with ctx.workprec(BITS):
            states = [c for q in library.vocabulary.states for c in q.components]
            after = stepped(library, name, one.given, _length(library, one))
            there = dict(one.given) | {c: after[f"{c}_next"] for c in states}
        with mp.workdps(DIGITS):
            cloud = CloudAnswers(library.scene, {n: digits(x) for n, x in there.items()})
            worst = largest([worst, *map(abs, cloud.distances.values())])
    says = f"{worst:.1g} in SI units is left of the constraints, in {BITS} bits"
    row = (library.scene.name, name, "exact", "ends on the constraints")
    return Verdict(*row, JUDGED[worst < LEFT], says)


def _length(library: Library, one: Course) -> Any:
    """Return a length of step in which no state moves by more than a part of its range."""
    sizes = [float(q.ends[1] - q.ends[0]) for q in library.vocabulary.states for _ in q.components]
    start = [one.given[c] for q in library.vocabulary.states for c in q.components]
    rates = right_hand_side(library, one.given)(start)
    return arb(PART / largest(abs(float(r)) / s for r, s in zip(rates, sizes, strict=True)))


def step_slopes_hold(library: Library, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether the derivatives of every step are the slopes of the step."""
    ordinary = [s for s in each if s.kind == "ordinary"][:1]
    for program in library.motions:
        if program.sparsity:
            found = [slope for s in ordinary for slope in slopes(library, program, s.values)]
            worst = max(found, key=lambda slope: largest([slope.gap]))
            where = f"d({worst.row})/d({worst.column})"
            says = f"{len(found)} slopes, largest gap {worst.gap:.1g} at {where}"
            outcome = JUDGED[worst.gap <= GAP]
            name = library.scene.name
            yield Verdict(name, program.name, "exact", "slopes", outcome, says)
