"""What of a machine is links, wheels on them, and what acts on both, read from frames and loads."""

from dataclasses import replace

from sympy import Expr, Integer, Matrix, Rational, Symbol, eye

from derive.lecture.turning import PLACE, unit_vector
from derive.mechanics.bodies import centre, inertia_tensor, mass
from derive.mechanics.bulk import Bulk, at_point
from derive.mechanics.frames import ZERO, Frames, Located
from derive.mechanics.links import BASE, Drift, Link, Links, Push, Rotor, near_hinges
from derive.mechanics.loads import Wrench, wrenches
from derive.scene.declaration import Turning
from derive.scene.machine import INERTIAL, Force, Frame, Weight


class OtherMachineError(Exception):
    """A machine that has more than links and wheels that move freely."""


def links(frames: Frames, sought: frozenset[Symbol]) -> Links | None:
    """Return the links of a machine, None if it has more than links and wheels.

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
        self.wheels: dict[str, Rotor] = {}
        self.motors: dict[int, Expr] = {}
        self.drives: dict[int, tuple[Symbol, Expr]] = {}
        self.acting: dict[Symbol, Expr] = {}
        self.of: dict[str, int] = {INERTIAL: BASE}
        self.at: dict[str, Matrix] = {INERTIAL: ZERO}  # the origin of a frame, in its link's axes

    def read(self) -> Links:
        machine = self.frames.machine
        for name, frame in self.frames.each.items():
            if name != INERTIAL:
                self._frame(frame)
        carried = [own for b in machine.bodies for own in self._body(b.name)]
        gravity, level, weights = self._gravity()
        joints = [load for load in machine.loads if isinstance(load, Force)]
        driven = [load for load in joints if self._motor(load)]
        other = weights | {load.name for load in driven}
        acting = [w for w in wrenches(self.frames) if w.load not in other]
        pushes = tuple(p for w in acting for p in self._push(w))
        return Links(
            tuple(self.links), tuple(carried), gravity, pushes, self.motors, self.drives,
            tuple(self.wheels.values()), self.acting, level,
        )  # fmt: skip

    def _frame(self, frame: Frame) -> None:
        """Add the links that a frame is, and note where its origin is on the last of them."""
        words, link = self.frames.words, self.of[frame.parent]
        moves = any(m is not None for m in (frame.velocity, frame.acceleration, frame.rolls))
        place = ZERO if moves else self.at[frame.parent] + words.column(frame.origin)
        for turn in frame.turned:
            link, place = self._turned(turn, link, place), ZERO
        if frame.angular_velocity is not None:
            spin = words.column(frame.angular_velocity)
            link, place = self._turning(frame, spin, link, place), ZERO
        if link != BASE and not self._constant(place):
            link, place = self._link(link, place), ZERO
        if moves:
            if not self._at_rest(link):
                raise OtherMachineError
            drift = self._split(self.frames.acceleration[frame.name][frame.name])
            link = self._link(link, place)
            self.links[link] = replace(self.links[link], drift=drift)
        self.of[frame.name], self.at[frame.name] = link, place

    def _at_rest(self, link: int) -> bool:
        """Tell whether the hinges of a link and of all that carries it are one place at rest."""
        if link == BASE:
            return True
        own = self.links[link]
        still = own.hinge == ZERO if own.drift is None else own.drift == Drift(ZERO, {})
        return still and self._at_rest(own.parent)

    def _link(self, parent: int, place: Matrix) -> int:
        """Add a link that does not turn in its parent, and return its own place."""
        slides = parent == BASE or not self._constant(place)
        drift = self._drift(place) if slides else None
        going = self.frames.sheet.rate_of_column(place) if slides else ZERO
        still = Drift(ZERO, {})
        one, none = Integer(1), Integer(0)
        link = Link(parent, 0, ZERO, still, one, none, place, drift, going)
        self.links.append(link)
        return len(self.links) - 1

    def _turned(self, turn: Turning, parent: int, place: Matrix) -> int:
        """Add a link that turns about an axis."""
        R, rate = self.frames.one_turn(turn)
        e, axis = unit_vector(turn.axis), PLACE[turn.axis]
        i, j = (axis + 1) % 3, (axis + 2) % 3
        link, turning = self._link(parent, place), self._split(self.frames.sheet.rate(rate) * e)
        self.links[link] = replace(self.links[link], axis=axis, spin=rate * e, turning=turning,
                                   cosine=R[i, i], sine=R[j, i])  # fmt: skip
        return link

    def _turning(self, frame: Frame, spin: Matrix, parent: int, place: Matrix) -> int:
        """Add a link whose angular velocity is given."""
        R = self.frames.rotations[frame.name] if frame.attitude else None
        if R is not None and parent != BASE:
            raise OtherMachineError
        link, turning = self._link(parent, place), self._split(self._rates(spin))
        axis = next((n for n in range(3) if spin[n] != 0), 0)
        self.links[link] = replace(self.links[link], axis=axis, spin=spin, turning=turning,
                                   attitude=R)  # fmt: skip
        return link

    def _body(self, body: str) -> list[tuple[Expr, Drift]]:
        """Add a body to its link, or return it if it does not turn."""
        m, I = mass(self.frames, body), inertia_tensor(self.frames, body)  # noqa: E741
        frame, at = centre(self.frames, body)
        link, place = self.of[frame], self.at[frame] + at
        self._wheel(body, link, I)
        if link == BASE:
            return [(m, self._drift(place))]
        if not self._constant(place):
            raise OtherMachineError
        spread = (I.trace() * Rational(1, 2) * eye(3) - I).applyfunc(lambda e: e.expand())
        own, at_place = self.links[link], at_point(m, place)
        bulk = own.bulk + at_place + Bulk(Integer(0), ZERO, spread)
        self.links[link] = replace(own, bulk=bulk)
        return []

    def _wheel(self, body: str, link: int, tensor: Matrix) -> None:
        """Note how a body spins on its link, if it does."""
        frames = self.frames
        spin = frames.turning_of_body(body) - frames.Omega[frames.own(body)]
        if spin == ZERO:
            return
        about = [n for n in range(3) if spin[n] != 0]
        others = [n for n in range(3) if n not in about or len(about) > 1]
        if not tensor.is_diagonal() or len({tensor[n, n] for n in others}) > 1:
            raise OtherMachineError
        spinning = self._split(self._rates(spin))
        self.wheels[body] = Rotor(link, tensor[about[0], about[0]], spin, spinning)

    def _gravity(self) -> tuple[Matrix, int, frozenset[str]]:
        """Return the gravity that acts on all bodies, along what, and the loads that it is."""
        machine = self.frames.machine
        loads = [load for load in machine.loads if isinstance(load, Weight)]
        if len(loads) != 1 or {*loads[0].on} != {b.name for b in machine.bodies}:
            return ZERO, BASE, frozenset()
        (load,) = loads
        g = self.frames.words.column(load.gravity)
        if not self._constant(g):
            return ZERO, BASE, frozenset()
        return g, self.of[load.along], frozenset({load.name})

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
        if force != ZERO or self.of[load.along] not in ends or {load.on, load.against} & {
                *self.wheels}:  # fmt: skip
            return False
        for (link, other), sign in ((ends, 1), (ends[::-1], -1)):
            if link != BASE and self.links[link].parent == other and self.links[link].about_axis:
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
        own, along = self.frames.own(w.body), self.of[w.along]
        link = self.of[own]
        if w.body in self.wheels:
            self._drive(w, force, couple)
        if force == ZERO:
            still = couple == ZERO or link == BASE
            return [] if still else [Push(link, ZERO, None, along, force, couple)]
        if link == BASE:
            return [Push(link, ZERO, self._drift(self.at[own]), along, force, couple)]
        if self.of[w.point[0]] == link:
            place = self.at[w.point[0]] + w.point[1]
        else:
            place = self.at[own] + self._apart((own, ZERO), w.point, own)
        return [Push(link, place, None, along, force, couple)]

    def _drive(self, w: Wrench, force: Matrix, couple: Matrix) -> None:
        """Note what acts on a wheel by its spin."""
        frames, own = self.frames, self.frames.own(w.body)
        moment = self._along(couple, w.along, own)
        if force != ZERO:
            arm = self._apart(centre(frames, w.body), w.point, own)
            moment += arm.cross(self._along(force, w.along, own))
        for u, d in self.wheels[w.body].spinning.slopes.items():
            self.acting[u] = self.acting.get(u, Integer(0)) + d.dot(moment)

    def _apart(self, start: Located, end: Located, along: str) -> Matrix:
        """Return the vector from one point to another."""
        names = start[0], end[0]
        if not self.frames.placed(*names) or not self.frames.linked(*names):
            raise OtherMachineError
        return self.frames.apart(start, end, along)

    def _along(self, vector: Matrix, start: str, end: str) -> Matrix:
        """Return a vector along the axes of another frame."""
        if not self.frames.linked(start, end):
            raise OtherMachineError
        return self.frames.carried(vector, start, end)

    def _rates(self, values: Matrix) -> Matrix:
        return self.frames.sheet.rate_of_column(values)

    def _drift(self, place: Matrix) -> Drift:
        return self._split(self._rates(self._rates(place)))

    def _split(self, second: Matrix) -> Drift:
        """Return an acceleration as what is known of it and what each unknown adds."""
        each = [self.frames.sheet.split(e) for e in second]
        found = {u for _, slopes in each for u in slopes}
        if not found <= self.sought:
            raise OtherMachineError
        by = {u: Matrix([s.get(u, Integer(0)) for _, s in each]) for u in sorted(found, key=str)}
        return Drift(Matrix([rest for rest, _ in each]), by)

    def _constant(self, values: Matrix) -> bool:
        return bool(values.free_symbols <= self.fixed)
