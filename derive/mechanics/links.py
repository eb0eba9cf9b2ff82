"""A machine whose links turn one in another about axes of theirs: what they are, and what acts.

All vectors are columns along the axes of a link, or of the base, which does not turn.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from sympy import Expr, Integer, Matrix, Rational, Symbol, eye

from derive.lecture.turning import PLACE, unit_vector
from derive.mechanics.bodies import centre, inertia_tensor, mass
from derive.mechanics.bulk import NO_BULK, Bulk, at_point
from derive.mechanics.frames import ZERO, Frames
from derive.mechanics.loads import Wrench, wrenches
from derive.scene.declaration import Turning
from derive.scene.machine import INERTIAL, Force, Frame, Weight

BASE = -1
"""The place of what does not turn, where a link would have its place."""


@dataclass(frozen=True)
class Drift:
    """The acceleration of a point that does not turn: known, and by each unknown."""

    rest: Matrix
    slopes: Mapping[Symbol, Matrix]


@dataclass(frozen=True)
class Link:
    """What turns in its parent about an axis of both, through its hinge.

    axis    : its place, 0 to 2         hinge : along the parent's axes
    unknown : the second rate of its angle where it is free; else that is ``known``
    drift   : how its hinge accelerates where its parent is the base
    """

    parent: int
    axis: int
    unknown: Symbol | None
    known: Expr
    rate: Expr
    cosine: Expr
    sine: Expr
    hinge: Matrix
    drift: Drift | None
    bulk: Bulk = NO_BULK


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

    motors : the known moment about the axis of a link that its parent takes on
    drives : the same where it is sought, with its sign
    composed : what turns by several angles at once: what its unknown is made of
    """

    links: tuple[Link, ...]
    carried: tuple[tuple[Expr, Drift], ...]
    gravity: Matrix
    pushes: tuple[Push, ...]
    motors: Mapping[int, Expr] = field(default_factory=dict)
    drives: Mapping[int, tuple[Symbol, Expr]] = field(default_factory=dict)
    composed: Mapping[Symbol, tuple[Expr, Mapping[Symbol, Expr]]] = field(default_factory=dict)

    @property
    def free(self) -> frozenset[Symbol]:
        """Return the accelerations that a motion of the machine is made of."""
        drifts = (*(d for _, d in self.carried), *(k.drift for k in self.links if k.drift))
        angles = (k.unknown for k in self.links if k.unknown is not None)
        return frozenset((*angles, *(u for d in drifts for u in d.slopes)))

    @property
    def motion(self) -> frozenset[Symbol]:
        """Return the accelerations that it is made of in the end, however links turn by them."""
        of = (u for _, slopes in self.composed.values() for u in slopes)
        return self.free - self.composed.keys() | frozenset(of)

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
            along = hinge[link.axis] * unit_vector("xyz"[link.axis])
        moved.append(along)
        found.append(replace(link, hinge=hinge - along, bulk=link.bulk.moved(along)))
    pushes = (p if p.link == BASE else replace(p, arm=p.arm + moved[p.link])
              for p in machine.pushes)  # fmt: skip
    return replace(machine, links=tuple(found), pushes=tuple(pushes))


class OtherMachineError(Exception):
    """A machine that has more than links which turn freely."""


def links(frames: Frames, sought: frozenset[Symbol]) -> Links | None:
    """Return the links of a machine, None if it has more than links which turn freely.

    sought : the unknowns of the motion; all others do no work, which who uses this has to prove
    """
    try:
        return near_hinges(_Survey(frames, sought).read())
    except OtherMachineError:
        return None


