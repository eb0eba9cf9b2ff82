"""Curves of a plot, errors against costs, and which of them a plot shows: the cheapest, few."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from bench.report.look import COMPENSATED, plain, rank
from bench.report.point import Point

MOST, OTHERS = 8, 3  # curves of a plot, and of peers among them
DECADES = tuple(10.0**-n for n in range(1, 17))
SMALLEST = 5e-17  # an error of zero is drawn here
Cost = Callable[[Point], float | None]
Error = Callable[[Point], float]


@dataclass(frozen=True)
class Line:
    """What a method makes of a motion: its errors and what they cost, coarse to fine."""

    method: str
    ours: bool
    costs: tuple[float, ...]
    errors: tuple[float, ...]

    def cost_of(self, error: float) -> float | None:
        """Return the cost from which on every finer point keeps to an error, None without one.

        Between two points it is on the straight line of logarithms; a coarsest point that keeps to
        the error costs what it costs.
        """
        first = len(self.errors)
        while first and self.errors[first - 1] <= error:
            first -= 1
        if first == len(self.errors):
            return None
        if first == 0:
            return self.costs[0]
        (e0, e1), (c0, c1) = (pair[first - 1 : first + 1] for pair in (self.errors, self.costs))
        part = math.log(e0 / error) / math.log(e0 / e1)
        return math.exp(math.log(c0) + part * math.log(c1 / c0))


def line(points: Sequence[Point], cost: Cost, error: Error) -> Line:
    """Return the curve of a method's points, of those that have a cost and a finite error."""
    pairs = [(cost(p), error(p)) for p in points]
    kept = [(c, max(e, SMALLEST)) for c, e in pairs if c and math.isfinite(e) and e < math.tau]
    first = points[0]
    return Line(first.method, first.ours, tuple(c for c, _ in kept), tuple(e for _, e in kept))


def worths(lines: Sequence[Line]) -> list[float]:
    """Return the mean, over the powers of ten that any curve keeps to, of one over its rank.

    The cheapest for an error has rank 1 there; who does not keep to it counts 0.
    """
    found = [0.0] * len(lines)
    asked = 0
    for error in DECADES:
        costs = {n: c for n, one in enumerate(lines) if (c := one.cost_of(error))}
        asked += bool(costs)
        for ahead, n in enumerate(sorted(costs, key=lambda n: costs[n])):
            found[n] += 1 / (ahead + 1)
    return [total / max(asked, 1) for total in found]


def chosen(lines: Sequence[Line]) -> list[int]:
    """Return the places of the curves that a plot shows: of peers three, of ours up to eight.

    They are those of most worth; of a step and its variants one.
    """
    found = worths(lines)
    places = sorted(range(len(lines)), key=lambda n: -found[n])
    peers = [n for n in places if not lines[n].ours and lines[n].costs][:OTHERS]
    ours: dict[str, int] = {}
    for n in places:
        if lines[n].ours and lines[n].costs:
            ours.setdefault(plain(lines[n].method), n)
    return sorted([*list(ours.values())[: MOST - len(peers)], *peers])


def parted(points: Iterable[Point], cost: Cost) -> list[list[list[Point]]]:
    """Return the points of each plot's curves: those chosen, then the others, eight at a time.

    What has no such cost is in none.
    """
    curves = methods(points, cost)
    first = chosen([line(own, cost, state) for own in curves])
    rest = [own for n, own in enumerate(curves) if n not in first and any(map(cost, own))]
    others = [rest[n : n + MOST] for n in range(0, len(rest), MOST)]
    return [[curves[n] for n in first], *others]


def methods(points: Iterable[Point], cost: Cost) -> list[list[Point]]:
    """Return each method's points, coarse to fine, in the order of ``rank``.

    Of several scenes that describe a body, those of the scene of most worth; without compensated
    steps that do not end at half of the error of the plain ones.
    """
    found: dict[str, dict[str, list[Point]]] = {}
    for p in sorted(points, key=lambda p: (rank(p), p.scene)):
        found.setdefault(p.method, {}).setdefault(p.scene, []).append(p)
    best = {method: _best(list(own.values()), cost) for method, own in found.items()}
    return [
        own
        for method, own in best.items()
        if not method.endswith(COMPENSATED)
        or _least(own) < _least(best.get(method.removesuffix(COMPENSATED), [])) / 2
    ]


def state(point: Point) -> float:
    """Return the error of a point: of omega or of the attitude, whichever is larger."""
    return point.wrong.state


def _best(scenes: Sequence[Sequence[Point]], cost: Cost) -> list[Point]:
    each = worths([line(own, cost, state) for own in scenes])
    return list(scenes[each.index(max(each))])


def _least(points: Sequence[Point]) -> float:
    return min((e for e in map(state, points) if math.isfinite(e)), default=math.inf)
