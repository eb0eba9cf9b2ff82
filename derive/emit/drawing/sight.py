"""How space is seen: from the side and a little above, far away, gravity downwards.

Solids are painted from behind to before; of a line, what a solid stands before is told apart.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from derive.emit.drawing.pose import Stance
from derive.emit.drawing.solid import Solid
from derive.emit.drawing.space import (
    ORIGIN,
    Basis,
    Flat,
    Position,
    directed,
    inner_product,
    shifted,
    times,
    turned_by,
)
from derive.scene.machine import Weight

STEPS = 24  # of a line, each of which is seen or hidden
ASIDE, ABOVE = 50 / 360, 22 / 360  # of a turn
_UPRIGHT: dict[tuple[int, int], tuple[Position, Position, Position]] = {
    (2, 1): ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    (2, -1): ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0)),
    (1, 1): ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    (1, -1): ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0)),
    (0, 1): ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)),
    (0, -1): ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0)),
}
"""Right-handed directions (to the viewer's left and front, right, up), by the axis that is up."""


@dataclass(frozen=True)
class Sight:
    """What is right, what is up, and where the viewer is, in directions of N."""

    right: Position
    up: Position
    towards: Position

    def flat(self, point: Position) -> Flat:
        """Return where a point is seen, downwards positive."""
        return inner_product(point, self.right), -inner_product(point, self.up)

    def near(self, point: Position) -> float:
        """Return how near a point is."""
        return inner_product(point, self.towards)


def sight(found: Stance) -> Sight:
    """Return the sight of a scene: what its weights point away from is up."""
    front, side, up = _UPRIGHT[_upwards(found)]
    c, s = turned_by(ASIDE)
    below, high = turned_by(ABOVE)
    ahead = shifted(times(front, c), side, s)
    return Sight(
        shifted(times(side, c), front, -s),
        shifted(times(up, below), ahead, -high),
        shifted(times(ahead, below), up, high),
    )


def _upwards(found: Stance) -> tuple[int, int]:
    pull = ORIGIN
    for load in found.machine.loads:
        if isinstance(load, Weight):
            axes: Basis = found.frames[load.along][1]
            for k in range(3):
                pull = shifted(pull, axes[k], found.figure(load.gravity[k]))
    if pull == ORIGIN:
        return 2, 1
    place = max(range(3), key=lambda k: (abs(pull[k]), k))
    return place, -1 if pull[place] > 0 else 1


def painted(solids: Sequence[Solid], by: Sight) -> list[Solid]:
    """Return solids from the one behind all others to the one before."""
    waiting, done = sorted(solids, key=lambda s: by.near(s.centre)), []
    while waiting:
        free = [
            s
            for s in waiting
            if not any(_before(s, other, by) for other in waiting if other is not s)
        ]
        done.append((free or waiting)[0])
        waiting.remove(done[-1])
    return done


def _before(one: Solid, other: Solid, by: Sight) -> bool:
    """Return whether a plane of either tells that the first stands before the second."""
    if one.kind == "inertia" or other.kind == "inertia":
        return one.kind == "inertia" and other.kind != "inertia"  # seen through, so painted last
    return _parted(one, other, by, 1.0) or _parted(other, one, by, -1.0)


def _parted(one: Solid, other: Solid, by: Sight, side: float) -> bool:
    """Return whether the other lies beyond a plane of one that faces away, or faces the viewer."""
    small = 1e-6 * (1.0 + max(abs(c) for p in one.corners for c in p))
    for normal, far in one.planes:
        beyond = all(inner_product(normal, p) >= far - small for p in other.corners)
        if beyond and side * inner_product(normal, by.towards) < 0:
            return True
    return False


def hidden(point: Position, solids: Sequence[Solid], by: Sight, margin: float) -> bool:
    """Return whether a solid stands between a point and the viewer."""
    return any(_covers(solid, point, by, margin) for solid in solids if solid.kind == "solid")


def _covers(solid: Solid, point: Position, by: Sight, margin: float) -> bool:
    """Clip the ray from a point to the viewer by the planes of a solid."""
    enters, leaves = margin, float("inf")
    for normal, far in solid.planes:
        rate, room = inner_product(normal, by.towards), far - inner_product(normal, point)
        if abs(rate) < 1e-12:
            if room < 0:
                return False
        elif rate > 0:
            leaves = min(leaves, room / rate)
        else:
            enters = max(enters, room / rate)
    return leaves > enters + margin


def seen_runs(
    start: Position, end: Position, solids: Sequence[Solid], by: Sight, margin: float
) -> list[tuple[bool, Position, Position]]:
    """Return a line in pieces, each with whether it is hidden."""
    step = times(shifted(end, start, -1.0), 1 / STEPS)
    marks = [hidden(shifted(start, step, k + 0.5), solids, by, margin) for k in range(STEPS)]
    found = []
    for covered, group in groupby(range(STEPS), key=marks.__getitem__):
        places = list(group)
        found.append(
            (covered, shifted(start, step, places[0]), shifted(start, step, places[-1] + 1))
        )
    return found


def facing(outward: Position, by: Sight) -> bool:
    """Return whether a face is seen from outside."""
    return inner_product(directed(outward), by.towards) > 1e-9
