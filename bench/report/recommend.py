"""For this error, use this stepper with this step: what the points of a run say, in plain words.

A stepper is recommended for an error only if the point and every finer one that was run keep to it:
a lucky crossing is no reason.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from bench.report.point import Point

NAMED = 4  # cases that are left out by name
SAME = 1.0011  # settings of which one is at most so many times the other are printed alike
ALIKE = 1.005  # costs that differ by less are the same
ERRORS = {"f64": (1e-3, 1e-6, 1e-9, 1e-12), "f32": (1e-2, 1e-3, 1e-4, 1e-5)}


@dataclass(frozen=True)
class Advice:
    """The cheapest point that keeps to an error in a case, None if there is none."""

    case: str
    precision: str
    error: float
    point: Point | None


@dataclass(frozen=True)
class Overall:
    """How a stepper with one step or tolerance does in all cases of a kind.

    reached, asked : cases in which it keeps to the error in every scene that describes them, and
        all cases; ``missed`` names the others
    radians, tolerance : the step or tolerance, NaN where it has none
    worst, usual : its cost over that of the cheapest stepper of the case, the largest and the
        median of such ratios
    """

    kind: str
    precision: str
    error: float
    method: str
    reached: int
    asked: int
    missed: tuple[str, ...]
    radians: float
    tolerance: float
    worst: float
    usual: float


def cost(point: Point) -> float:
    """Return what a point costs: instructions, or seconds where none were counted."""
    return point.seconds * 1e9 if point.instructions is None else point.instructions


def keeping(points: Iterable[Point], error: float) -> list[Point]:
    """Return the points that keep to an error, and so do all finer ones of their stepper."""
    series: dict[tuple[str, str, str], list[Point]] = {}
    for p in points:
        series.setdefault((p.method, p.scene, p.precision), []).append(p)
    found = []
    for own in series.values():
        for p in sorted(own, key=lambda p: p.value):  # the finest step or tolerance first
            if not p.wrong.state <= error:
                break
            found.append(p)
    return found


def advice(case: str, points: Sequence[Point], precision: str, error: float) -> Advice:
    """Return the cheapest of our steppers that keeps to an error in every scene of the case."""
    curves = [_curve(own) for own in _methods(points, precision).values()]
    served = [curve.at(limit) for curve in curves for limit in [curve.limit(error)] if limit]
    costliest = [max(each, key=cost) for each in served]
    return Advice(case, precision, error, min(costliest, key=cost, default=None))


def sentence(found: Advice) -> str:
    """Return an advice in plain words."""
    if found.point is None:
        return f"no stepper keeps to {found.error:.0e} in this case"
    p = found.point
    if p.setting == "":
        return f"{p.method}: one call"
    if p.setting == "tolerance":
        return f"{p.method} to {cut(p.value)}"
    return f"{p.method} with steps of {cut(p.value)} s ({cut(p.radians)} rad)"


@dataclass(frozen=True)
class Curve:
    """The points of a stepper in a case, by the scenes that describe it."""

    scenes: tuple[tuple[Point, ...], ...]

    def limit(self, error: float) -> float:
        """Return the coarsest setting that keeps to an error in every scene; 0 if there is none."""
        return min(max(map(size, keeping(own, error)), default=0.0) for own in self.scenes)

    def at(self, limit: float) -> list[Point]:
        """Return each scene's coarsest point not above a setting; none of a scene without one."""
        below = [[p for p in own if size(p) <= limit * SAME] for own in self.scenes]
        return [max(own, key=size) for own in below if own]


def size(point: Point) -> float:
    """Return what settings are compared by: rad a step, a tolerance, 1 where there is none."""
    if point.setting == "step":
        return point.radians
    return point.value if point.setting == "tolerance" else 1.0


def _curve(points: Sequence[Point]) -> Curve:
    scenes = dict.fromkeys(p.scene for p in points)
    return Curve(tuple(tuple(p for p in points if p.scene == scene) for scene in scenes))


def _methods(points: Iterable[Point], precision: str) -> dict[str, list[Point]]:
    found: dict[str, list[Point]] = {}
    for p in points:
        if p.ours and p.precision == precision:
            found.setdefault(p.method, []).append(p)
    return found


