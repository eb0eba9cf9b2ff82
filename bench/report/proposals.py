"""Taylor steps shorter than what they propose: whether they end nearer to the truth.

What is proposed is meant for an error of u in a step. A step of a part of it leaves out less, by
the order's power of that part; whether anything of it is seen beside rounding is measured here.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from bench.motion.case import Case
from bench.motion.ours import parameters, scenes_for
from bench.motion.runner import Job, Mover, moved
from bench.motion.wrong import ROUNDOFF, wrong
from bench.report.case_run import PRECISIONS, Workshop

METHOD, ORDER = "step_taylor_adaptive", 20
PARTS = (1.0, 0.95, 0.9, 0.8, 0.7, 0.5)
WHOLE = 1.0


@dataclass(frozen=True)
class Proposal:
    """The error at the end of a case, every step this part of what the one before proposes."""

    case: str
    scene: str
    precision: str
    part: float
    passes: int
    error: float


def proposals(every: Mapping[str, Case], shop: Workshop) -> Iterator[Proposal]:
    """Yield what each part makes of every case, in every scene that describes it."""
    for case in every.values():
        for scene in scenes_for(case):
            for precision in PRECISIONS:
                mover = shop.movers.get((scene, precision))
                if isinstance(mover, Mover) and METHOD in mover.methods:
                    yield from _parts(case, scene, precision, mover, shop)


def _parts(
    case: Case, scene: str, precision: str, mover: Mover, shop: Workshop
) -> Iterator[Proposal]:
    """Yield the errors with every part: a tolerance of part^order u is a step of that part."""
    jobs = [Job(METHOD, ROUNDOFF[precision] * part**ORDER, 1) for part in PARTS]
    found = moved(mover, case, parameters(shop.emissions[scene], case), jobs)
    for part, motion in zip(PARTS, found, strict=True):
        if motion is not None:
            error = wrong(case, motion.states[-1]).state
            yield Proposal(case.name, scene, precision, part, motion.passes, error)


def proposal_says(rows: Sequence[Proposal]) -> list[str]:
    """Return, for each shorter part, how often it ends nearer than the whole proposal, and by what.

    The median is of the error with the whole proposal over that with the part.
    """
    known = {(r.case, r.scene, r.precision, r.part): r.error for r in rows}
    parts = dict.fromkeys(r.part for r in rows if r.part != WHOLE)
    return [_says(part, known) for part in parts]


def _says(part: float, known: Mapping[tuple[str, str, str, float], float]) -> str:
    ratios = [
        whole / own
        for (case, scene, precision, each), own in known.items()
        if each == part and own > 0
        for whole in [known.get((case, scene, precision, WHOLE), math.nan)]
        if math.isfinite(whole / own)
    ]
    nearer = sum(ratio > 1 for ratio in ratios)
    return (
        f"{part:g} of the proposal: nearer in {nearer} of {len(ratios)} motions, in the median "
        f"{median(ratios):.2g} times"
    )
