"""Bodies as convex solids: points of their surface, the planes that bound them, their flat faces.

What is not convex is several: blades one by one. A tube is a cylinder whose hole is drawn on it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from derive.emit.drawing.space import (
    Basis,
    Position,
    across_both,
    basis_along,
    circle,
    directed,
    inner_product,
    middle_of,
    shifted,
    times,
    within,
)

THIN = 0.05  # half the thickness that a disc or a plate is drawn with, in radii
SLENDER = 0.07  # half the width of a blade, in lengths


@dataclass(frozen=True)
class Face:
    """A flat face: its corners in order, its outward direction, and holes in it."""

    corners: tuple[Position, ...]
    outward: Position
    hole: tuple[Position, ...] = ()


@dataclass(frozen=True)
class Solid:
    """A convex part of a body.

    kind : "solid", "inertia" (an ellipsoid of inertia, seen through), "rod" or "hoop" (lines)
    planes : an outward direction and how far out, of planes that it lies within
    lines : curves on it, each point with the outward direction there
    """

    kind: Literal["solid", "inertia", "rod", "hoop", "mass"]
    owner: str
    corners: tuple[Position, ...]
    faces: tuple[Face, ...] = ()
    planes: tuple[tuple[Position, float], ...] = ()
    lines: tuple[tuple[tuple[Position, Position], ...], ...] = ()

    @property
    def centre(self) -> Position:
        """Return the mean of its corners."""
        return middle_of(self.corners)


def plane(face: Sequence[Position], inside: Position) -> tuple[Position, float]:
    """Return the plane of a face, its direction away from a point inside."""
    normal = directed(across_both(shifted(face[1], face[0], -1.0), shifted(face[2], face[0], -1.0)))
    if inner_product(normal, shifted(face[0], inside, -1.0)) < 0:
        normal = times(normal, -1.0)
    return normal, inner_product(normal, face[0])


def revolved(
    owner: str, centre: Position, basis: Basis, rims: Sequence[tuple[float, float, float]]
) -> Iterator[Solid]:
    """Yield what lies between rims (along, inner, outer) around the third direction."""
    widest = max(outer for _, _, outer in rims)
    if len(rims) == 1:
        along, inner, outer = rims[0]
        if inner:  # a hoop
            yield Solid("hoop", owner, tuple(_ring(centre, basis, along, outer)))
            return
        rims = [(along - THIN * outer, 0.0, outer), (along + THIN * outer, 0.0, outer)]
    if widest <= 0:
        yield Solid("rod", owner, tuple(shifted(centre, basis[2], a) for a, _, _ in rims))
        return
    for below, above in pairwise(rims):
        yield _frustum(owner, centre, basis, below, above)


def _ring(centre: Position, basis: Basis, along: float, radius: float) -> list[Position]:
    if radius <= 0:
        return [shifted(centre, basis[2], along)]
    return [shifted(centre, within(basis, (radius * c, radius * s, along))) for c, s in circle()]


def _frustum(
    owner: str, centre: Position, basis: Basis, below: Sequence[float], above: Sequence[float]
) -> Solid:
    rings = [_ring(centre, basis, rim[0], rim[2]) for rim in (below, above)]
    holes = [_ring(centre, basis, rim[0], rim[1]) if rim[1] else [] for rim in (below, above)]
    faces = tuple(
        Face(tuple(ring), times(basis[2], side), tuple(hole))
        for ring, hole, side in zip(rings, holes, (-1.0, 1.0), strict=True)
        if len(ring) > 1
    )
    first, last = (ring if len(ring) > 1 else ring * len(circle()) for ring in rings)
    inside = middle_of([*rings[0], *rings[1]])
    sides = []
    for k in range(len(circle())):
        quad = [first[k], first[k - 1], last[k], last[k - 1]]
        distinct = list(dict.fromkeys(quad))
        sides.append(plane(distinct, inside))
    caps = [plane(face.corners, inside) for face in faces]
    return Solid("solid", owner, (*rings[0], *rings[1]), faces, (*sides, *caps))


def cuboid(owner: str, centre: Position, basis: Basis, edges: Sequence[float]) -> Solid:
    """Return a box of these edges; one without an edge is drawn with a little of it."""
    half = [(edge or THIN * max(edges)) / 2 for edge in edges]
    corners = {
        signs: shifted(centre, within(basis, [h * s for h, s in zip(half, signs, strict=True)]))
        for signs in ((x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1))
    }
    faces = []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        for side in (-1, 1):
            own = []
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                signs = [0, 0, 0]
                signs[k], signs[i], signs[j] = side, a, b
                own.append(corners[signs[0], signs[1], signs[2]])
            faces.append(Face(tuple(own), times(basis[k], float(side))))
    planes = tuple(plane(face.corners, centre) for face in faces)
    return Solid("solid", owner, tuple(corners.values()), tuple(faces), planes)


def ellipsoid(
    kind: Literal["solid", "inertia"], owner: str, centre: Position, semi: Basis, towards: Position
) -> Solid:
    """Return an ellipsoid by its semi-axes, its outline as seen from far away ``towards``."""
    squares = [inner_product(a, a) for a in semi]
    x, y, z = (inner_product(a, towards) / q for a, q in zip(semi, squares, strict=True))
    across = basis_along((x, y, z))
    outline = tuple(
        shifted(centre, within(semi, shifted(times(across[0], c), across[1], s)))
        for c, s in circle()
    )
    tips = tuple(shifted(centre, a, side) for a in semi for side in (1.0, -1.0))
    ways = [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if x or y or z]
    planes = []
    for way in ways:
        u = directed((float(way[0]), float(way[1]), float(way[2])))
        out = directed(_outward(semi, squares, u))
        planes.append((out, inner_product(out, shifted(centre, within(semi, u)))))
    lines = tuple(_girth(centre, semi, squares, k) for k in range(3))
    return Solid(kind, owner, (*outline, *tips), (), tuple(planes), lines)


def _outward(semi: Basis, squares: Sequence[float], u: Sequence[float]) -> Position:
    """Return the direction out of an ellipsoid at so much of each semi-axis."""
    return within(semi, [x / q for x, q in zip(u, squares, strict=True)])


def _girth(
    centre: Position, semi: Basis, squares: Sequence[float], k: int
) -> tuple[tuple[Position, Position], ...]:
    """Return the ellipse across a semi-axis, each point with the direction outwards."""
    found = []
    for c, s in (*circle(), circle()[0]):
        u = [0.0, 0.0, 0.0]
        u[(k + 1) % 3], u[(k + 2) % 3] = c, s
        found.append((shifted(centre, within(semi, u)), _outward(semi, squares, u)))
    return tuple(found)
