"""Work-precision plots as SVG: error over cost, log-log, every curve named at its end.

Text stays text; there is no date, no path, no random name: the same points give the same bytes.
"""

import io
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from bench.report.look import COMPENSATED, Look, look, rank
from bench.report.point import Point
from bench.report.slim import slim

INK, SOFT, GRID, GOLD = "#1a1c20", "#5b626d", "#e6e8ec", "#b8860b"
WIDTH, HEIGHT = 8.4, 3.5  # inch
FEWEST = 5e-17  # an error of zero is drawn here
STYLE = {
    "svg.fonttype": "none",
    "svg.hashsalt": "derive",
    "font.family": "sans-serif",
    "font.sans-serif": ["Helvetica", "Arial", "DejaVu Sans"],
    "font.size": 8.5,
    "axes.edgecolor": SOFT,
    "axes.labelcolor": INK,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "path.simplify": True,
}
GAP = 0.052  # between names, of an axis's height
Series = tuple[Look, list[float], list[float]]


@dataclass(frozen=True)
class Panel:
    """One pair of axes: which cost, which error, and what is said at its sides.

    judged : whether the attainable error is one of this kind
    marked : whether points have markers; many small panels do without
    """

    cost: Callable[[Point], float | None]
    error: Callable[[Point], float]
    across: str
    up: str
    judged: bool
    marked: bool


INSTRUCTIONS = ("instructions (Ir)", lambda p: p.instructions)
MICROSECONDS = ("microseconds", lambda p: p.seconds * 1e6)
ERRORS: Mapping[str, Callable[[Point], float]] = {
    "error at the end": lambda p: p.wrong.state,
    "omega, relative": lambda p: p.wrong.omega,
    "attitude, rad": lambda p: p.wrong.attitude,
    "energy, relative": lambda p: p.wrong.energy,
    "momentum, relative": lambda p: p.wrong.momentum,
}
INVARIANTS = ("energy, relative", "momentum, relative")


def panels(errors: Sequence[str]) -> list[list[Panel]]:
    """Return rows of two panels, against instructions and against time, a row an error."""
    marked = len(errors) == 1
    return [
        [
            Panel(cost, ERRORS[name], label, name, name not in INVARIANTS, marked)
            for label, cost in (INSTRUCTIONS, MICROSECONDS)
        ]
        for name in errors
    ]


def figure(rows: Sequence[Sequence[Panel]], points: Sequence[Point], floor: float | None) -> Any:
    """Return a matplotlib figure of panels; ``floor`` is drawn across: what is attainable."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(STYLE):
        drawn = Figure(figsize=(WIDTH, HEIGHT * len(rows)), layout=None)
        edges = {"top": 1 - 0.03 / len(rows), "bottom": 0.135 / len(rows)}
        drawn.subplots_adjust(left=0.075, right=0.825, wspace=0.06, hspace=0.24, **edges)
        axes = drawn.subplots(len(rows), 2, squeeze=False, sharey="row")
        for row, line in zip(rows, axes, strict=True):
            for panel, ax in zip(row, line, strict=True):
                _draw(ax, panel, floor if panel.judged else None)
                _curves(ax, panel, points)
            line[0].set_ylabel(row[0].up)
            curves = [_curve(own, row[1]) for own in grouped(points)]
            _name(line[1], [*curves, *_attainable(line[1], row[1], floor)])
        return drawn


def svg(rows: Sequence[Sequence[Panel]], points: Sequence[Point], floor: float | None) -> str:
    """Return a figure as the text of an svg element."""
    import matplotlib as mpl

    with mpl.rc_context(STYLE):
        out = io.StringIO()
        nothing = {"Date": None, "Creator": None, "Format": None, "Type": None}
        figure(rows, points, floor).savefig(out, format="svg", metadata=nothing)
    return slim(out.getvalue())


def grouped(points: Iterable[Point]) -> list[list[Point]]:
    """Return the points of each method, coarse to fine as they came, in the order of ``rank``."""
    found: dict[tuple[str, str], list[Point]] = {}
    for p in sorted(points, key=lambda p: (rank(p), p.scene)):
        found.setdefault((p.method, p.scene), []).append(p)
    return [own for (method, scene), own in found.items() if _worth(method, scene, found)]


def _worth(method: str, scene: str, found: Mapping[tuple[str, str], list[Point]]) -> bool:
    """Tell whether a compensated stepper ends clearly better than the plain one; others: yes."""
    plain = found.get((method.removesuffix(COMPENSATED), scene))
    if plain is None or not method.endswith(COMPENSATED):
        return True
    return _least(found[method, scene]) < _least(plain) / 2


def _least(points: Sequence[Point]) -> float:
    return min((p.wrong.state for p in points if math.isfinite(p.wrong.state)), default=math.inf)


def _curve(points: Sequence[Point], panel: Panel) -> Series:
    pairs = [(panel.cost(p), panel.error(p)) for p in points]
    kept = [(c, max(e, FEWEST)) for c, e in pairs if c and math.isfinite(e) and e < math.tau]
    return look(points[0].method), [c for c, _ in kept], [e for _, e in kept]


def _draw(ax: Any, panel: Panel, floor: float | None) -> None:
    from matplotlib.ticker import FuncFormatter

    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.minorticks_off()
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_formatter(FuncFormatter(power))
    ax.grid(color=GRID, linewidth=0.6)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)
    ax.tick_params(length=2.5, labelsize=8)
    if floor:
        ax.axhline(floor, color=GOLD, linewidth=1.2, zorder=1)
    ax.set_xlabel(panel.across)


def _curves(ax: Any, panel: Panel, points: Sequence[Point]) -> None:
    for own in grouped(points):
        shown, x, y = _curve(own, panel)
        single = len(x) == 1
        ax.plot(x, y, color=shown.colour, marker=shown.marker if panel.marked or single else "",
                linestyle=shown.line, linewidth=0.8 if shown.line == ":" else 1.3,
                markersize=9 if shown.marker == "*" else 4)  # fmt: skip


def power(x: float, _: int = 0) -> str:
    """Return a power of ten as text: plain characters, which are quick to draw and to search.

    >>> power(1e-12)
    '10⁻¹²'
    """
    digits = "⁰¹²³⁴⁵⁶⁷⁸⁹"
    exponent = round(math.log10(x))
    raised = "".join(digits[int(d)] for d in str(abs(exponent)))
    return f"10{'⁻' if exponent < 0 else ''}{raised}"


def _attainable(ax: Any, panel: Panel, floor: float | None) -> list[Series]:
    """Return the golden line as something to be named at the right edge of the axes."""
    if floor is None or not panel.judged:
        return []
    return [(Look("κu, attainable", GOLD, "", "-"), [ax.get_xlim()[1]], [floor])]


def _name(ax: Any, curves: Sequence[Series]) -> None:
    """Write each curve's name to the right of the axes, near its end and clear of the others."""
    low, high = (math.log(v) for v in ax.get_ylim())
    ax.set_xlim(ax.get_xlim())
    ends = [(shown, (math.log(y[-1]) - low) / (high - low), x[-1], y[-1])
            for shown, x, y in curves if y]  # fmt: skip
    ends.sort(key=lambda e: e[1])
    for (shown, _, x, y), place in zip(ends, spread([e[1] for e in ends], GAP), strict=True):
        ax.annotate(
            shown.label, xy=(x, y), xycoords="data", xytext=(1.035, place),
            textcoords="axes fraction", color=shown.colour, va="center", fontsize=8,
            annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": shown.colour, "linewidth": 0.5, "alpha": 0.45,
                        "shrinkA": 1, "shrinkB": 3},
        )  # fmt: skip


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
