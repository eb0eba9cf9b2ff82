"""What an error costs along a curve of work against precision."""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

from derive.report.point import Point


def instructions(point: Point) -> float | None:
    """Return a point's instructions."""
    return point.instructions


def seconds(point: Point) -> float | None:
    """Return a point's time."""
    return point.seconds


def cost_at(
    points: Sequence[Point], error: float, cost: Callable[[Point], float | None]
) -> float | None:
    """Return the cost of an error along a curve, between its points; None if it is not reached."""
    pairs = []
    for p in sorted(points, key=lambda p: -p.value):
        own = cost(p)
        if own is not None and p.wrong.state > 0 and math.isfinite(p.wrong.state):
            pairs.append((p.wrong.state, own))
    for (e0, c0), (e1, c1) in pairwise(pairs):
        if e1 <= error < e0:
            part = math.log(e0 / error) / math.log(e0 / e1)
            return math.exp(math.log(c0) + part * math.log(c1 / c0))
    return None
