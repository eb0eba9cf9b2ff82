"""What a method costs as a rule: the median over all cases of a kind of motion, error by error."""

import math
from collections.abc import Mapping, Sequence
from statistics import median_high

from bench.report.line import Cost, Line, line, methods, state
from bench.report.point import Point

ERRORS = tuple(10.0 ** (-n / 2) for n in range(2, 33))  # two to a power of ten, from 0.1


def typical(cases: Mapping[str, Sequence[Point]], precision: str, cost: Cost) -> list[Line]:
    """Return a curve for every method: the median over all cases of what an error costs there.

    A case that a method was not run in, or in which it does not keep to the error, costs it
    infinitely much: a curve ends where the method serves half of the cases or fewer.
    """
    found: dict[str, list[Line]] = {}
    for points in cases.values():
        for own in methods([p for p in points if p.precision == precision], cost):
            found.setdefault(own[0].method, []).append(line(own, cost, state))
    return [one for own in found.values() if (one := _median(own, len(cases))).costs]


def _median(lines: Sequence[Line], cases: int) -> Line:
    """Return the curve of medians, without errors that a smaller one is had for the cost of."""
    absent = [math.inf] * (cases - len(lines))
    costs = [median_high([*_costs(lines, error), *absent]) for error in ERRORS]
    finer = [*costs[1:], math.inf]
    kept = [n for n, cost in enumerate(costs) if cost < finer[n]]
    if all(len(one.costs) == 1 for one in lines):  # no steps to make finer: a point, no curve
        kept = kept[-1:]
    first = lines[0]
    return Line(first.method, first.ours, tuple(costs[n] for n in kept),
                tuple(ERRORS[n] for n in kept))  # fmt: skip


def _costs(lines: Sequence[Line], error: float) -> list[float]:
    return [math.inf if (c := one.cost_of(error)) is None else c for one in lines]
