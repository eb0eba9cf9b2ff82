"""A drawing of a scene: bodies with their shapes, axes, loads and springs, each with its name.

Everything is placed in space by the scene's own angles and lengths and then seen from one side.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from derive.emit.drawing.label import Label, Wanted, placed_labels
from derive.emit.drawing.parts import solids
from derive.emit.drawing.pose import Stance, stance
from derive.emit.drawing.sight import Sight, facing, painted, seen_runs, sight
from derive.emit.drawing.solid import Solid
from derive.emit.drawing.space import Flat, Position, circle, extent, inner_product
from derive.emit.drawing.strokes import Stroke, load_strokes, triads
from derive.emit.drawing.told import drawing_told
from derive.emit.templates import TEMPLATES
from derive.scene import Scene
from derive.scene.wanted import attitudes_only

WIDTH, HEIGHT, ASIDE, ABOVE = 340, 250, 42, 26  # px; room at the sides and above for names
HEAD, SPREAD = 7.0, 2.6  # px: arrow heads
DOT = 3.0  # px: radius of a point mass


@dataclass(frozen=True)
class Path:
    """A path of the picture: its class, and lines through points, closed or not."""

    kind: str
    lines: tuple[tuple[Flat, ...], ...]
    closed: bool = False


@dataclass(frozen=True)
class Paper:
    """Where on the picture a point is drawn: enlarged, then moved."""

    by: Sight
    scale: float
    left: float
    top: float

    def at(self, point: Position) -> Flat:
        """Return the place of a point."""
        x, y = self.by.flat(point)
        return self.left + self.scale * x, self.top + self.scale * y


def drawing(scene: Scene) -> str:
    """Return the SVG of a scene."""
    found = stance(scene)
    by = sight(found)
    shown = [] if attitudes_only(list(scene.wanted)) else solids(found, by.towards)
    size = _size(found, shown)
    lines = list(triads(found, shown, size))
    lines += load_strokes(found, by, size) if shown else []
    paper = _paper(by, shown, lines)
    paths = [p for s in painted(shown, by) for p in _solid(s, paper)]
    margin = 1e-4 * size
    paths += [p for line in lines for p in _stroke(line, shown, paper, margin)]
    labels = _labels(found, shown, lines, paths, paper)
    return TEMPLATES.get_template("drawing.svg.jinja").render(
        size=(WIDTH, HEIGHT), says=drawing_told(scene), paths=paths, labels=labels
    )


def _size(found: Stance, shown: Sequence[Solid]) -> float:
    """Return how far apart the points of a machine are: of bodies, and where loads act."""
    points = [p for s in shown for p in s.corners]
    for load in found.machine.loads if shown else ():
        for frame, at in (("frame", "at"), ("to_frame", "to")):
            if hasattr(load, at):
                points.append(found.place(getattr(load, frame), getattr(load, at)))
    if not points:
        return 1.0
    spans = [max(p[k] for p in points) - min(p[k] for p in points) for k in range(3)]
    return max(spans) or 1.0


def _paper(by: Sight, shown: Sequence[Solid], lines: Sequence[Stroke]) -> Paper:
    each = [by.flat(p) for s in shown for p in s.corners]
    each += [by.flat(p) for line in lines for p in line.points]
    low, high = ([pick(p[k] for p in each) for k in range(2)] for pick in (min, max))
    wide, tall = high[0] - low[0] or 1.0, high[1] - low[1] or 1.0
    scale = min((WIDTH - 2 * ASIDE) / wide, (HEIGHT - 2 * ABOVE) / tall)
    left = (WIDTH - scale * (low[0] + high[0])) / 2
    return Paper(by, scale, left, (HEIGHT - scale * (low[1] + high[1])) / 2)


def _solid(solid: Solid, paper: Paper) -> Iterator[Path]:
    """Yield the paths of a solid: its outline, then the faces that are seen, then lines on it."""
    flat = tuple(map(paper.at, solid.corners))
    match solid.kind:
        case "rod":
            yield Path("rod", (flat,))
        case "hoop":
            yield Path("rod", (flat,), closed=True)
        case "mass":
            yield Path("solid", (_dot(flat[0]),), closed=True)
        case _:
            yield Path(solid.kind, (hull(flat),), closed=True)
    right = paper.by.right
    for face in solid.faces:
        if facing(face.outward, paper.by):
            dark = len(solid.faces) > 2 and inner_product(face.outward, right) > 0.3
            kind = "shade" if dark else "face"
            yield Path(kind, (tuple(map(paper.at, face.corners)),), closed=True)
            if face.hole:
                yield Path("shade", (tuple(map(paper.at, face.hole)),), closed=True)
    if solid.lines:
        yield Path("edge", tuple(_front(solid, paper)))


def _front(solid: Solid, paper: Paper) -> Iterator[tuple[Flat, ...]]:
    """Yield the parts of the lines on a solid that the viewer sees."""
    for line in solid.lines:
        seen = [facing(outward, paper.by) for _, outward in line[:-1]]
        start = next((k for k in range(len(seen)) if seen[k] and not seen[k - 1]), 0)
        turned = [(start + k) % len(seen) for k in range(len(seen) + all(seen))]
        places = [k for k in turned if seen[k]]
        if len(places) > 1:
            yield tuple(paper.at(line[k][0]) for k in places)


def _dot(at: Flat) -> tuple[Flat, ...]:
    return tuple((at[0] + DOT * c, at[1] + DOT * s) for c, s in circle()[::3])


def hull(points: Sequence[Flat]) -> tuple[Flat, ...]:
    """Return the corners of the smallest convex outline around points, in order."""
    ordered = sorted(set(points))
    if len(ordered) < 3:
        return tuple(ordered)
    return (*_chain(ordered), *_chain(ordered[::-1]))


def _chain(ordered: Sequence[Flat]) -> list[Flat]:
    """Return one side of the outline, without its last corner (Andrew's monotone chain)."""
    side: list[Flat] = []
    for p in ordered:
        while len(side) > 1 and _turn(side[-2], side[-1], p) <= 0:
            side.pop()
        side.append(p)
    return side[:-1]


def _turn(a: Flat, b: Flat, c: Flat) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _stroke(stroke: Stroke, shown: Sequence[Solid], paper: Paper, margin: float) -> Iterator[Path]:
    """Yield a line, dashed where something stands before it, and its arrow head."""
    if stroke.kind == "joint":
        yield Path("joint", (_dot(paper.at(stroke.points[-1])),), closed=True)
    elif stroke.above:
        yield Path(stroke.kind, (tuple(map(paper.at, stroke.points)),))
    else:
        each = [run for a, b in pairwise(stroke.points)
                for run in seen_runs(a, b, shown, paper.by, margin)]  # fmt: skip
        for covered, kind in ((False, stroke.kind), (True, f"{stroke.kind} hidden")):
            own = tuple((paper.at(a), paper.at(b)) for seen, a, b in each if seen == covered)
            if own:
                yield Path(kind, own)
    if stroke.headed:
        head = _head(paper.at(stroke.points[-2]), paper.at(stroke.points[-1]))
        yield Path(f"{stroke.kind} head", (head,), closed=True)


def _head(before: Flat, tip: Flat) -> tuple[Flat, ...]:
    x, y = tip[0] - before[0], tip[1] - before[1]
    long = extent((x, y, 0.0)) or 1.0
    x, y = x / long, y / long
    base = (tip[0] - HEAD * x, tip[1] - HEAD * y)
    return tip, (base[0] - SPREAD * y, base[1] + SPREAD * x), (
        base[0] + SPREAD * y, base[1] - SPREAD * x)  # fmt: skip


def _labels(
    found: Stance, shown: Sequence[Solid], lines: Sequence[Stroke], paths: Sequence[Path],
    paper: Paper,
) -> list[Label]:  # fmt: skip
    wanted = [_beside(line, paper) for line in lines if line.label]
    if len(found.machine.bodies) > 1:
        for body in found.machine.bodies:
            own = next((s for s in shown if s.owner == body.name), None)
            if own is not None and body.name.isidentifier():
                at = paper.at(own.centre)
                wanted.append(Wanted("body", body.name, at, (0.0, -1.0)))
    drawn = [line for path in paths if path.kind.split()[0] not in ("solid", "inertia")
             for line in path.lines]  # fmt: skip
    return placed_labels(wanted, drawn, (WIDTH, HEIGHT))


def _beside(line: Stroke, paper: Paper) -> Wanted:
    start, end = paper.at(line.points[0]), paper.at(line.points[-1])
    if line.away == "tail":
        start, end = end, start
    way = (end[0] - start[0], end[1] - start[1])
    long = extent((*way, 0.0)) or 1.0
    return Wanted(line.kind, line.label, end, (way[0] / long, way[1] / long))