class _Survey:
    """Reads frames, bodies and loads, and gives up at what is no link."""

    def __init__(self, frames: Frames, sought: frozenset[Symbol]) -> None:
        self.frames, self.sought = frames, sought
        words = frames.words
        self.fixed = words.vocabulary.fixed() | words.hidden.keys()
        self.reactions = dict.fromkeys(frames.sheet.unknowns - sought, Integer(0))
        self.links: list[Link] = []
        self.motors: dict[int, Expr] = {}
        self.drives: dict[int, tuple[Symbol, Expr]] = {}
        self.composed: dict[Symbol, tuple[Expr, Mapping[Symbol, Expr]]] = {}
        self.of: dict[str, int] = {INERTIAL: BASE}
        self.at: dict[str, Matrix] = {INERTIAL: ZERO}  # the origin of a frame, in its link's axes

    def read(self) -> Links:
        machine = self.frames.machine
        for name, frame in self.frames.each.items():
            if name != INERTIAL:
                self._frame(frame)
        carried = [own for b in machine.bodies for own in self._body(b.name)]
        gravity, weights = self._gravity()
        joints = [load for load in machine.loads if isinstance(load, Force)]
        driven = [load for load in joints if self._motor(load)]
        other = weights | {load.name for load in driven}
        acting = [w for w in wrenches(self.frames) if w.load not in other]
        pushes = tuple(p for w in acting for p in self._push(w))
        return Links(tuple(self.links), tuple(carried), gravity, pushes, self.motors, self.drives,
                     self.composed)  # fmt: skip

    def _frame(self, frame: Frame) -> None:
        moves = (frame.angular_velocity, frame.velocity, frame.acceleration, frame.rolls)
        if frame.attitude or any(m is not None for m in moves):
            raise OtherMachineError
        link, origin = self.of[frame.parent], self.frames.words.column(frame.origin)
        place = self.at[frame.parent] + origin
        if link != BASE and not self._constant(place):
            raise OtherMachineError
        for turn in frame.turned:
            self._turned(turn, link, place)
            link, place = len(self.links) - 1, ZERO
        self.of[frame.name], self.at[frame.name] = link, place

    def _turned(self, turn: Turning, parent: int, place: Matrix) -> None:
        sheet, (R, rate) = self.frames.sheet, self.frames.one_turn(turn)
        rest, slopes = sheet.split(sheet.rate(rate))
        axis, unknown = PLACE[turn.axis], next(iter(slopes), None)
        if slopes and (rest != 0 or list(slopes.values()) != [1]):
            unknown = Symbol(f"turning {len(self.links)}", real=True)
            self.composed[unknown] = (rest, slopes)
            if not self._constant(Matrix([*slopes.values()])):
                raise OtherMachineError
            rest = Integer(0)
        i, j = (axis + 1) % 3, (axis + 2) % 3
        drift = self._drift(place) if parent == BASE else None
        self.links.append(Link(parent, axis, unknown, rest, rate, R[i, i], R[j, i], place, drift))

    def _body(self, body: str) -> list[tuple[Expr, Drift]]:
        """Add a body to its link, or return it if it does not turn."""
        member = self.frames.machine.body(body)
        spins = (member.spin, member.axial_speed, member.angular_velocity)
        if member.turned or any(s is not None for s in spins):
            raise OtherMachineError
        m, I = mass(self.frames, body), inertia_tensor(self.frames, body)  # noqa: E741
        frame, at = centre(self.frames, body)
        link, place = self.of[frame], self.at[frame] + at
        if link == BASE:
            return [(m, self._drift(place))]
        if not self._constant(place):
            raise OtherMachineError
        spread = (I.trace() * Rational(1, 2) * eye(3) - I).applyfunc(lambda e: e.expand())
        own, at_place = self.links[link], at_point(m, place)
        bulk = own.bulk + at_place + Bulk(Integer(0), ZERO, spread)
        self.links[link] = replace(own, bulk=bulk)
        return []

    def _gravity(self) -> tuple[Matrix, frozenset[str]]:
        """Return the gravity that acts on all bodies, and the loads that it is."""
        machine = self.frames.machine
        loads = [load for load in machine.loads if isinstance(load, Weight)]
        if len(loads) != 1 or {*loads[0].on} != {b.name for b in machine.bodies}:
            return ZERO, frozenset()
        (load,) = loads
        g = self.frames.words.column(load.gravity)
        if self.of[load.along] != BASE or not self._constant(g):
            return ZERO, frozenset()
        return g, frozenset({load.name})

    def _known(self, vector: Matrix) -> Matrix:
        """Return what of a load is known."""
        found = vector.xreplace(self.reactions)
        if found.free_symbols & self.sought:
            raise OtherMachineError
        return found

    def _motor(self, load: Force) -> bool:
        """Note a couple between a link and its parent, and tell whether a load is that alone."""
        column = self.frames.words.column
        force, couple = (column(v).xreplace(self.reactions) for v in (load.force, load.couple))
        ends = [self.of[self.frames.own(load.on)]]
        ends += [self.of[self.frames.own(load.against)]] if load.against else [BASE]
        if force != ZERO or self.of[load.along] not in ends:
            return False
        for (link, other), sign in ((ends, 1), (ends[::-1], -1)):
            if link != BASE and self.links[link].parent == other:
                rest, slopes = self.frames.sheet.split(sign * couple[self.links[link].axis])
                self.motors[link] = self.motors.get(link, Integer(0)) + rest
                for u, slope in slopes.items():
                    if slope not in (1, -1) or link in self.drives:
                        raise OtherMachineError
                    self.drives[link] = u, slope
                return True
        return False

    def _push(self, w: Wrench) -> list[Push]:
        """Return what of a load is known, in nothing if it is only what holds a joint."""
        force, couple = self._known(w.force), self._known(w.couple)
        link, along = self.of[self.frames.own(w.body)], self.of[w.along]
        if force == ZERO:
            still = couple == ZERO or link == BASE
            return [] if still else [Push(link, ZERO, None, along, force, couple)]
        if self.of[w.point[0]] != link:
            raise OtherMachineError
        place = self.at[w.point[0]] + w.point[1]
        drift = self._drift(place) if link == BASE else None
        return [Push(link, ZERO if drift else place, drift, along, force, couple)]

    def _drift(self, place: Matrix) -> Drift:
        sheet = self.frames.sheet
        second = sheet.rate_of_column(sheet.rate_of_column(place))
        each = [sheet.split(e) for e in second]
        found = {u for _, slopes in each for u in slopes}
        by = {u: Matrix([s.get(u, Integer(0)) for _, s in each]) for u in sorted(found, key=str)}
        if not found <= self.sought or not all(self._constant(d) for d in by.values()):
            raise OtherMachineError
        return Drift(Matrix([rest for rest, _ in each]), by)

    def _constant(self, values: Matrix) -> bool:
        return bool(values.free_symbols <= self.fixed)
