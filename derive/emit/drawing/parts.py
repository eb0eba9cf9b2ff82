"""The solids of a scene's bodies: by their shapes, or by their inertia where no shape is known.

A body of which an axial moment alone is known, or whose other moments another body counts as its
own, is drawn as a wheel about its axis; one of which that moment alone is not, as a rod along it.
"""

from collections.abc import Iterator
from math import sqrt

from derive.emit.drawing.pose import Stance, wheel_axis
from derive.emit.drawing.solid import SLENDER, Solid, cuboid, ellipsoid, revolved
from derive.emit.drawing.space import (
    Basis,
    Position,
    across_both,
    extent,
    shifted,
    times,
    turned_by,
    within,
)
from derive.scene.formula import ZERO
from derive.scene.machine import Member
from derive.scene.shape import AXIS_AFTER, Portion

NARROW = 0.03  # of the largest semi-axis: thinner ellipsoids are drawn so thick, or as a rod
WHEEL = 0.32  # radius of a wheel of unknown mass, of the size of the other bodies
WIDTH = 0.3  # half the width of a wheel, in radii


def solids(found: Stance, towards: Position) -> list[Solid]:
    """Return the solids of all bodies of a scene."""
    known = [s for b in found.machine.bodies for s in _of_body(found, b, towards)]
    size = max((extent(shifted(p, s.centre, -1.0)) for s in known for p in s.corners), default=1.0)
    wheels = [b for b in found.machine.bodies if is_wheel(found, b)]
    return [*known, *(s for b in wheels for s in _wheel(found, b, size))]


def is_wheel(found: Stance, body: Member) -> bool:
    """Return whether of a body without a shape too little is known for its ellipsoid."""
    if body.parts or is_beam(body):
        return False
    return None in body.inertia or not found.semi_axes(body)[1]


def is_beam(body: Member) -> bool:
    """Return whether a moment across an axis is all that is known of a body."""
    if body.parts or body.axis is None:
        return False
    along, across = (body.inertia["xyz".index(name)] for name in (body.axis, AXIS_AFTER[body.axis]))
    return along is None and across is not None


def _of_body(found: Stance, body: Member, towards: Position) -> Iterator[Solid]:
    centre = found.centre(body)
    if body.parts:
        for part in body.parts:
            yield from _of_part(found, body, part, centre, towards)
    elif is_beam(body):
        yield _beam(found, body, centre)
    elif not is_wheel(found, body):
        yield from _of_inertia(body.name, centre, found.semi_axes(body)[0], towards)


def _of_part(
    found: Stance, body: Member, part: Portion, centre: Position, towards: Position
) -> Iterator[Solid]:
    own, k = found.axes(body), "xyz".index(part.axis)
    around: Basis = (own[(k + 1) % 3], own[(k + 2) % 3], own[k])
    edges = [found.figure(f) for f in part.edges]
    match part.kind:
        case "round":
            rims = [(found.figure(a), found.figure(b), found.figure(c)) for a, b, c in part.rims]
            yield from revolved(body.name, centre, around, rims)
        case "box":
            yield cuboid(body.name, centre, own, edges)
        case "ball" if not any(edges):
            yield Solid("mass", body.name, (centre,))
        case "ball":
            x, y, z = (times(a, e) for a, e in zip(own, edges, strict=True))
            yield ellipsoid("solid", body.name, centre, (x, y, z), towards)
        case "blade":
            yield _blade(body.name, centre, own, part, edges)


def _blade(name: str, centre: Position, own: Basis, part: Portion, edges: list[float]) -> Solid:
    """Return a slender blade, flat in the plane of all blades."""
    start, end, length = edges
    axis, first = "xyz".index(part.axis), "xyz".index(AXIS_AFTER[part.axis])
    across = 3 - axis - first
    c, s = turned_by(part.turned)
    along = shifted(times(own[first], c), own[across], s)
    beam = shifted(times(own[across], c), own[first], -s)
    middle = shifted(centre, along, (start + end) / 2)
    width = SLENDER * length
    return cuboid(name, middle, (along, beam, own[axis]), [end - start, 2 * width, width / 2])


def _beam(found: Stance, body: Member, centre: Position) -> Solid:
    """Return the uniform rod that has a body's mass and its moment across its axis."""
    moment = body.inertia["xyz".index(AXIS_AFTER[body.axis or "z"])] or ZERO
    mass = found.figure(body.mass) if body.mass is not None else 1.0
    reach = sqrt(3 * abs(found.figure(moment)) / mass)
    long = times(found.axes(body)["xyz".index(body.axis or "z")], reach)
    return Solid("rod", body.name, (shifted(centre, long, -1.0), shifted(centre, long)))


def _of_inertia(name: str, centre: Position, semi: Basis, towards: Position) -> Iterator[Solid]:
    widest = max(map(extent, semi))
    thin = [extent(a) < NARROW * widest for a in semi]
    if thin.count(True) > 1:
        long = semi[thin.index(False)]
        reach = sqrt(3 / 5)  # of a uniform rod
        yield Solid("rod", name, (shifted(centre, long, -reach), shifted(centre, long, reach)))
        return
    axes = [across_both(semi[k - 2], semi[k - 1]) if thin[k] else a for k, a in enumerate(semi)]
    x, y, z = (
        times(a, NARROW * widest / extent(a) if thin[k] else 1.0) for k, a in enumerate(axes)
    )
    yield ellipsoid("inertia", name, centre, (x, y, z), towards)


def _wheel(found: Stance, body: Member, size: float) -> Iterator[Solid]:
    """Return a wheel, as large as its axial moment and mass say, or a part of the bodies."""
    basis = wheel_axis(found, body)
    mass = None if body.mass is None else found.figure(body.mass)
    k = "xyz".index(body.axis) if body.axis else 0
    moment = body.inertia[k]
    radius = WHEEL * size
    if mass and moment is not None and body.spin_axis is None:
        radius = sqrt(2 * abs(found.figure(moment)) / mass)
    centre = shifted(found.centre(body), within(basis, (0.0, 0.0, 0.0)))
    yield from revolved(
        body.name, centre, basis, [(-WIDTH * radius, 0.0, radius), (WIDTH * radius, 0.0, radius)]
    )
