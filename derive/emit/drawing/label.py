"""Where the names of a drawing stand: beside what they name, apart, and within the picture."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import isfinite

from derive.emit.drawing.space import Flat, circle
from derive.emit.notation.glyph import glyph, slanted, spelt

SIZE, SMALL, DROP = 11.0, 8.0, 2.5  # px: letters, indices, how far indices hang
_NARROW, _WIDE = frozenset("fijlrt.,'I1 "), frozenset("mwMWNQOGω")
_EM = {"narrow": 0.42, "usual": 0.68, "wide": 1.0}
"""Widths of letters of DejaVu Serif, the widest of the fonts that the style names, and more."""
_GAPS = (3.0, 7.0, 12.0, 18.0, 26.0, 36.0, 50.0, 70.0)
_CLOSE = 4.0  # px between two names, lest a crowd of them at a hinge reads as one
COVERED = 8.0  # px that a name goes farther rather than over three px of a line

Rectangle = tuple[float, float, float, float]


@dataclass(frozen=True)
class Run:
    """Letters of one size and slope: a base, or an index."""

    text: str
    slanted: bool
    index: bool


@dataclass(frozen=True)
class Label:
    """A name and the place where it begins; ``lead`` is the line to what it names, if far."""

    kind: str
    runs: tuple[Run, ...]
    at: Flat
    box: Rectangle
    lead: tuple[Flat, Flat] | None = None


@dataclass(frozen=True)
class Wanted:
    """A name to be placed: beside a point, preferably in a direction."""

    kind: str
    name: str
    anchor: Flat
    way: Flat


def runs_of(name: str) -> tuple[Run, ...]:
    """Return how a name is written in a drawing, as the pages write it.

    >>> [run.text for run in runs_of("roller_omega_x")]
    ['ω', 'roller', ' ', 'x']
    """
    parts = glyph(name)
    base = Run(spelt(parts.base) + "\u0307" * parts.dots, slanted=slanted(parts.base), index=False)
    below = [Run(spelt(part), slanted=slanted(part), index=True) for part in parts.indices]
    spaced = [Run(" ", slanted=False, index=True)] * (2 * len(below) - 1)
    spaced[::2] = below
    return (base, *spaced)


def wide(runs: Sequence[Run]) -> float:
    """Return how wide letters are drawn at most, in px."""
    total = 0.0
    for run in runs:
        for c in run.text:
            kind = "narrow" if c in _NARROW else "wide" if c in _WIDE else "usual"
            total += _EM[kind] * (SMALL if run.index else SIZE) * (c != "\u0307")
    return total


def placed_labels(
    wanted: Sequence[Wanted], lines: Sequence[Sequence[Flat]], size: tuple[float, float]
) -> list[Label]:
    """Return every name at a place of its own within the picture, clear of lines if it can be.

    A name for which there is no room is left out; the words beside the drawing tell it.
    """
    found: list[Label] = []
    crowded = [p for line in lines for p in _along(line)]
    for each in wanted:
        runs = runs_of(each.name)
        best = (float("inf"), (0.0, 0.0, 0.0, 0.0))
        for cost, box in sorted(_places(each, wide(runs))):
            if cost >= best[0]:
                break
            if _free(box, found, size):
                best = min(best, (cost + COVERED * _hits(box, crowded), box))
        if isfinite(best[0]):
            found.append(_label(each, runs, best[1]))
    return found


def _along(line: Sequence[Flat]) -> Iterator[Flat]:
    """Yield points of a line, a few px apart."""
    for (x, y), (u, v) in pairwise(line):
        steps = 1 + int(max(abs(u - x), abs(v - y)) / 3)
        for k in range(steps + 1):
            yield x + (u - x) * k / steps, y + (v - y) * k / steps


def _places(each: Wanted, width: float) -> Iterator[tuple[float, Rectangle]]:
    """Yield boxes around the anchor, the farther and the more aside the dearer."""
    high = SIZE + DROP
    for gap in _GAPS:
        for c, s in circle()[::2]:
            x, y = each.anchor
            x += c * (gap + width / 2)
            y += s * (gap + high / 2)
            away = 1 - (c * each.way[0] + s * each.way[1])
            box = (x - width / 2, y - high / 2, x + width / 2, y + high / 2)
            yield round(gap + 7 * away, 6), box


def _free(box: Rectangle, others: Sequence[Label], size: tuple[float, float]) -> bool:
    left, top, right, below = box
    inside = left >= 2 and top >= 2 and right <= size[0] - 2 and below <= size[1] - 2
    return inside and not any(
        left < o.box[2] + _CLOSE and o.box[0] < right + _CLOSE
        and top < o.box[3] + _CLOSE and o.box[1] < below + _CLOSE for o in others
    )  # fmt: skip


def _hits(box: Rectangle, crowded: Sequence[Flat]) -> int:
    """Return how many points of lines a name would cover."""
    left, top, right, below = box
    return len([1 for x, y in crowded if left < x < right and top < y < below])


def _label(each: Wanted, runs: tuple[Run, ...], box: Rectangle) -> Label:
    left, top, right, below = box
    near = (min(max(each.anchor[0], left), right), min(max(each.anchor[1], top), below))
    far = (near[0] - each.anchor[0]) ** 2 + (near[1] - each.anchor[1]) ** 2 > 20.0**2
    at = (left, below - DROP - 0.22 * SIZE)
    return Label(each.kind, runs, at, box, (each.anchor, near) if far else None)
