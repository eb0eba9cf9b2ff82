"""Work-precision plots as SVG: error over cost, log-log, every curve named at its end.

Text stays text; there is no date, no path, no random name: the same points give the same bytes.
"""

import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from bench.report.line import Line
from bench.report.look import GOLD, GRID, INK, PAINT, SOFT, Look, look
from bench.report.seen import seen
from bench.report.written import power
from derive.report.slim import Slim, slim

WIDTH, HEIGHT = 4.2, 2.9  # inch; half of a page of 60 rem
STYLE = {
    "svg.fonttype": "none",
    "svg.hashsalt": "derive",
    "font.family": "sans-serif",
    "font.sans-serif": ["Helvetica", "Arial", "DejaVu Sans"],
    "font.size": 8,
    "axes.edgecolor": SOFT,
    "axes.labelcolor": INK,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "path.simplify": True,
}
GAP = 0.056  # between names, of the axes' height
MOST_TICKS = {"x": 6, "y": 9}
End = tuple[Look, float, float]


@dataclass(frozen=True)
class View:
    """One plot: its curves, and what is said of it.

    what : case, precision and which error, for who cannot see it     unit : of costs
    floor : an error that is drawn across, what is attainable         up : what the errors are of
    marked : whether points have markers; many small plots do without
    """

    what: str
    lines: Sequence[Line]
    unit: str
    up: str
    floor: float | None
    marked: bool


def svg(view: View) -> Slim:
    """Return a plot as an svg element with alternative text."""
    import matplotlib as mpl

    with mpl.rc_context(STYLE):
        out = io.StringIO()
        nothing = {"Date": None, "Creator": None, "Format": None, "Type": None}
        figure(view).savefig(out, format="svg", metadata=nothing)
    says = seen(view.what, view.lines, view.unit, view.floor)
    return slim(out.getvalue(), says, PAINT)


def figure(view: View) -> Any:
    """Return a matplotlib figure of a plot."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(STYLE):
        drawn = Figure(figsize=(WIDTH, HEIGHT), layout=None)
        drawn.patch.set_visible(False)
        ax = drawn.add_axes((0.135, 0.145, 0.545, 0.83))
        ax.patch.set_visible(False)
        _scales(ax, view)
        for one in view.lines:
            _curve(ax, one, view.marked)
        _ticks(ax)
        for one in view.lines:
            if len(one.costs) == 1:
                _beside(ax, one)
        ends = [
            (look(one.method), one.costs[-1], one.errors[-1])
            for one in view.lines
            if len(one.costs) > 1
        ]
        if view.floor:
            ends.append((Look("κu, attainable", GOLD, "", "-"), ax.get_xlim()[1], view.floor))
        _name(ax, ends)
        return drawn


def _scales(ax: Any, view: View) -> None:
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.grid(color=GRID, linewidth=0.6)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)
    ax.tick_params(length=0, labelsize=8)
    if view.floor:
        ax.axhline(view.floor, color=GOLD, linewidth=1.2, zorder=1)
    ax.set_xlabel(view.unit)
    ax.set_ylabel(view.up)
    ax.yaxis.set_label_coords(-0.17, 0.5)


def _ticks(ax: Any) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator

    for axis, most in zip((ax.xaxis, ax.yaxis), MOST_TICKS.values(), strict=True):
        axis.set_major_locator(LogLocator(numticks=most))
        axis.set_major_formatter(FuncFormatter(power))
    ax.minorticks_off()


def _curve(ax: Any, one: Line, marked: bool) -> None:  # noqa: FBT001 (a field of the view)
    shown = look(one.method)
    star = shown.marker == "*"
    ax.plot(one.costs, one.errors, color=shown.colour, linestyle=shown.line,
            marker=shown.marker if marked or len(one.costs) == 1 else "",
            linewidth=0.9 if shown.line == ":" else 1.3, markersize=11 if star else 3.5,
            markeredgewidth=0 if star else 0.8)  # fmt: skip


def _beside(ax: Any, one: Line) -> None:
    """Write the name of a single point beside it."""
    shown = look(one.method)
    ax.annotate(
        shown.label, xy=(one.costs[0], one.errors[0]), xytext=(8, 0), textcoords="offset points",
        color=shown.colour, va="center", fontsize=8,
    )  # fmt: skip


def _name(ax: Any, ends: Sequence[End]) -> None:
    """Write each curve's name to the right of the axes, near its end and clear of the others."""
    low, high = (math.log(v) for v in ax.get_ylim())
    ax.set_xlim(ax.get_xlim())
    placed = [((math.log(y) - low) / (high - low), shown, x, y) for shown, x, y in ends]
    placed.sort(key=lambda end: end[0])
    places = spread([end[0] for end in placed], GAP)
    for (_, shown, x, y), place in zip(placed, places, strict=True):
        ax.annotate(
            "", xy=(x, y), xycoords="data", xytext=(1.04, place), textcoords="axes fraction",
            annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": shown.colour, "linewidth": 0.5,
                        "shrinkA": 0, "shrinkB": 3},
        )  # fmt: skip
    for (_, shown, _, _), place in zip(placed, places, strict=True):  # above all lines
        ax.text(1.05, place, shown.label, transform=ax.transAxes, color=shown.colour, va="center",
                fontsize=8)  # fmt: skip


def spread(places: Sequence[float], gap: float) -> list[float]:
    """Return places in order moved apart to at least ``gap`` inside 0 .. 1, as little as it takes.

    >>> spread([0.0, 0.5, 0.5, 1.0], 0.25)
    [0.0, 0.375, 0.625, 1.0]
    """
    groups: list[tuple[float, int]] = []  # centre, members
    for place in places:
        groups.append(_inside((place, 1), gap))
        while len(groups) > 1 and _close(groups[-2], groups[-1], gap):
            (a, m), (b, n) = groups[-2:]
            groups[-2:] = [_inside(((a * m + b * n) / (m + n), m + n), gap)]
    return [centre + gap * (k - (n - 1) / 2) for centre, n in groups for k in range(n)]


def _inside(group: tuple[float, int], gap: float) -> tuple[float, int]:
    centre, members = group
    half = gap * (members - 1) / 2
    return max(half, min(centre, 1 - half)), members


def _close(a: tuple[float, int], b: tuple[float, int], gap: float) -> bool:
    return b[0] - a[0] < gap * (a[1] + b[1]) / 2
