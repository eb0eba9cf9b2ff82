"""The hard case of Euler angles near gimbal lock: a constant rotation that passes it at 1e-3."""

import math
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import partial
from typing import Any

from bench.motion.case import NO_VECTOR, Case
from bench.motion.runner import Job, moved
from bench.motion.wrong import wrong
from bench.report.case_run import PRECISIONS, Workshop
from bench.report.hard import Hard, by_precision, program

MISS = Fraction(1, 1024)  # rad: the body's x axis passes so far from the vertical
STEP, STEPS = Fraction(1, 128), 384
OURS = "step_rk4"
BOUND = {"f64": 2e-11, "f32": STEPS * 2.0**-24}
Row = list[Any]


def near_lock(shop: Workshop) -> Iterator[Hard]:
    """Yield the row of a body that turns past gimbal lock. Raises ImportError without mpmath."""
    case = passing()
    naive = {p: (wrong(case, euler(case, p)).attitude,) for p in PRECISIONS}
    ours = by_precision(partial(_ours, case, shop))
    yield Hard("Euler angles 1e-3 from gimbal lock", "attitude, rad", "RK4 on Euler angles (zyx)",
               naive, f"{OURS}, same step", ours, BOUND,
               "RK4's own error (h omega/2)^5/120 a step; in float a rounding a step")  # fmt: skip


def passing() -> Case:
    """Return a sphere that turns about an axis nearly along y, from zero angles."""
    import mpmath

    omega = (Fraction(0), Fraction(1), MISS)
    time = STEP * STEPS
    with mpmath.workdps(50):
        rate = mpmath.sqrt(1 + mpmath.mpf(float(MISS)) ** 2)
        half = rate * mpmath.mpf(float(time)) / 2
        parts = [mpmath.cos(half), *(mpmath.sin(half) * float(w) / rate for w in omega)]
        q = tuple(Fraction(mpmath.nstr(x, 45)) for x in parts)
    zero = NO_VECTOR
    inertia = (*(Fraction(2),) * 3, *zero)
    start = (Fraction(1), *zero)
    return Case("gimbal_lock", "", "steady", inertia, omega, start, time, zero, zero, zero,
                omega, q, None, None)  # fmt: skip


def _ours(case: Case, shop: Workshop, precision: str) -> tuple[float]:
    mover, given = program(case, OURS, shop, precision)
    (motion,) = moved(mover, case, given, [Job(OURS, float(STEP), STEPS)])
    return (math.nan if motion is None else wrong(case, motion.states[-1]).attitude,)


def euler(case: Case, precision: str) -> list[float]:
    """Return attitude and omega at the end by RK4 on roll, pitch and yaw."""
    import numpy as np

    real: Any = np.float32 if precision == "f32" else np.float64
    h, omega = real(float(STEP)), [real(float(w)) for w in case.omega0]
    rates = partial(_rates, omega)
    angles: Row = [real(0)] * 3
    for _ in range(STEPS):
        angles = _stepped(rates, angles, h)
    roll, pitch, yaw = (float(a) for a in angles)
    return [*_quaternion(roll, pitch, yaw), *map(float, omega)]


def _stepped(rates: Callable[[Row], Row], angles: Row, h: Any) -> Row:
    k1 = rates(angles)
    k2 = rates([a + h / 2 * k for a, k in zip(angles, k1, strict=True)])
    k3 = rates([a + h / 2 * k for a, k in zip(angles, k2, strict=True)])
    k4 = rates([a + h * k for a, k in zip(angles, k3, strict=True)])
    every = zip(angles, k1, k2, k3, k4, strict=True)
    return [a + h / 6 * (p + 2 * q + 2 * r + s) for a, p, q, r, s in every]


def _rates(omega: Sequence[Any], angles: Row) -> Row:
    import numpy as np

    roll, pitch, _ = angles
    across = np.sin(roll) * omega[1] + np.cos(roll) * omega[2]
    turning = np.cos(roll) * omega[1] - np.sin(roll) * omega[2]
    return [omega[0] + across * np.tan(pitch), turning, across / np.cos(pitch)]


def _quaternion(roll: float, pitch: float, yaw: float) -> list[float]:
    a, b, c = (math.cos(x / 2) for x in (roll, pitch, yaw))
    x, y, z = (math.sin(x / 2) for x in (roll, pitch, yaw))
    return [
        a * b * c + x * y * z,
        x * b * c - a * y * z,
        a * y * c + x * b * z,
        a * b * z - x * y * c,
    ]
