"""The order at which a stepper converges, measured on what was emitted and compared with its claim.

The slope of log(error) over log(step) is fitted where the error is neither rounding nor so large
that the step is outside the stepper's range of convergence.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from derive.bench.motion.case import Case
from derive.bench.motion.ours import parameters, scenes_for
from derive.bench.motion.runner import Job, Mover, moved
from derive.bench.motion.wrong import ROUNDOFF, wrong
from derive.report.case_run import Workshop, adaptive
from derive.report.point import SMALL
from derive.report.settings import steps

CLAIMED = {
    "step_rk4": 4, "step_lie": 4, "step_split2": 2, "step_split": 4, "step_split6": 6,
    "step_dmv": 10, "step_taylor": 20,
}  # fmt: skip
CLAIMED |= {f"step_taylor{n}": n for n in range(12, 20)}
CASES = ("asym_ii_generic", "heavy_top_asymmetric")
FLOOR = 30.0  # errors below this many times the attainable one are rounding
LARGEST = 1e-3  # errors above it are outside the range of convergence
RATIO = 2.0**0.25  # between steps
MOST_STEPS = 300_000
LEAST, MOST = 3, 6  # points that make a slope
SLACK = 0.07  # of the order, for terms of higher order that are still seen


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
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    above = sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y, strict=True))
    return above / sum((a - mean_x) ** 2 for a in x)


def measured(method: str, case: Case, found: Sequence[tuple[float, float]]) -> Order:
    """Return the order from (step, error) pairs, coarse to fine: the finest that are in range."""
    low = FLOOR * (case.kappa or 1.0) * ROUNDOFF["f64"]
    inside = [(h, e) for h, e in found if low <= e <= LARGEST][-MOST:]
    order = slope([h for h, _ in inside], [e for _, e in inside])
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
    low = FLOOR * (case.kappa or 1.0) * ROUNDOFF["f64"]
    for count in steps(case, replace(SMALL, ratio=RATIO, finest=2.0**-12)):
        if count > MOST_STEPS:
            return
        step = float(case.time) / count
        (motion,) = moved(mover, case, given, [Job(method, step, count)])
        if motion is None:
            return
        error = wrong(case, motion.states[-1]).state
        yield step, error
        if error < low:
            return
