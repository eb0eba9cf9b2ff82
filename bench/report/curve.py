"""What an error costs along a curve of work against precision."""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

from bench.report.point import Point


def instructions(point: Point) -> float | None:
    """Return a point's instructions."""
    return point.instructions


def seconds(point: Point) -> float | None:
    """Return a point's time."""
    return point.seconds


def cost_at(
    points: Sequence[Point], error: float, cost: Callable[[Point], float | None]
) -> float | None:
    """Return the cost of an error along a curve; None if the curve does not keep to it.

    Between the coarsest point from which on every finer one keeps to the error, and the one before:
    a lucky crossing does not count.
    """
    pairs = []
    for p in sorted(points, key=lambda p: -p.value):
        own = cost(p)
        if own is not None and p.wrong.state > 0 and math.isfinite(p.wrong.state):
            pairs.append((p.wrong.state, own))
    for (e0, c0), (e1, c1) in reversed(list(pairwise(pairs))):
        if e1 > error:
            return None
        if e0 > error:
            part = math.log(e0 / error) / math.log(e0 / e1)
            return math.exp(math.log(c0) + part * math.log(c1 / c0))
    return None


def by_scene(points: Sequence[Point]) -> list[list[Point]]:
    """Return the points of each scene that describes a case; peers have one without a name."""
    return [[p for p in points if p.scene == s] for s in dict.fromkeys(p.scene for p in points)]


def cost_in_all(
    points: Sequence[Point], error: float, cost: Callable[[Point], float | None]
) -> float | None:
    """Return the cost of an error in the dearest scene, None if one does not keep to it."""
    each = [cost_at(own, error, cost) for own in by_scene(points)]
    known = [c for c in each if c is not None]
    return max(known) if known and len(known) == len(each) else None