def overall(
    kind: str, cases: Mapping[str, Sequence[Point]], precision: str, error: float
) -> list[Overall]:
    """Return how our steppers do over cases: by how many they serve, then by their worst cost."""
    curves: dict[str, dict[str, Curve]] = {}
    for name, points in cases.items():
        for method, own in _methods(points, precision).items():
            curves.setdefault(method, {})[name] = _curve(own)
    limits = {m: {n: c.limit(error) for n, c in own.items()} for m, own in curves.items()}
    cheapest = {
        n: min((_cost(curves[m][n], x[n]) for m, x in limits.items() if x.get(n)), default=math.nan)
        for n in cases
    }
    rows = [
        _overall((kind, precision, error, method), own, limits[method], cheapest)
        for method, own in curves.items()
        if any(limits[method].values())
    ]
    return sorted(rows, key=lambda r: (-r.reached, r.worst))


def _overall(
    about: tuple[str, str, float, str],
    curves: Mapping[str, Curve],
    limits: Mapping[str, float],
    cheapest: Mapping[str, float],
) -> Overall:
    """Return how a stepper does over cases; those that it was not run in are missed."""
    setting, served = _setting(curves, limits)
    ratios = [_cost(curves[n], setting) / cheapest[n] for n in served]
    kind = curves[served[0]].at(setting)[0].setting
    return Overall(
        *about,
        len(served),
        len(cheapest),
        tuple(n for n in cheapest if n not in served),
        setting if kind == "step" else math.nan,
        setting if kind == "tolerance" else math.nan,
        max(ratios),
        median(ratios),
    )


def _setting(curves: Mapping[str, Curve], limits: Mapping[str, float]) -> tuple[float, list[str]]:
    """Return the setting that serves most cases, the coarsest of such, and these cases.

    A case is served if the setting keeps to the error there and something as fine was run.
    """
    best: tuple[float, list[str]] = (0.0, [])
    for setting in sorted({float(cut(x)) for x in limits.values() if x}, reverse=True):
        served = [
            name
            for name, limit in limits.items()
            if limit >= setting and len(curves[name].at(setting)) == len(curves[name].scenes)
        ]
        best = (setting, served) if len(served) > len(best[1]) else best
    return best


def _cost(curve: Curve, setting: float) -> float:
    return max(map(cost, curve.at(setting)))


def says(row: Overall) -> str:
    """Return an advice over cases in plain words; a setting is cut, so that it is not exceeded."""
    step = "" if math.isnan(row.radians) else f" with steps of {cut(row.radians)} rad"
    step += "" if math.isnan(row.tolerance) else f" to {cut(row.tolerance)}"
    where = "every case"
    if row.missed:
        left = ", ".join(row.missed) if len(row.missed) <= NAMED else f"{len(row.missed)} others"
        where = f"{row.reached} of {row.asked} cases, not {left}"
    price = "" if row.usual < ALIKE else f"; {row.usual:.3g} times the least cost"
    return f"{row.method}{step}: {where}{price}"


def cut(x: float) -> str:
    """Return a number to four digits, not above it.

    >>> cut(0.0676582), cut(1.11e-10)
    ('0.06765', '1.11e-10')
    """
    exponent = math.floor(math.log10(x)) - 3
    near = [float(f"{round(x / 10.0**exponent) - k}e{exponent}") for k in (0, 1)]
    return f"{next(n for n in near if n <= x):.4g}"


def choice(rows: Sequence[Overall]) -> list[Overall]:
    """Return what is cheap as a rule, what serves most cases, and then the others.

    Cheap as a rule is the least usual cost among those that serve more than half of the cases; what
    serves most is the cheapest of those. Variants of what stands before are left out after these.
    """
    if not rows:
        return []
    many = [row for row in rows if 2 * row.reached > row.asked]
    cheap = min(many, key=lambda row: row.usual, default=rows[0])
    first = [cheap, rows[0]]
    known = {_stepper(row) for row in first}
    rest: dict[str, Overall] = {}
    for row in rows:
        if _stepper(row) not in known:
            rest.setdefault(_stepper(row), row)
    return [*first, *rest.values()]


def _stepper(row: Overall) -> str:
    return "_".join(row.method.split("_")[:2])
