"""Plots of a scene's report: error against cost, both on logarithmic scales, as SVG.

Text stays text, and colours that are not a curve's own are those of the page, light or dark. There
is no date, no path and no random name: the same numbers give the same bytes.
"""

import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any

from derive.report.slim import Slim, slim

INK, SOFT, GRID, FLOOR = "#1a1c20", "#5b626d", "#dfe2e7", "#806000"
SHADES = {
    "#00707e": "#4cc6d4", "#a35800": "#f2a654", "#2a7a2e": "#78cf7d", "#8250c4": "#dcc4ff",
    "#c02942": "#ff8295", "#1f63bd": "#86b6ff", "#944578": "#ea9fc9", "#4d4d4d": "#cfcfcf",
    FLOOR: "#e3b341",
}  # fmt: skip
"""The colours of curves on light paper, each with its shade on dark; readable as text on both."""
COLOURS = tuple(SHADES)[:-1]
"""As many as a plot may have curves."""
PAINT = {day: f"--c{n}" for n, day in enumerate(SHADES)} | {
    INK: "--ink", SOFT: "--soft", GRID: "--line"
}  # fmt: skip
"""The variable of the page that stands for each colour."""
MARKERS = "osD^vPX*"
SIZE = (5.0, 4.1)  # inch: letters of 10 px on a page of 390
LEAST_MARGIN, WIDE = 122, 6.6  # points: to the right of the axes, and of a letter there
FEWEST = 2  # marks along a side, without which nobody can read it
SLACK = 1e-9  # of what rounds
GAP = 0.062  # between names, of the height of the axes
STYLE: Mapping[str, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "derive",
    "font.family": "sans-serif",
    "font.sans-serif": ["Helvetica", "Arial", "DejaVu Sans"],
    "font.size": 10.5,
    "axes.edgecolor": SOFT,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "figure.facecolor": "none",
    "axes.facecolor": "none",
}


@dataclass(frozen=True)
class Curve:
    """A named row of (cost, error).

    place : of its colour and marker        line : of matplotlib's, as "-" or ":"
    star  : it is one marker, of what has no length of step
    """

    name: str
    x: Sequence[float]
    y: Sequence[float]
    place: int
    line: str = "-"
    star: bool = False


@dataclass(frozen=True)
class Plot:
    """What a plot shows: curves, at most as many as there are colours, and words for its sides.

    floor : an error that is drawn across, with its name, None if there is none
    alternative : what a reader is told who does not see the plot
    """

    curves: Sequence[Curve]
    across: str
    up: str
    alternative: str
    floor: tuple[str, float] | None = None


