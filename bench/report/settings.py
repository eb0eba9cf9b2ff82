"""Which steps and tolerances a method is tried with: from coarse to fine, until nothing is gained.

A step must be a float: only then do so many steps end at the case's time, in float as in double.
"""

import math
from collections.abc import Iterator

from bench.motion.case import Case
from bench.report.point import Limits, Point

COARSEST = 4.0  # rad
TOLERANCES = {"f64": (1e-15, 1e-3), "f32": (1e-7, 1e-2), "package": (1e-13, 1e-3)}
USELESS = 0.1  # an error above which nothing is said of rounding
GAIN = 0.7  # a finer step that leaves more of the error than this gains nothing
PATIENCE = 3
BELOW = 0.1  # of the attainable error: what is smaller is luck


def steps(case: Case, limits: Limits) -> Iterator[int]:
    """Yield numbers of steps, each about ``limits.ratio`` times the one before.

    >>> from bench.motion.case import cases
    >>> from bench.report.point import SMALL
    >>> list(steps(cases()["tiny_scale_f32"], SMALL))[:5]
    [5, 10, 20, 40, 80]
    """
    turned = case.rate * float(case.time)
    wanted, last = turned / COARSEST, 0
    while turned / wanted >= limits.finest * 0.99:
        count = _admissible(case, wanted)
        if count > last:
            yield count
        last, wanted = max(count, last), wanted * limits.ratio


def _admissible(case: Case, wanted: float) -> int:
    """Return the number of steps nearest to ``wanted`` for which a step is exact in float."""
    odd = case.time.numerator
    while odd % 2 == 0:
        odd //= 2
    divisors = [d for d in range(1, odd + 1) if odd % d == 0]
    counts = [d << max(0, round(math.log2(wanted / d))) for d in divisors]
    return min(counts, key=lambda n: abs(math.log(n / wanted)))


def tolerances(kind: str, ratio: float) -> list[float]:
    """Return tolerances from coarse to fine; packages are not asked for less than 1e-13.

    >>> tolerances("f32", 100.0)
    [0.01, 0.0001, 1e-06]
    """
    low, high = TOLERANCES[kind]
    count = int(math.log(high / low) / math.log(ratio) + 1e-9) + 1
    return [float(f"{high / ratio**n:.2e}") for n in range(count)]


def gained(found: list[Point], attainable: float) -> bool:
    """Tell whether finer steps may still help, from the points so far, coarse to fine."""
    errors = [_finite(p.wrong.state) for p in found]
    if len(errors) > 1 and max(errors[-2:]) < BELOW * attainable:
        return False
    if len(errors) <= PATIENCE:
        return True
    before, after = min(errors[:-PATIENCE]), min(errors[-PATIENCE:])
    return before > USELESS or after < GAIN * before


def _finite(error: float) -> float:
    return error if math.isfinite(error) else math.inf
