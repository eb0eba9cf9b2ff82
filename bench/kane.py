"""A scene as SymPy's KanesMethod takes it: frame by frame, body by body, load by load.

Reactions are left out, as if they did no work. What moves in a known way is one more coordinate,
whose rate is known. Symbols are those of the scene's working sheet.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from sympy import Expr, Function, Integer, Matrix, Symbol, eye, zeros
from sympy.physics.mechanics import (
    KanesMethod,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)

from derive.lecture.turning import unit_vector
from derive.mechanics.bodies import centre, inertia_tensor, mass
from derive.mechanics.frames import ZERO, Frames
from derive.mechanics.loads import Wrench, wrenches
from derive.mechanics.mechanism import Mechanism
from derive.scene.constraint import Constraint
from derive.scene.declaration import Triple
from derive.scene.machine import INERTIAL, Frame

T = dynamicsymbols._t  # noqa: SLF001 - SymPy has no other name for it


class NoPeerError(Exception):
    """A scene that is not told to KanesMethod, and why."""


@dataclass(frozen=True)
class KaneEquations:
    """A mass matrix, a right side, and the unknowns that they are of.

    slopes : of the second rates of conditions by the unknowns    rests : what is left of those
    """

    mass: Matrix
    right: Matrix
    unknowns: tuple[Symbol, ...]
    slopes: Matrix
    rests: Matrix

    @property
    def whole(self) -> tuple[Matrix, Matrix]:
        """Return the matrix and the right side of unknowns and multipliers together."""
        held = self.slopes.rows
        upper = Matrix.hstack(self.mass, self.slopes.T)
        lower = Matrix.hstack(self.slopes, zeros(held, held))
        return Matrix.vstack(upper, lower), Matrix([*self.right, *(-self.rests)])

    def following(self, columns: Sequence[int]) -> tuple[Matrix, Matrix]:
        """Return the same with some unknowns dependent, as KanesMethod takes multipliers out."""
        others = [k for k in range(len(self.unknowns)) if k not in columns]
        by = -self.slopes[:, columns].LUsolve(self.slopes[:, others])
        mass, right = (m[others, :] + by.T * m[columns, :] for m in (self.mass, self.right))
        return Matrix([mass, self.slopes]), Matrix([*right, *(-self.rests)])


def equations(own: Mechanism) -> KaneEquations:
    """Return the equations of a scene by Kane's method.

    Conditions that the others hold anyway are left out, as the scene's own equations do.
    Raises NoPeerError for a scene in which nothing is free.
    """
    words = own.answers.frames.words
    given = {words.vocabulary.symbols[c] for q in words.vocabulary.given() for c in q.components}
    rates = {s: e for s, e in words.sheet.rates.items() if s in given}
    free = {s: e for s, e in rates.items() if e in words.sheet.unknowns}
    if not free:
        raise NoPeerError("nothing is free")
    kept = [own.held.every.index(tie) for tie in own.held.kept]
    return _Model(own.answers.frames, rates, free).solved(kept)


@dataclass
class _Model:
    """The frames, points and bodies of a scene in SymPy's words.

    free   : the speeds whose rates are unknown      driven : given accelerations of origins
    """

    frames: Frames
    rates: Mapping[Symbol, Expr]
    free: Mapping[Symbol, Expr]
    axes: dict[str, Any] = field(default_factory=dict)
    origins: dict[str, Any] = field(default_factory=dict)
    driven: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Start at the base."""
        self.moving = {s: Function(s.name, real=True)(T) for s in self.rates}
        self.hidden = dict.fromkeys(self.frames.words.hidden, Integer(1))
        self.N, base = ReferenceFrame("N"), Point("O")
        base.set_vel(self.N, 0)
        self.axes[INERTIAL], self.origins[INERTIAL], self.driven[INERTIAL] = self.N, base, 0

    def solved(self, kept: Sequence[int]) -> KaneEquations:
        """Return the equations of all bodies, and of the conditions that are kept."""
        for name, frame in self.frames.each.items():
            if name != INERTIAL:
                self.axes[name] = self._turned(frame)
                self._placed(frame)
        bodies = {b.name: self._body(b.name) for b in self.frames.machine.bodies}
        reactions = sorted(self.frames.sheet.unknowns - {*self.free.values()}, key=str)
        acting = [w.without(reactions) for w in wrenches(self.frames)]
        loads = [own for w in acting for own in self._load(w, bodies[w.body])]
        u = [self.moving[s] for s in self.free]
        known = {self.moving[s]: self._dynamic(self.rates[s])
                 for s in self.rates if s not in self.free}  # fmt: skip
        known = known or {Function("none")(T): u[0]}  # KanesMethod must have a coordinate
        rates = [q.diff(T) - rate for q, rate in known.items()]
        kane = KanesMethod(self.N, [*known], u, kd_eqs=rates)
        kane.kanes_equations([*bodies.values()], loads)
        back = {own: s for s, own in self.moving.items()}
        seconds = [c for one in self.frames.machine.constraints for c in self._seconds(one)]
        held = [seconds[k] for k in kept]
        slopes = Matrix(len(held), len(u), lambda k, n: held[k].coeff(u[n].diff(T)))
        still = dict.fromkeys((x.diff(T) for x in u), Integer(0))
        parts = kane.mass_matrix, kane.forcing, slopes, Matrix([e.xreplace(still) for e in held])
        mass, right, slopes, rests = (part.xreplace(back) for part in parts)
        return KaneEquations(mass, right, tuple(self.free.values()), slopes, rests)

    def _seconds(self, one: Constraint) -> Iterator[Expr]:
        """Yield the second rates of what a constraint asks for, or rates of what is of rates."""
        if one.meeting is None:
            each = [self._dynamic(self.frames.words.expression(one.zero))]
        else:
            axes, meeting = self.axes[one.meeting.along], one.meeting
            apart = self._particle(meeting.on, meeting.frame, meeting.at, of_rates=one.of_rates)
            if meeting.against or not one.of_rates:
                apart -= self._particle(meeting.against, meeting.to_frame, meeting.to,
                                        of_rates=one.of_rates)  # fmt: skip
            each = [apart.dot(getattr(axes, axis)) for axis in meeting.axes]
        for value in each:
            yield self._rate(value if one.of_rates else self._rate(value)).expand()

    def _rate(self, value: Expr) -> Expr:
        known = {self.moving[s].diff(T): self._dynamic(self.rates[s])
                 for s in self.rates if s not in self.free}  # fmt: skip
        return value.diff(T).xreplace(known)

    def _particle(self, body: str, frame: str, at: Triple, *, of_rates: bool) -> Any:
        """Return where a point is, or how fast the particle of a body is that is there."""
        P = self.origins[frame].locatenew("P", self._vector(frame, self.frames.words.column(at)))
        if not of_rates:
            return P.pos_from(self.origins[INERTIAL])
        name, place = centre(self.frames, body)
        G = self.origins[name].locatenew("G", self._vector(name, place))
        turning = self._spun(body).ang_vel_in(self.N)
        return self._velocity(name, place) + turning.cross(P.pos_from(G))

    def _dynamic(self, e: Expr) -> Expr:
        """Return an expression of the working sheet in what varies with time."""
        sheet = self.frames.sheet
        while e.free_symbols & sheet.definitions.keys():
            e = e.xreplace(sheet.definitions)
        return e.xreplace(self.hidden).xreplace(self.moving)

    def _vector(self, name: str, column: Matrix) -> Any:
        own = self.axes[name]
        x, y, z = map(self._dynamic, column)
        return x * own.x + y * own.y + z * own.z

    def _turned(self, frame: Frame) -> Any:
        """Return the axes of a frame, whose parent has some."""
        words, name, own = self.frames.words, frame.name, self.axes[frame.parent]
        for k, turn in enumerate(frame.turned):
            before, angle = own, words.expression(turn.angle)
            e = getattr(before, turn.axis)
            own = before.orientnew(f"{name}_{k}", "Axis", (self._dynamic(angle), e))
            own.set_ang_vel(before, self._dynamic(self.frames.sheet.rate(angle)) * e)
        if frame.angular_velocity is None:
            return own
        self.axes[name], R = ReferenceFrame(name), self.frames.rotations[name]
        known = eye(3) if R is None else R.applyfunc(self._dynamic)
        self.axes[name].orient_explicit(own, known)
        turning = self._vector(name, words.column(frame.angular_velocity))
        self.axes[name].set_ang_vel(own, turning)
        return self.axes[name]

    def _placed(self, frame: Frame) -> None:
        """Add the origin of a frame with its velocity."""
        name, words, P = frame.name, self.frames.words, Point(frame.name)
        self.driven[name] = 0
        if frame.velocity is not None:
            v = self._vector(name, words.column(frame.velocity))
        elif frame.acceleration is not None:
            v = 0 * self.N.x
            self.driven[name] = self._vector(name, words.column(frame.acceleration))
        elif frame.rolls is not None:
            at = self._vector(name, words.column(frame.rolls.at))
            v = -self._spun(frame.rolls.body).ang_vel_in(self.N).cross(at)
        else:
            at = words.column(frame.origin)
            P = self.origins[frame.parent].locatenew(name, self._vector(frame.parent, at))
            v, self.driven[name] = self._velocity(frame.parent, at), self.driven[frame.parent]
        P.set_vel(self.N, v)
        self.origins[name] = P

    def _velocity(self, name: str, at: Matrix) -> Any:
        """Return the velocity of a place in a frame."""
        seen = self._vector(name, self.frames.sheet.rate_of_column(at))
        turned = self.axes[name].ang_vel_in(self.N).cross(self._vector(name, at))
        return self.origins[name].vel(self.N) + seen + turned

    def _spun(self, body: str) -> Any:
        """Return the axes that a body turns with; how it has turned in its own does not matter."""
        member, words = self.frames.machine.body(body), self.frames.words
        name = self.frames.own(body)
        own = self.axes[name]
        if member.angular_velocity is not None:
            turning = self._vector(name, words.column(member.angular_velocity))
        elif member.axis is not None and member.spin is not None:
            e = self._vector(name, unit_vector(member.axis))
            turning = self._dynamic(words.expression(member.spin)) * e
        elif member.axis is not None and member.axial_speed is not None:
            e = self._vector(name, unit_vector(member.axis))
            whole = self._dynamic(words.expression(member.axial_speed))
            turning = (whole - e.dot(own.ang_vel_in(self.N))) * e
        else:
            return own
        spun = own.orientnew(f"{body}_spun", "Axis", (0, own.x))
        spun.set_ang_vel(own, turning)
        return spun

    def _body(self, body: str) -> Any:
        name, at = centre(self.frames, body)
        G = self.origins[name].locatenew(f"{body}_G", self._vector(name, at))
        v = self._velocity(name, at)
        G.set_vel(self.N, v)
        if self.driven[name] != 0:
            G.set_acc(self.N, v.dt(self.N) + self.driven[name])
        t = inertia_tensor(self.frames, body).applyfunc(self._dynamic)
        axes = self.axes[self.frames.own(body)]
        own = inertia(axes, t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[1, 2], t[0, 2])
        m = self._dynamic(mass(self.frames, body))
        return RigidBody(body, G, self._spun(body), m, (own, G))

    def _load(self, w: Wrench, body: Any) -> Iterator[tuple[Any, Any]]:
        if w.couple != ZERO:
            yield body.frame, self._vector(w.along, w.couple)
        if w.force != ZERO:
            P = self.origins[w.point[0]].locatenew("P", self._vector(*w.point))
            P.v2pt_theory(body.masscenter, self.N, body.frame)
            yield P, self._vector(w.along, w.force)
