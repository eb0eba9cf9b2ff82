"""The functions of motion beside the motion that the lecture's equations give.

Orders are measured in balls of 500 bits, so they are free of rounding; what rounding does is
``motion_accuracy``'s part. Power and momentum need no reference: without torque they are kept.
"""

from collections.abc import Iterator, Sequence

from derive.check.verdict import JUDGED, Verdict
from derive.library.library import Library
from derive.program.largest import largest
from derive.scene.wanted import COMPENSATED, STEP_FUNCTIONS
from derive.verify.convergence import BITS, CLOSED_FORM, LEVELS, course, exactness, order
from derive.verify.differences import GAP, slopes
from derive.verify.sample import Sample

FEW = 2


def orders_hold(library: Library, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether every step converges as fast as it claims, and every flow is exact."""
    ordinary = [s for s in each if s.kind == "ordinary"][:FEW]
    for program in library.motions:
        if program.name == "flow_exact":
            yield _exact(library, ordinary)
        elif program.name in (*STEP_FUNCTIONS, *COMPENSATED):
            yield _order(library, program.name, ordinary)


def _exact(library: Library, each: Sequence[Sample]) -> Verdict:
    worst = largest(exactness(library, s.values) for s in each)
    says = f"relative error {worst:.1g} without rounding, {BITS} bits, {LEVELS} levels"
    outcome = JUDGED[worst <= CLOSED_FORM]
    return Verdict(library.scene.name, "flow_exact", "exact", "is the motion", outcome, says)


def _order(library: Library, name: str, each: Sequence[Sample]) -> Verdict:
    found = [order(library, name, course(library, name, s.values)) for s in each]
    measured = ", ".join(map(str, found))
    claimed = f"claimed {found[0].claimed}, measured {measured}"
    says = f"in closed form, errors {measured}" if found[0].closed else claimed
    outcome = JUDGED[all(one.holds for one in found)]
    return Verdict(library.scene.name, name, "exact", "order", outcome, says)


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
