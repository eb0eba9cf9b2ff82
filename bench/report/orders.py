"""The order at which a stepper converges, measured on what was emitted and compared with its claim.

One step is compared with ``PARTS`` steps of the same stepper over the same time, whose error is
smaller by PARTS^order; the slope of log(difference) over log(step) is the order plus one. One step
gathers no rounding, so steps may be short enough to see the order itself.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from bench.motion.case import Case
from bench.motion.ours import parameters, scenes_for
from bench.motion.runner import Job, Mover, moved
from bench.motion.wrong import ROUNDOFF
from bench.report.case_run import Workshop, adaptive
from derive.program.added import added

CLAIMED = {
    "step_rk4": 4, "step_lie": 4, "step_split2": 2, "step_split": 4, "step_split6": 6,
    "step_dmv": 10, "step_taylor": 20,
}  # fmt: skip
CLAIMED |= {f"step_taylor{n}": n for n in range(12, 20)}
CASES = ("asym_ii_generic", "heavy_top_asymmetric")
FLOOR = 200 * ROUNDOFF["f64"]  # differences below may be rounding
LARGEST = 1e-4  # differences above are outside the range of convergence
FALL = 4.0  # of the difference, from one step to the next finer one
COARSEST, PARTS = 2.0, 16  # rad a step; steps that one step is compared with
LEAST, MOST = 3, 6  # points that make a slope
TRIES = 60
SLACK = 0.05  # of the order, for terms of higher order that are still seen


@dataclass(frozen=True)
class Order:
    """A measured order. ``measured`` is NaN where fewer than ``LEAST`` points are in range."""

    method: str
    case: str
    claimed: int
    measured: float
    points: int

    @property
    def agrees(self) -> bool:
        """Tell whether the order is the claimed one."""
        return abs(self.measured - self.claimed) <= max(0.15, SLACK * self.claimed)


def slope(steps: Sequence[float], errors: Sequence[float]) -> float:
    """Return the slope of log(error) over log(step) by least squares; NaN for too few points.

    >>> round(slope([1.0, 0.5, 0.25], [1e-2, 1e-2 / 16, 1e-2 / 256]), 6)
    4.0
    """
    if len(steps) < LEAST:
        return math.nan
    x, y = [math.log(s) for s in steps], [math.log(e) for e in errors]
    mean_x, mean_y = added(x) / len(x), added(y) / len(y)
    above = added((a - mean_x) * (b - mean_y) for a, b in zip(x, y, strict=True))
    return above / added((a - mean_x) ** 2 for a in x)


def measured(method: str, case: Case, found: Sequence[tuple[float, float]]) -> Order:
    """Return the order from (step, difference) pairs, coarse to fine: the finest in range."""
    inside = [(h, e) for h, e in found if FLOOR <= e <= LARGEST][-MOST:]
    order = slope([h for h, _ in inside], [e for _, e in inside]) - 1
    return Order(method, case.name, CLAIMED[base(method)], order, len(inside))


def base(method: str) -> str:
    """Return the stepper whose order a method has.

    >>> base("step_split6_compensated")
    'step_split6'
    """
    return method.removesuffix("_compensated")


def orders(every: Mapping[str, Case], shop: Workshop) -> Iterator[Order]:
    """Yield the order of every stepper of ours on a torque-free and a torqued case, in double."""
    for case in (every[name] for name in CASES):
        scene = scenes_for(case)[0]
        mover = shop.movers.get((scene, "f64"))
        if isinstance(mover, Mover):
            given = parameters(shop.emissions[scene], case)
            for method in mover.methods:
                if base(method) in CLAIMED and not adaptive(method):
                    yield measured(method, case, list(_errors(mover, case, given, method)))


def _errors(
    mover: Mover, case: Case, given: Sequence[float], method: str
) -> Iterator[tuple[float, float]]:
    """Yield (step, difference), coarse to fine, until differences may be rounding."""
    step, ratio = COARSEST / case.rate, FALL ** (1 / (CLAIMED[base(method)] + 1))
    for _ in range(TRIES):
        jobs = [Job(method, step, 1), Job(method, step / PARTS, PARTS)]
        one, many = moved(mover, case, given, jobs)
        if one is None or many is None:
            return
        found = _apart(one.states[-1], many.states[-1], case.rate)
        if math.isfinite(found):
            yield step, found
            if found < FLOOR:
                return
        step /= ratio


def _apart(a: Sequence[float], b: Sequence[float], rate: float) -> float:
    """Return the difference of two states: attitudes and relative omegas together."""
    scales = (*[1.0] * 4, *[rate] * 3)
    return math.hypot(*((x - y) / s for x, y, s in zip(a, b, scales, strict=True)))
