"""Lines of a drawing that are no bodies: axes of frames, forces, moments, weights, springs."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from derive.emit.drawing.pose import Stance
from derive.emit.drawing.sight import Sight
from derive.emit.drawing.solid import Solid
from derive.emit.drawing.space import (
    Basis,
    Position,
    basis_along,
    circle,
    directed,
    extent,
    inner_product,
    shifted,
    times,
    within,
)
from derive.scene.formula import ZERO, Formula, symbols
from derive.scene.machine import INERTIAL, Force, Gradient, Load, Spring, Weight
from derive.scene.said import is_hidden, without_hidden

ARROW, TURN, AXES = 0.3, 0.1, 0.42  # of the size of a drawing: forces, radius of moments, axes
COILS, FEWEST_COILS, COIL = 9, 3, 0.04  # a coil is so long at least, of the size


@dataclass(frozen=True)
class Stroke:
    """A line through points of space.

    kind : what it stands for        label : a name; "" for none
    headed : whether it ends in an arrow head        above : whether no solid hides it
    away : the end that the name stands beside, seen from the other: the head, or the tail
    """

    kind: str
    points: tuple[Position, ...]
    label: str = ""
    headed: bool = False
    above: bool = True
    away: Literal["head", "tail"] = "head"


def triads(found: Stance, solids: Sequence[Solid], size: float) -> Iterator[Stroke]:
    """Yield the axes of all frames, those that coincide once, the innermost first."""
    drawn: list[tuple[Position, Position]] = []
    frames = list(reversed(found.machine.frames))
    own = {f.name: found.frames[f.name] for f in frames}
    several = len(frames) > 2
    for frame in frames:
        origin, basis = own[frame.name]
        for k, axis in enumerate("xyz"):
            if any(_same(origin, basis[k], o, way, size) for o, way in drawn):
                continue
            drawn.append((origin, basis[k]))
            name = "N" if frame.name == INERTIAL else frame.name
            label = f"{axis}_{name}" if several or frame.name == INERTIAL else axis
            kind = "ground" if frame.name == INERTIAL else "axis"
            reach = _reach(found, frame.name, basis[k], origin, solids, size)
            yield Stroke(kind, (origin, shifted(origin, basis[k], reach)), label, above=False)


def _same(origin: Position, way: Position, other: Position, its: Position, size: float) -> bool:
    near = extent(shifted(origin, other, -1.0)) < 1e-6 * size
    return near and extent(shifted(way, its, -1.0)) < 1e-6


def _reach(
    found: Stance, frame: str, way: Position, origin: Position, solids: Sequence[Solid], size: float
) -> float:
    """Return how long an axis is: beyond the bodies of its frame, if they lie around its origin."""
    owners = [b.name for b in found.machine.bodies if b.frame == frame]
    far = [inner_product(shifted(p, origin, -1.0), way)
           for s in solids if s.owner in owners for p in s.corners]  # fmt: skip
    out = max(far, default=0.0) + 0.14 * size
    return min(max(out, 0.3 * size), 0.75 * size)


def load_strokes(found: Stance, by: Sight, size: float) -> Iterator[Stroke]:
    """Yield what acts on the bodies; the first arrow and the first arc of a load carry its name."""
    for load in found.machine.loads:
        named: set[bool] = set()
        for stroke in _of_load(found, load, by, size):
            arc = stroke.kind == "moment"
            label = "" if arc in named else _told(load, stroke.kind)
            named |= {arc} if label else set()
            yield replace(stroke, label=label)


def _told(load: Load, kind: str) -> str:
    """Return the name of a load; of one that a single body in short form has, its letter."""
    if load.name == "external":
        return "M" if kind == "moment" else "F"
    if is_hidden(load.name):
        return load.name.removeprefix("wheel ") if load.name.startswith("wheel ") else ""
    return load.name


def _of_load(found: Stance, load: Load, by: Sight, size: float) -> Iterator[Stroke]:
    match load:
        case Weight():
            axes = found.frames[load.along][1]
            pull = directed(within(axes, [found.figure(f) for f in load.gravity]))
            for name in load.on:
                start = found.centre(found.machine.body(name))
                yield Stroke("weight", (start, shifted(start, pull, ARROW * size)), headed=True)
        case Gradient():
            way = within(found.frames[load.along][1], [found.figure(f) for f in load.towards])
            for name in load.on:
                start = found.centre(found.machine.body(name))
                tip = shifted(start, directed(way), 2 * ARROW * size)
                yield Stroke("weight", (start, tip), headed=True)
        case Spring():
            yield _spring(found, load, by, size)
        case Force():
            yield from _forces(found, load, size)


def _forces(found: Stance, load: Force, size: float) -> Iterator[Stroke]:
    place, along = found.place(load.frame, load.at), found.frames[load.along][1]
    body = found.machine.body(load.on)
    inward = shifted(found.centre(body), place, -1.0)
    shown = [_shown(found, load, each) for each in (load.force, load.couple)]
    if load.against and not is_hidden(load.name):
        yield Stroke("joint", (shifted(place, inward, 0.01), place))
    for k, f in enumerate(shown[0]):
        if f != ZERO:
            way = times(along[k], _sign(found, f))
            pushes = inner_product(way, inward) > 0.3 * extent(inward) > 0.02 * size
            start = shifted(place, way, -ARROW * size) if pushes else place
            points = (start, shifted(start, way, ARROW * size))
            yield Stroke("force", points, headed=True,
                         away="tail" if pushes else "head")  # fmt: skip
    for k, f in enumerate(shown[1]):
        if f != ZERO:
            yield _turning(place, times(along[k], _sign(found, f)), size)


def _shown(found: Stance, load: Force, given: Sequence[Formula]) -> tuple[Formula, ...]:
    """Return the components that have arrows: in a joint of two bodies, those that are known."""
    found_by = {u.name for u in found.machine.unknowns} if load.against else set()
    return tuple(ZERO if found_by & {*symbols(f)} else f for f in without_hidden(given))


def _sign(found: Stance, formula: Formula) -> float:
    return -1.0 if found.figure(formula) < 0 else 1.0


def _turning(place: Position, way: Position, size: float) -> Stroke:
    """Return three quarters of a turn around a direction, a little along it."""
    basis: Basis = basis_along(way)
    middle = shifted(place, way, 0.8 * ARROW * size)
    part, wide = circle()[: 3 * len(circle()) // 4], TURN * size
    points = (shifted(middle, within(basis, (wide * c, wide * s, 0.0))) for c, s in part)
    return Stroke("moment", tuple(points), headed=True)


def _spring(found: Stance, load: Spring, by: Sight, size: float) -> Stroke:
    """Return a zigzag between the ends of a spring; of a damper alone, a plain line."""
    start, end = found.place(load.frame, load.at), found.place(load.to_frame, load.to)
    way = shifted(end, start, -1.0)
    if extent(way) < 1e-3 * size or load.stiffness == ZERO:
        return Stroke("spring", (start, end), above=False)
    side = directed(shifted(by.right, directed(way), -inner_product(by.right, directed(way))))
    points = [start, shifted(start, way, 0.15)]
    coils = max(FEWEST_COILS, min(COILS, round(extent(way) / (COIL * size))))
    for k in range(coils):
        at = shifted(start, way, 0.15 + 0.7 * (k + 0.5) / coils)
        points.append(shifted(at, side, 0.035 * size * (1 if k % 2 else -1)))
    return Stroke("spring", (*points, shifted(start, way, 0.85), end))