def svg(plot: Plot) -> Slim:
    """Return a plot as an svg element, with its alternative text."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(dict(STYLE)):
        figure = Figure(figsize=SIZE)
        longest = max((len(c.name) for c in plot.curves), default=0)
        right = 1 - max(LEAST_MARGIN, WIDE * longest + 26) / (72 * SIZE[0])
        figure.subplots_adjust(left=0.16, right=right, top=0.97, bottom=0.15)
        ax = figure.subplots()
        _axes(ax, plot)
        _curves(ax, plot)
        _few_decades(ax)
        _names(ax, plot)
        out = io.StringIO()
        nothing = {"Date": None, "Creator": None, "Format": None, "Type": None}
        figure.savefig(out, format="svg", metadata=nothing, facecolor="none")
    return slim(out.getvalue(), plot.alternative, PAINT)


def _axes(ax: Any, plot: Plot) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator

    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.minorticks_off()
    for axis, most in ((ax.xaxis, 6), (ax.yaxis, 9)):
        axis.set_major_locator(LogLocator(numticks=most))
        axis.set_major_formatter(FuncFormatter(power))
    ax.grid(color=GRID, linewidth=0.6)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)
    ax.tick_params(length=2.5)
    ax.set_xlabel(plot.across)
    ax.set_ylabel(plot.up)
    if plot.floor:
        ax.axhline(plot.floor[1], color=FLOOR, linewidth=1.2, linestyle="--", zorder=1)


def _few_decades(ax: Any) -> None:
    """Put marks between the powers of ten along a side that holds less than two of these."""
    from matplotlib.ticker import FixedFormatter, FixedLocator

    for axis in (ax.xaxis, ax.yaxis):
        low, high = axis.get_view_interval()
        if sum(low <= x <= high for x in axis.get_ticklocs()) < FEWEST:
            places = between(low, high)
            axis.set_major_locator(FixedLocator(places))
            axis.set_major_formatter(FixedFormatter(marks(places)))


def between(low: float, high: float) -> list[float]:
    """Return at least two round numbers in a range of less than two powers of ten.

    >>> between(12.0, 70.0), between(4.1, 4.4)
    ([20.0, 50.0], [4.2, 4.4])
    """
    decade = math.floor(math.log10(low))
    ends = (low - SLACK * low, high + SLACK * high)
    found = [float(f"{k}e{decade + n}") for n in (0, 1, 2) for k in (1, 2, 5)]
    found = [x for x in found if ends[0] <= x <= ends[1]]
    steps = ((m, math.floor(math.log10(high - low)) - n) for n in count() for m in (5, 2, 1))
    while len(found) < FEWEST:
        factor, ten = next(steps)
        first, last = (x * 10.0**-ten / factor for x in ends)
        each = range(math.ceil(first), math.floor(last) + 1)
        found = [float(f"{k * factor}e{ten}") for k in each]
    return found


def marks(places: Sequence[float]) -> list[str]:
    """Return numbers of one scale, of which not all are powers of ten, as text of one kind.

    >>> marks([10.0, 20.0]), marks([1e-7, 2.5e-7])
    (['10', '20'], ['1·10⁻⁷', '2.5·10⁻⁷'])
    """
    if all(1e-2 <= x < 1e5 for x in places):
        return [f"{x:.6g}" for x in places]
    tens = [math.floor(math.log10(x * (1 + SLACK))) for x in places]
    return [f"{x / 10.0**n:.6g}·10{raised(n)}" for x, n in zip(places, tens, strict=True)]


def _curves(ax: Any, plot: Plot) -> None:
    for curve in plot.curves:
        ax.plot(
            curve.x, curve.y, color=COLOURS[curve.place], linestyle=curve.line, linewidth=1.3,
            marker="*" if curve.star else MARKERS[curve.place], markersize=11 if curve.star else 4,
        )  # fmt: skip


def _names(ax: Any, plot: Plot) -> None:
    """Write each curve's name to the right of the axes, near its end and clear of the others."""
    ax.set_xlim(ax.get_xlim())
    low, high = (math.log(v) for v in ax.get_ylim())
    ends = [(c.name, c.x[-1], c.y[-1], COLOURS[c.place]) for c in plot.curves if len(c.x)]
    if plot.floor:
        ends.append((plot.floor[0], ax.get_xlim()[1], plot.floor[1], FLOOR))
    ends.sort(key=lambda e: e[2])
    places = spread([(math.log(y) - low) / ((high - low) or 1) for _, _, y, _ in ends], GAP)
    for (name, x, y, colour), place in zip(ends, places, strict=True):
        ax.annotate(
            name, xy=(x, y), xycoords="data", xytext=(1.04, place), textcoords="axes fraction",
            color=colour, va="center", fontsize=10, annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.5, "alpha": 0.5,
                        "shrinkA": 1, "shrinkB": 3},
        )  # fmt: skip


def power(x: float, _: int = 0) -> str:
    """Return a power of ten as text: plain characters, quick to draw and to search.

    >>> power(1e-12), power(1.0)
    ('10⁻¹²', '1')
    """
    exponent = round(math.log10(x))
    return f"10{raised(exponent)}" if exponent else "1"


def raised(exponent: int) -> str:
    """Return an exponent as text.

    >>> raised(-12)
    '⁻¹²'
    """
    return str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


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
