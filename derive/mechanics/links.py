"""A machine whose links all turn about parallel axes: what its links are, and what acts on them.

Vectors have components along the two axes that turn and then along the one that all turn about.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from sympy import Expr, Integer, Matrix, Symbol

from derive.lecture.turning import PLACE
from derive.mechanics.bodies import centre, inertia_tensor, mass
from derive.mechanics.frames import ZERO, Frames
from derive.mechanics.loads import Wrench, wrenches
from derive.scene.declaration import Turning
from derive.scene.machine import INERTIAL, Frame, Weight

Triad = tuple[Expr, Expr, Expr]
NOTHING_YET = Integer(0)
NO_VECTOR: Triad = (NOTHING_YET, NOTHING_YET, NOTHING_YET)
BASE = -1
"""The place of what does not turn, where a link would have its place."""


@dataclass(frozen=True)
class Drift:
    """The acceleration of a point that does not turn: known, and by each unknown."""

    rest: Triad
    slopes: Mapping[Symbol, Triad]


@dataclass(frozen=True)
class Link:
    """A body that turns in its parent by a free angle: its hinge in the parent, what it weighs.

    first, second : its moments of mass about the hinge, along its own axes
    """

    parent: int
    unknown: Symbol
    rate: Expr
    cosine: Expr
    sine: Expr
    hinge: Triad
    drift: Drift | None
    mass: Expr = NOTHING_YET
    first: Triad = NO_VECTOR
    second: Expr = NOTHING_YET


@dataclass(frozen=True)
class Push:
    """A known force along the axes of a link, at a point of a link, and a known couple."""

    link: int
    arm: Triad
    drift: Drift | None
    along: int
    force: Triad
    couple: Expr


@dataclass(frozen=True)
class Links:
    """Links, parents first, the masses that do not turn, gravity, and all else that acts."""

    links: tuple[Link, ...]
    carried: tuple[tuple[Expr, Drift], ...]
    gravity: Triad
    pushes: tuple[Push, ...]

    @property
    def unknowns(self) -> frozenset[Symbol]:
        """Return the accelerations that a motion of the machine is made of."""
        drifts = (*(d for _, d in self.carried), *(k.drift for k in self.links if k.drift))
        return frozenset((*(k.unknown for k in self.links), *(u for d in drifts for u in d.slopes)))

    def path(self, link: int) -> list[int]:
        """Return a link, its parent, and so on, without the base."""
        found = []
        while link != BASE:
            found.append(link)
            link = self.links[link].parent
        return found


class OtherMachineError(Exception):
    """A machine that has more than links about parallel axes."""


def links(frames: Frames, sought: frozenset[Symbol]) -> Links | None:
    """Return the links of a machine, None if it has more than turns about parallel axes.

    sought : the unknowns of the motion; all others do no work, which who uses this has to prove
    """
    axes = {t.axis for f in frames.each.values() for t in f.turned}
    if len(axes) != 1:
        return None
    try:
        return _Reader(frames, sought, PLACE[axes.pop()]).read()
    except OtherMachineError:
        return None


class _Reader:
    """Reads frames, bodies and loads, and gives up at what is no link."""

    def __init__(self, frames: Frames, sought: frozenset[Symbol], axis: int) -> None:
        self.frames, self.sought, self.axis = frames, sought, axis
        words = frames.words
        self.fixed = words.vocabulary.fixed() | words.hidden.keys()
        self.links: list[Link] = []
        self.of: dict[str, int] = {INERTIAL: BASE}
        self.at: dict[str, Matrix] = {INERTIAL: ZERO}  # the origin of a frame, in its link's axes

    def read(self) -> Links:
        for name, frame in self.frames.each.items():
            if name != INERTIAL:
                self._frame(frame)
        carried = [own for b in self.frames.machine.bodies for own in self._body(b.name)]
        acting = wrenches(self.frames)
        gravity, weights = self._gravity()
        pushes = tuple(p for w in acting if w.load not in weights for p in self._push(w))
        return Links(tuple(self.links), tuple(carried), gravity, pushes)

    def _frame(self, frame: Frame) -> None:
        moves = (frame.angular_velocity, frame.velocity, frame.acceleration, frame.rolls)
        if frame.attitude or any(m is not None for m in moves) or len(frame.turned) > 1:
            raise OtherMachineError
        link, origin = self.of[frame.parent], self.frames.words.column(frame.origin)
        place = self.at[frame.parent] + origin
        if link != BASE and not self._constant(place):
            raise OtherMachineError
        self.of[frame.name], self.at[frame.name] = link, place
        if frame.turned:
            self._turned(frame.name, frame.turned[0], link, place)

    def _turned(self, name: str, turn: Turning, parent: int, place: Matrix) -> None:
        sheet, R = self.frames.sheet, self.frames.rotations[name]
        angle = self.frames.words.expression(turn.angle)
        rate = sheet.rate(angle)
        rest, slopes = sheet.split(sheet.rate(rate))
        if R is None or rest != 0 or list(slopes.values()) != [1]:
            raise OtherMachineError
        i, j = (self.axis + 1) % 3, (self.axis + 2) % 3
        drift = self._drift(place) if parent == BASE else None
        (unknown,) = slopes
        self.of[name], self.at[name] = len(self.links), ZERO
        self.links.append(Link(parent, unknown, rate, R[i, i], R[j, i], self._along(place), drift))

    def _body(self, body: str) -> list[tuple[Expr, Drift]]:
        """Add a body to its link, or return it if it does not turn."""
        member = self.frames.machine.body(body)
        if member.turned or member.spin_axis is not None or member.angular_velocity is not None:
            raise OtherMachineError
        m, I = mass(self.frames, body), inertia_tensor(self.frames, body)  # noqa: E741
        frame, at = centre(self.frames, body)
        link, place = self.of[frame], self.at[frame] + at
        if link == BASE:
            return [(m, self._drift(place))]
        if not self._constant(place):
            raise OtherMachineError
        own, (x, y, z) = self.links[link], self._along(place)
        first = tuple(a + m * r for a, r in zip(own.first, (x, y, z), strict=True))
        second = own.second + I[self.axis, self.axis] + m * (x**2 + y**2)
        self.links[link] = replace(own, mass=own.mass + m, first=first, second=second)
        return []

    def _gravity(self) -> tuple[Triad, frozenset[str]]:
        """Return the gravity that acts on all bodies, and the loads that it is."""
        machine = self.frames.machine
        loads = [load for load in machine.loads if isinstance(load, Weight)]
        if len(loads) != 1 or {*loads[0].on} != {b.name for b in machine.bodies}:
            return NO_VECTOR, frozenset()
        (load,) = loads
        g = self.frames.words.column(load.gravity)
        if self.of[load.along] != BASE or not self._constant(g):
            return NO_VECTOR, frozenset()
        return self._along(g), frozenset({load.name})

    def _push(self, w: Wrench) -> list[Push]:
        """Return what of a load is known, in nothing if it is only what holds a joint."""
        reactions = dict.fromkeys(self.frames.sheet.unknowns - self.sought, Integer(0))
        force, couple = (self._along(v.xreplace(reactions)) for v in (w.force, w.couple))
        if any(e.free_symbols & self.sought for e in (*force, *couple)):
            raise OtherMachineError
        frame = self.frames.own(w.body)
        link, along = self.of[frame], self.of[w.along]
        if force == NO_VECTOR:
            still = couple[2] == 0 or link == BASE
            return [] if still else [Push(link, NO_VECTOR, None, along, force, couple[2])]
        if self.of[w.point[0]] != link:
            raise OtherMachineError
        place = self.at[w.point[0]] + w.point[1]
        drift = self._drift(place) if link == BASE else None
        arm = self._along(place) if link != BASE else NO_VECTOR
        return [Push(link, arm, drift, along, force, couple[2])]

    def _drift(self, place: Matrix) -> Drift:
        sheet = self.frames.sheet
        second = sheet.rate_of_column(sheet.rate_of_column(place))
        each = [sheet.split(e) for e in self._along(second)]
        found = {u for _, slopes in each for u in slopes}
        if not found <= self.sought:
            raise OtherMachineError
        by = {u: tuple(s.get(u, Integer(0)) for _, s in each) for u in sorted(found, key=str)}
        if not all(self._constant(Matrix(d)) for d in by.values()):
            raise OtherMachineError
        return Drift(tuple(rest for rest, _ in each), by)

    def _constant(self, values: Matrix) -> bool:
        return bool(values.free_symbols <= self.fixed)

    def _along(self, vector: Matrix) -> Triad:
        a = self.axis
        return vector[(a + 1) % 3], vector[(a + 2) % 3], vector[a]
