"""A report of made-up figures: curves of a known order and cost, so that every answer is known."""

import math
from collections.abc import Iterator

from bench.flops import Flops
from bench.motion.case import cases
from bench.motion.step_jacobian import Entry
from bench.motion.wrong import Wrong
from bench.report.case_run import Found
from bench.report.counts import Count
from bench.report.functions import Function
from bench.report.gyroscopic import Gyroscopic
from bench.report.hard import Hard
from bench.report.orders import Order
from bench.report.point import NotRun, Point
from bench.report.proposals import Proposal
from bench.report.record import Report, machine
from bench.report.targets import Target

CASE = "asym_ii_generic"
PRECISIONS = ("f64", "f32")


def wrong(error: float) -> Wrong:
    """Return errors of which all are the same."""
    return Wrong(error, error, error, error)


def point(method: str, step: float, error: float, cost: float, precision: str = "f64") -> Point:
    """Return a point of ours with this step in s and rad, error and instructions."""
    passes = round(100 / step)
    return Point(method, "principal", precision, "step", step, passes, step, cost, cost * 1e-9,
                 wrong(error))  # fmt: skip


def curve(method: str, order: int, each: float, precision: str = "f64") -> list[Point]:
    """Return points of steps 1, 1/2 ... 1/256 s of a stepper whose error is its step^order."""
    steps = [2.0**-n for n in range(9)]
    return [point(method, h, h**order, each * 100 / h, precision) for h in steps]


def peer() -> Point:
    """Return a point of a package."""
    return Point("heyoka (Taylor)", "", "f64", "tolerance", 1e-9, 10, 1.0, None, 1e-4, wrong(1e-9))


def found(case: str = CASE) -> Found:
    """Return the motions of a case by two steppers and a package; another one was not run."""
    points = [*curve("step_rk4", 4, 350.0), *curve("step_dmv", 10, 430.0), peer()]
    points += curve("step_rk4", 4, 350.0, "f32")
    missing = NotRun("MuJoCo RK4", "f64", "No module named 'mujoco'")
    return Found(cases()[case], tuple(points), (missing,))


def report() -> Report:
    """Return a report with something in every section."""
    figures = dict.fromkeys(PRECISIONS, (1e-14, math.nan))
    bound = dict.fromkeys(PRECISIONS, 1e-12)
    return Report(
        "small",
        (found(), found("const_body_torque")),
        (Hard("a rod", "omega / attitude", "naive", figures, "step_dmv", figures, bound, "why"),),
        (Order("step_rk4", CASE, 4, 4.01, 5), Order("step_dmv", CASE, 10, math.nan, 1)),
        (Entry("ours", Flops(add=1), {"O2": 10.0}, 0.0), Entry("SymForce", None, {}, 0.0, "no")),
        (Gyroscopic("fast", "f64", 1e-3, 0.5, 3.0, 2.0),),
        (Function("s", "f", 12, 1, dict(both(30.0)), dict(both(0.5)), dict(both(3.0))),),
        (
            Target("what", "1", "2", reached=False, only="hard"),
            Target("else", "1", "?", reached=None, only="hard"),
        ),
        (Count("principal", "step_rk4", "operations", 193),),
        tuple(
            Proposal(CASE, "principal", "f64", part, 10, error)
            for part, error in ((1.0, 2e-15), (0.9, 1e-15), (0.5, 4e-15))
        ),
        machine(),
    )


def both(x: float) -> Iterator[tuple[str, float]]:
    """Yield a figure for each precision."""
    yield from ((p, x) for p in PRECISIONS)
