"""A machine of links that turn and slide one in another, of wheels on them, and what acts on them.

All vectors are columns along the axes of a link, or of the base, which does not turn.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from sympy import Expr, Integer, Matrix, Symbol, zeros

from derive.lecture.turning import unit_vector
from derive.mechanics.bulk import NO_BULK, Bulk, at_point
from derive.mechanics.frames import ZERO

BASE = -1
"""The place of what does not turn, where a link would have its place."""


@dataclass(frozen=True)
class Drift:
    """An acceleration, of a point or in turning: known, and by each unknown."""

    rest: Matrix
    slopes: Mapping[Symbol, Matrix]


@dataclass(frozen=True)
class Link:
    """What turns in its parent, mostly about an axis of both, through its hinge.

    axis     : its place, 0 to 2        hinge : along the parent's axes
    spin     : its angular velocity in its parent, along its axes, and ``turning`` how that changes
    going    : how its hinge moves as seen from its parent, along the parent's axes
    drift    : how its hinge accelerates as seen from there; None if it is fixed in its parent
    attitude : what takes its components to its parent's where it does not turn about an axis
    """

    parent: int
    axis: int
    spin: Matrix
    turning: Drift
    cosine: Expr
    sine: Expr
    hinge: Matrix
    drift: Drift | None
    going: Matrix
    bulk: Bulk = NO_BULK
    attitude: Matrix | None = None

    @property
    def turns(self) -> bool:
        """Tell whether it turns in its parent."""
        return self.spin != ZERO or self.turning.rest != ZERO or (self.cosine, self.sine) != (1, 0)

    @property
    def about_axis(self) -> bool:
        """Tell whether it turns about its axis alone."""
        every = (self.spin, self.turning.rest, *self.turning.slopes.values())
        others = [n for n in range(3) if n != self.axis]
        return self.attitude is None and all(v[n] == 0 for v in every for n in others)

    @property
    def rate(self) -> Expr:
        """Return how fast it turns about its axis."""
        return self.spin[self.axis]

    @property
    def unknown(self) -> Symbol | None:
        """Return the second rate of its angle if that alone is unknown."""
        if [*self.turning.slopes.values()] == [unit_vector("xyz"[self.axis])] and self.about_axis:
            return next(iter(self.turning.slopes))
        return None


@dataclass(frozen=True)
class Rotor:
    """What spins on a link about an axis through its mass centre, or any if it is a ball.

    Its mass and all its inertia is the link's; this is what it spins by, along the link's axes.

    inertia : its moment of inertia about the axis
    """

    link: int
    inertia: Expr
    spin: Matrix
    spinning: Drift


@dataclass(frozen=True)
class Push:
    """A known force along the axes of a link, at a point of a link, and a known couple."""

    link: int
    arm: Matrix
    drift: Drift | None
    along: int
    force: Matrix
    couple: Matrix


@dataclass(frozen=True)
class Links:
    """Links, parents first, the masses that do not turn, gravity, and all else that acts.

    level  : the link whose axes gravity is along, or the base
    motors : the known moment about the axis of a link that its parent takes on
    drives : the same where it is sought, with its sign
    acting : what acts on an unknown beside, as on wheels
    """

    links: tuple[Link, ...]
    carried: tuple[tuple[Expr, Drift], ...]
    gravity: Matrix
    pushes: tuple[Push, ...]
    motors: Mapping[int, Expr] = field(default_factory=dict)
    drives: Mapping[int, tuple[Symbol, Expr]] = field(default_factory=dict)
    wheels: tuple[Rotor, ...] = ()
    acting: Mapping[Symbol, Expr] = field(default_factory=dict)
    level: int = BASE

    @property
    def turning(self) -> tuple[Symbol, ...]:
        """Return the unknowns that turn links, those of wheels on them first, from the leaves."""
        wheels = (w.spinning for w in self.wheels if w.link != BASE)
        turns = (*wheels, *(k.turning for k in reversed(self.links)))
        return tuple(dict.fromkeys(u for d in turns for u in d.slopes))

    @property
    def free(self) -> frozenset[Symbol]:
        """Return the accelerations that a motion of the machine is made of."""
        drifts = (*(d for _, d in self.carried), *(w.spinning for w in self.wheels),
                  *(k.drift for k in self.links if k.drift))  # fmt: skip
        return frozenset((*self.turning, *(u for d in drifts for u in d.slopes)))

    @property
    def plain(self) -> bool:
        """Tell whether each link turns freely about an axis, at a place of what carries it."""
        fixed = all((k.parent == BASE) == (k.drift is not None) for k in self.links)
        freely = all(k.unknown is not None for k in self.links)
        angles = {k.unknown for k in self.links}
        apart = len(angles) == len(self.links) and not angles & {
            u for k in self.links if k.drift for u in k.drift.slopes
        }
        still = all(w.link == BASE for w in self.wheels) and self.level == BASE
        return fixed and freely and apart and still and not self.drives

    @property
    def driving(self) -> frozenset[Symbol]:
        """Return the moments of joints that are sought."""
        return frozenset(u for u, _ in self.drives.values())

    def path(self, link: int) -> list[int]:
        """Return a link, its parent, and so on, without the base."""
        found = []
        while link != BASE:
            found.append(link)
            link = self.links[link].parent
        return found

    def augmented(self) -> list[Bulk]:
        """Return each link with all that hangs on it as a mass at its own hinge."""
        found = [k.bulk for k in self.links]
        for n, link in reversed(list(enumerate(self.links))):
            if link.parent != BASE:
                found[link.parent] += at_point(found[n].mass, link.hinge)
        return found


def near_hinges(machine: Links) -> Links:
    """Return the same machine with hinges moved along their axes, nearest to what carries them.

    So the place of a hinge on a link has two components, and often fewer.
    """
    found: list[Link] = []
    moved: list[Matrix] = []
    for link in machine.links:
        hinge, along = link.hinge, ZERO
        if link.parent != BASE:
            hinge = (hinge + moved[link.parent]).applyfunc(lambda e: e.expand())
            if link.drift is None and link.about_axis:
                along = hinge[link.axis] * unit_vector("xyz"[link.axis])
        moved.append(along)
        found.append(replace(link, hinge=hinge - along, bulk=link.bulk.moved(along)))
    pushes = (p if p.link == BASE else replace(p, arm=p.arm + moved[p.link])
              for p in machine.pushes)  # fmt: skip
    return replace(machine, links=tuple(found), pushes=tuple(pushes))


def without_mass_on_axes(machine: Links) -> list[Bulk]:
    """Return augmented links, mass along the axis of each hinge added to the parent instead."""
    found = [k.bulk for k in machine.links]
    for n, link in reversed(list(enumerate(machine.links))):
        own, e = found[n], unit_vector("xyz"[link.axis])
        if link.parent != BASE and not link.turns:
            found[link.parent] += Bulk(Integer(0), ZERO, own.second)
            found[n] = replace(own, second=zeros(3, 3))
            continue
        if not link.about_axis or (link.parent != BASE and link.drift is not None):
            if link.drift is None:
                found[link.parent] += at_point(own.mass, link.hinge)
            continue
        along, spread = own.first[link.axis], own.second[link.axis, link.axis]
        line = Bulk(own.mass, along * e, spread * e * e.T)
        found[n] = Bulk(own.mass, own.first - line.first, own.second - line.second)
        if link.parent != BASE:
            h = link.hinge
            offset = along * h * e.T
            moved = line.mass * h * h.T + offset + offset.T + line.second
            found[link.parent] += Bulk(line.mass, line.mass * h + line.first, moved)
    return found
