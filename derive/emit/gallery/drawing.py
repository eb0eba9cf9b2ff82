"""A drawing of a scene: its frames as triads, its bodies as the ellipsoids of their inertia.

The ellipsoid of a body has its mass and its second moments, so that a disc is flat, a rod is a
line, and a body that is turned is seen to be turned. Everything is placed by the scene's own
angles and lengths: a machine at seven tenths of their ranges, a single body in the middle.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import fsum
from typing import Any

from mpmath import mp, mpf

from derive.emit.templates import TEMPLATES
from derive.scene import Input, Scene
from derive.scene.formula import ZERO
from derive.scene.machine import INERTIAL, Force
from derive.scene.said import without_hidden
from derive.scene.wanted import attitudes_only
from derive.verify.cloud.balance import at_instant
from derive.verify.cloud.history import History
from derive.verify.cloud.series import DIGITS

WIDTH, HEIGHT, MARGIN = 260, 180, 18
STEPS = 36  # of an ellipse
SIGHT = ((0.82, -0.57, 0.0), (0.26, 0.37, 0.89))  # what is right and what is up, seen from x, y, z

Position = tuple[Any, Any, Any]


@dataclass(frozen=True)
class Polyline:
    """A line through points in space, and what it stands for."""

    kind: str
    points: tuple[Position, ...]
    label: str = ""


def drawing(scene: Scene) -> str:
    """Return the SVG of a scene."""
    with mp.workdps(DIGITS):
        lines = list(_lines(scene))
        return _svg(lines, f"drawing of {scene.name}")


def well_inside(machine: Scene) -> dict[str, Any]:
    """Return every argument of a machine at seven tenths of its range, accelerations at zero."""
    ends = {p.name: (3 * p.low + 7 * p.high) / 10 for p in machine.parameters}
    for m in machine.moving:
        ends[m.name] = (3 * m.low + 7 * m.high) / 10
        each = (i for i in (m.rate, m.acceleration) if isinstance(i, Input))
        ends |= {i.name: (3 * i.low + 7 * i.high) / 10 for i in each}
    found = {name: mpf(x.numerator) / x.denominator for name, x in ends.items()}
    found |= {m.unknown: mpf(0) for m in machine.moving if m.free}
    found |= {u.name: mpf(0) for u in machine.unknowns}
    for frame in machine.frames:
        if frame.attitude:
            found |= {f"{frame.attitude}_{p}": mpf(p == "w") for p in "wxyz"}
    return found


def _lines(machine: Scene) -> Iterator[Polyline]:
    history = History(machine, well_inside(machine))
    shown = () if attitudes_only(list(machine.wanted)) else machine.bodies
    bodies = [line for b in shown for line in _ellipses(history, b.name)]
    size = _reach([p for line in bodies for p in line.points])
    yield from bodies
    for frame in machine.frames:
        origin, R = (
            at_instant(history.origins[frame.name]),
            at_instant(history.rotations[frame.name]),
        )
        kind = "ground" if frame.name == INERTIAL and shown else "frame"
        for k in range(3):
            end = origin + R[:, k] * (size / 2)
            yield Polyline(kind, (tuple(origin), tuple(end)), "xyz"[k] if kind == "frame" else "")
    for load in machine.loads:
        if isinstance(load, Force):
            yield from _forces(history, load, size)


def _forces(history: History, load: Force, size: Any) -> Iterator[Polyline]:
    place, R = (
        at_instant(history.place(load.frame, load.at)),
        at_instant(history.rotations[load.along]),
    )
    for k, f in enumerate(without_hidden(load.force)):
        if f != ZERO:
            start = place - R[:, k] * (size / 3)
            yield Polyline("force", (tuple(start), tuple(place)))


def _ellipses(history: History, name: str) -> Iterator[Polyline]:
    """Return the three principal ellipses of a body."""
    centre = at_instant(history.centre(name))
    reached = [at_instant(place) - centre for _, place in history.particles(name)[:-1:2]]
    semi = [arm * mp.sqrt(mpf(5) / 3) for arm in reached]
    yield from _around(centre, semi, name)


def _around(centre: Any, semi: Sequence[Any], name: str) -> Iterator[Polyline]:
    for a, b in ((0, 1), (1, 2), (2, 0)):
        turn = [2 * mp.pi * n / STEPS for n in range(STEPS + 1)]
        points = tuple(tuple(centre + semi[a] * mp.cos(t) + semi[b] * mp.sin(t)) for t in turn)
        yield Polyline("body", points, name if a == 0 else "")


def _reach(points: Iterable[Position]) -> Any:
    """Return the size of what is drawn."""
    each = list(points)
    if not each:
        return mpf(1)
    spans = [max(p[k] for p in each) - min(p[k] for p in each) for k in range(3)]
    return max(spans) or mpf(1)


def _seen(point: Position) -> tuple[float, float]:
    right, up = (fsum(s * float(x) for s, x in zip(way, point, strict=True)) for way in SIGHT)
    return right, -up


def _svg(lines: Sequence[Polyline], says: str) -> str:
    flat = [[_seen(p) for p in line.points] for line in lines]
    xs, ys = zip(*(p for line in flat for p in line), strict=True)
    wide, high = max(xs) - min(xs) or 1.0, max(ys) - min(ys) or 1.0
    scale = min((WIDTH - 2 * MARGIN) / wide, (HEIGHT - 2 * MARGIN) / high)
    left = (WIDTH - scale * wide) / 2 - scale * min(xs)
    top = (HEIGHT - scale * high) / 2 - scale * min(ys)
    placed = [[(left + scale * x, top + scale * y) for x, y in line] for line in flat]
    return TEMPLATES.get_template("drawing.svg.jinja").render(
        size=(WIDTH, HEIGHT), says=says, lines=list(zip(lines, placed, strict=True))
    )
