"""The hard case of a moment that nearly cancels the gyroscopic term."""

import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

from bench.motion.ours import emission
from bench.motion.wrong import ROUNDOFF
from bench.report.case_run import PRECISIONS
from bench.report.hard import Hard
from bench.report.hard_formulas import SAMPLES, callable_by_precision, rounded
from derive.check.call import CFunction

Row = list[float]


def cancelling(folder: Path) -> Iterator[Hard]:
    """Yield the row of a moment that cancels the gyroscopic term to 1e-4."""
    called = callable_by_precision(emission("accurate"), folder)
    naive = {p: (_cancelled(partial(_euler, p), p),) for p in PRECISIONS}
    ours = {p: (_cancelled(partial(_accurate, own), p),) for p, own in called.items()}
    yield Hard("moment that cancels the gyroscopic term to 1e-4", "median, relative",
               "J (M - omega x I omega)", naive, "acceleration, form = accurate", ours,
               {p: ROUNDOFF[p] for p in PRECISIONS}, "pairs of floats, rounded once")  # fmt: skip


def _cancelled(form: Callable[[Row, Row, Row], Row], precision: str) -> float:
    """Return the median relative error over samples."""
    dice = random.Random("cancel")
    errors = []
    for _ in range(SAMPLES):
        a, b, c = (dice.uniform(0.5, 2) for _ in range(3))
        inertia = rounded([b + c, c + a, a + b], precision)
        omega = rounded([dice.uniform(-10, 10) for _ in range(3)], precision)
        gyroscopic = [float(x) for x in _gyroscopic(inertia, omega)]
        moment = rounded([-g * (1 + 1e-4 * dice.uniform(-1, 1)) for g in gyroscopic], precision)
        exact = zip(_gyroscopic(inertia, omega), moment, inertia, strict=True)
        true = [(g + Fraction(m)) / Fraction(i) for g, m, i in exact]
        errors.append(_distance(form(inertia, omega, moment), true))
    return sorted(errors)[len(errors) // 2]


def _gyroscopic(inertia: Row, omega: Row) -> list[Fraction]:
    i, w = [Fraction(x) for x in inertia], [Fraction(x) for x in omega]
    return [(i[n - 2] - i[n - 1]) * w[n - 2] * w[n - 1] for n in range(3)]


def _distance(found: Row, true: Sequence[Fraction]) -> float:
    apart = [float(Fraction(a) - b) for a, b in zip(found, true, strict=True)]
    return math.hypot(*apart) / math.hypot(*map(float, true))


def _euler(precision: str, inertia: Row, omega: Row, moment: Row) -> Row:
    import numpy as np

    real = np.float32 if precision == "f32" else np.float64
    given: list[Any] = [np.array(x, real) for x in (inertia, omega, moment)]
    i, w, applied = given
    return [float(x) for x in (applied - np.cross(w, i * w)) / i]


def _accurate(own: Mapping[str, CFunction], inertia: Row, omega: Row, moment: Row) -> Row:
    names = ("I_xx", "I_yy", "I_zz")
    made = own["setup"]({n: [x] for n, x in zip(names, inertia, strict=True)})
    given = {"constants": made["constants"], "omega": omega, "moment": moment}
    return own["acceleration"](given)["omega_dot"]
