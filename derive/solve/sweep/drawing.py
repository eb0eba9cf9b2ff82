"""Plots of a sweep as SVG in the colours of the page: bands in time, histograms, bars."""

from collections.abc import Iterator, Sequence
from html import escape
from math import floor, isfinite, log10

from derive.scene.unit import behind
from derive.solve.sweep.summary import Fan, Influence, Scatter

WIDE, HIGH, LEFT, RIGHT, TOP, BELOW = 640.0, 250.0, 76.0, 14.0, 24.0, 44.0
TICKS = 5
ROW, NAMES = 34.0, 130.0


def ticks(low: float, high: float) -> list[float]:
    """Return round numbers within a span, about ``TICKS`` of them.

    >>> ticks(0.0, 1.0), ticks(-0.031, 0.042)
    ([0.0, 0.2, 0.4, 0.6, 0.8, 1.0], [-0.02, 0.0, 0.02, 0.04])
    """
    width = high - low
    if not (isfinite(width) and width > 0):
        return [low]
    power = 10.0 ** floor(log10(width / TICKS))
    step = next(k * power for k in (1, 2, 5, 10) if width / (k * power) <= TICKS + 1e-9)
    first = -floor(-low / step * (1 - 1e-12))
    last = floor(high / step * (1 + 1e-12))
    return [float(f"{k * step:.12g}") + 0.0 for k in range(first, last + 1)]


def _across(x: float, span: tuple[float, float]) -> float:
    return LEFT + (WIDE - LEFT - RIGHT) * (x - span[0]) / ((span[1] - span[0]) or 1.0)


def _up(y: float, span: tuple[float, float]) -> float:
    return TOP + (HIGH - TOP - BELOW) * (span[1] - y) / ((span[1] - span[0]) or 1.0)


def _opened(high: float, alternative: str) -> str:
    """Return an SVG's beginning: its size, and what is said of it."""
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE:g} {high:g}" role="img"'
    return f'{head} class="plot"><title>{escape(alternative)}</title>'


def _axes_drawn(
    across: tuple[float, float], up: tuple[float, float] | None, below: str, alternative: str
) -> Iterator[str]:
    """Yield an SVG's beginning: its size, what is said of it, ticks and what they are of."""
    yield _opened(HIGH, alternative)
    low = HIGH - BELOW
    for x in ticks(*across):
        at = _across(x, across)
        yield f'<path class="grid" d="M{at:.1f} {TOP:g}V{low:g}"/>'
        yield f'<text class="middle" x="{at:.1f}" y="{low + 16:g}">{x:.6g}</text>'
    for y in ticks(*up) if up else ():
        at = _up(y, up) if up else 0.0
        yield f'<path class="grid" d="M{LEFT:g} {at:.1f}H{WIDE - RIGHT:g}"/>'
        yield f'<text class="end" x="{LEFT - 6:g}" y="{at + 4:.1f}">{y:.6g}</text>'
    middle = (LEFT + WIDE - RIGHT) / 2
    yield f'<text class="middle" x="{middle:g}" y="{HIGH - 8:g}">{escape(below)}</text>'


def _spanned(values: Sequence[float]) -> tuple[float, float]:
    """Return a span that holds values, of some width."""
    low, high = min(values), max(values)
    more = 0.05 * (high - low) or abs(high) * 0.05 or 1.0
    return low - more, high + more


def fan_drawn(fan: Fan, unit: str) -> str:
    """Return the quantiles of a course in time: two bands around the median."""
    there = [k for k in range(len(fan.times)) if isfinite(fan.quantiles[0, k])]
    cuts = [[float(row[k]) for k in there] for row in fan.quantiles]
    across, up = (fan.times[0], fan.times[-1]), _spanned([x for row in cuts for x in row])
    xs = [_across(fan.times[k], across) for k in there]
    name = fan.column.partition("@")[0]
    ends = f"{cuts[0][-1]:.4g} to {cuts[-1][-1]:.4g}, median {cuts[2][-1]:.4g}"
    says = f"{name} in time: at the last instant drawn 90 % of members lie within {ends}"
    parts = [*_axes_drawn(across, up, "t, s", says)]
    for low, high, kind in ((0, 4, "outer"), (1, 3, "inner")):
        there_and_back = [*zip(xs, cuts[high], strict=True),
                          *reversed([*zip(xs, cuts[low], strict=True)])]  # fmt: skip
        points = " ".join(f"{x:.1f},{_up(y, up):.1f}" for x, y in there_and_back)
        parts.append(f'<polygon class="{kind}" points="{points}"/>')
    points = " ".join(f"{x:.1f},{_up(y, up):.1f}" for x, y in zip(xs, cuts[2], strict=True))
    parts.append(f'<polyline class="median" points="{points}"/>')
    parts.append(f'<text x="{LEFT:g}" y="{TOP - 8:g}">{escape(name + behind(unit))}</text>')
    return "".join([*parts, "</svg>"])


def histogram(of: Scatter, unit: str) -> str:
    """Return a histogram of a column."""
    across, most = (of.edges[0], of.edges[-1]), max(of.heights)
    says = f"{of.column}: 90 % lie within {of.quantiles[0]:.4g} to {of.quantiles[-1]:.4g}"
    parts = [*_axes_drawn(across, None, f"{of.column}{behind(unit)}", says)]
    for k, count in enumerate(of.heights):
        x, end = (_across(of.edges[n], across) for n in (k, k + 1))
        y = _up(count, (0.0, float(most)))
        if count:
            size = f'width="{max(end - x - 1, 0.5):.1f}" height="{HIGH - BELOW - y:.1f}"'
            parts.append(f'<rect class="bar" x="{x:.1f}" y="{y:.1f}" {size}/>')
    return "".join([*parts, "</svg>"])


def bars(of: Influence) -> str:
    """Return first-order and total sensitivities as bars, with what they may be off by."""
    high = ROW * len(of.rows) + 30
    each = "; ".join(f"{n}: {one:.2g} alone, {both:.2g} in all" for n, one, _, both, _ in of.rows)
    parts = [_opened(high, f"{of.column}: {each}")]
    scale = (WIDE - NAMES - RIGHT) / max(1.0, *(total + off for *_, total, off in of.rows))
    for x in (0.0, 0.25, 0.5, 0.75, 1.0):
        at = NAMES + x * scale
        parts.append(f'<path class="grid" d="M{at:.1f} 4V{high - 22:g}"/>')
        parts.append(f'<text class="middle" x="{at:.1f}" y="{high - 6:g}">{x:g}</text>')
    for k, (name, first, first_off, total, total_off) in enumerate(of.rows):
        y = 6 + ROW * k
        parts.append(f'<text class="end" x="{NAMES - 8:g}" y="{y + 18:g}">{escape(name)}</text>')
        both = (total, total_off, "outer", y), (first, first_off, "bar", y + 13)
        for value, off, kind, low in both:
            size = f'width="{max(value, 0.0) * scale:.1f}" height="11"'
            parts.append(f'<rect class="{kind}" x="{NAMES:g}" y="{low:g}" {size}/>')
            start, end = (NAMES + max(x, 0.0) * scale for x in (value - off, value + off))
            parts.append(f'<path class="off" d="M{start:.1f} {low + 5.5:g}H{end:.1f}"/>')
    return "".join([*parts, "</svg>"])
