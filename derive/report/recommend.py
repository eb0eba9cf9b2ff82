"""For this error, use this stepper with this step: what the points of a run say, in plain words.

A stepper is recommended for an error only if the point and every finer one that was run keep to it:
a lucky crossing is no reason.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from derive.report.point import Point

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
    """A stepper that keeps to an error in most cases of a kind, and what it costs there.

    reached, asked : cases in which it keeps to the error, and those in which any of ours does
    radians, tolerance : the largest with which it does in all of those, NaN where it has none
    worst, usual : its cost over that of the cheapest stepper of the case, the largest and the
        median of such ratios
    """

    kind: str
    precision: str
    error: float
    method: str
    reached: int
    asked: int
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
    """Return the cheapest of our points that keeps to an error."""
    own = [p for p in points if p.ours and p.precision == precision]
    return Advice(case, precision, error, min(keeping(own, error), key=cost, default=None))


def sentence(found: Advice) -> str:
    """Return an advice in plain words."""
    if found.point is None:
        return f"no stepper keeps to {found.error:.0e} in this case"
    p = found.point
    if p.setting == "":
        return f"{p.method}: one call"
    if p.setting == "tolerance":
        return f"{p.method} with tolerance {p.value:.0e}"
    return f"{p.method} with steps of {p.value:.2g} s ({p.radians:.2g} rad)"


def overall(
    kind: str, cases: Sequence[Sequence[Point]], precision: str, error: float
) -> list[Overall]:
    """Return how our steppers do over cases: by how many they serve, then by their worst cost."""
    best: dict[str, dict[int, Point]] = {}
    for n, points in enumerate(cases):
        own = [p for p in points if p.ours and p.precision == precision]
        for p in keeping(own, error):
            known = best.setdefault(p.method, {})
            if n not in known or cost(p) < cost(known[n]):
                known[n] = p
    served = {n for own in best.values() for n in own}
    cheapest = {n: min(cost(own[n]) for own in best.values() if n in own) for n in served}
    rows = [_overall(kind, precision, error, m, own, cheapest) for m, own in best.items()]
    return sorted(rows, key=lambda r: (-r.reached, r.worst))


def _overall(
    kind: str,
    precision: str,
    error: float,
    method: str,
    own: Mapping[int, Point],
    cheapest: Mapping[int, float],
) -> Overall:
    radians = min((p.radians for p in own.values() if p.setting == "step"), default=math.nan)
    tolerance = min((p.value for p in own.values() if p.setting == "tolerance"), default=math.nan)
    ratios = [cost(p) / cheapest[n] for n, p in own.items()]
    return Overall(kind, precision, error, method, len(own), len(cheapest), radians, tolerance,
                   max(ratios), median(ratios))  # fmt: skip


def one_each(rows: Iterable[Overall]) -> list[Overall]:
    """Return rows without further variants of a stepper that stands before."""
    found: dict[str, Overall] = {}
    for row in rows:
        found.setdefault("_".join(row.method.split("_")[:2]), row)
    return list(found.values())


def choice(rows: Sequence[Overall]) -> list[Overall]:
    """Return what to choose from: what serves most cases, and what is cheap as a rule.

    Cheap as a rule is the least usual cost among those that serve more than half of the cases.
    """
    if not rows:
        return []
    many = [row for row in rows if 2 * row.reached > row.asked]
    cheap = min(many, key=lambda row: row.usual, default=rows[0])
    return one_each([cheap, *rows])
