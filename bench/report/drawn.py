"""Which plots stand on the page: one of every kind of motion first, then case by case, few open."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from bench.report.case_run import PRECISIONS, Found, attainable
from bench.report.curve import instructions
from bench.report.line import Cost, Error, chosen, line, parted, state
from bench.report.plots import View, svg
from bench.report.point import Point
from bench.report.typical import typical
from derive.report.slim import Slim

SAYS = {"f64": "double", "f32": "float"}
UP = "error at the end"
APART: Mapping[str, Error] = {
    "omega, relative": lambda p: p.wrong.omega,
    "attitude, rad": lambda p: p.wrong.attitude,
    "energy, relative": lambda p: p.wrong.energy,
    "momentum, relative": lambda p: p.wrong.momentum,
}
INVARIANTS = ("energy, relative", "momentum, relative")


def microseconds(point: Point) -> float:
    """Return the time of a motion in microseconds."""
    return point.seconds * 1e6


COSTS: Mapping[str, Cost] = {"instructions": instructions, "microseconds": microseconds}


@dataclass(frozen=True)
class Plot:
    """A plot and what is said below it."""

    caption: str
    drawn: Slim


@dataclass(frozen=True)
class Plots:
    """Plots that stand together; under a ``summary`` they are folded."""

    summary: str
    plots: tuple[Plot, ...]


def opening(kinds: Mapping[str, Mapping[str, Sequence[Point]]]) -> Plots:
    """Return the plots that the page opens with: medians over all cases of a kind of motion."""
    unit = _unit(p for cases in kinds.values() for points in cases.values() for p in points)
    plots = []
    for precision in PRECISIONS:
        for kind, cases in kinds.items():
            lines = typical(cases, precision, COSTS[unit])
            shown = [lines[n] for n in chosen(lines)]
            many = f"median of {len(cases)} case{'s' * (len(cases) > 1)}"
            what = f"{kind.capitalize()}, {SAYS[precision]}: {many}"
            view = View(f"{what}, error at the end", shown, unit, UP, None, marked=True)
            plots.append(Plot(what, svg(view)))
    return Plots("", tuple(plots))


def _unit(points: Iterable[Point]) -> str:
    """Return what plots are drawn against: time only where no instructions were counted."""
    return "instructions" if any(p.instructions for p in points) else "microseconds"


def of_case(found: Found) -> list[Plots]:
    """Return the plots of a case: the best curves against instructions, and what is folded."""
    unit = _unit(found.points)
    parts = {
        precision: parted([p for p in found.points if p.precision == precision], COSTS[unit])
        for precision in PRECISIONS
    }
    best = {precision: each[0] for precision, each in parts.items() if each[0]}
    others = [(precision, own) for precision, each in parts.items() for own in each[1:]]
    return [
        Plots("", tuple(_plot(found, own, p, "", unit) for p, own in best.items())),
        Plots("in microseconds",
              tuple(_plot(found, own, p, "", "microseconds") for p, own in best.items())),
        Plots("omega, attitude, energy and length of the momentum apart",
              tuple(_plot(found, own, p, error, unit)
                    for error in APART for p, own in best.items())),
        Plots("the other curves", tuple(_plot(found, own, p, "", unit) for p, own in others)),
    ]  # fmt: skip


def _plot(
    found: Found, curves: Iterable[Sequence[Point]], precision: str, error: str, cost: str
) -> Plot:
    """Return a plot of a case; ``error`` is one of ``APART``, or "" for the larger of the first."""
    lines = [line(own, COSTS[cost], APART.get(error, state)) for own in curves]
    floor = None if error in INVARIANTS else attainable(found.case, precision)
    what = f"{found.case.name}, {SAYS[precision]}: {error or UP}"
    view = View(what, lines, cost, error or UP, floor, marked=not error and cost == "instructions")
    return Plot(SAYS[precision].capitalize(), svg(view))
