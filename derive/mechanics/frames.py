"""How the frames of a machine turn and move, by the lecture's laws, along each frame's own axes."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from sympy import Expr, Matrix, expand_trig, eye, zeros

from derive.lecture.stated import by_law
from derive.lecture.turning import ADDED, angular_velocities_summed, turn_matrix, unit_vector
from derive.mechanics.own_axes import frames_of_bodies, own_axes
from derive.mechanics.sheet import AXES, Sheet
from derive.mechanics.words import Words
from derive.scene import Scene, SceneError
from derive.scene.declaration import Turning
from derive.scene.machine import INERTIAL, Frame

ZERO = zeros(3, 1)
Located = tuple[str, Matrix]
ByFrame = Mapping[str, Matrix]  # a vector as a sum of columns, each along the axes of a frame


@dataclass
class Frames:
    """The frames of a machine in motion; every vector is a (3, 1) column along its frame's axes."""

    machine: Scene
    words: Words

    @property
    def sheet(self) -> Sheet:
        """Return the working sheet."""
        return self.words.sheet

    @cached_property
    def each(self) -> Mapping[str, Frame]:
        """Return all frames by name, those of turned bodies included, parents first."""
        return {f.name: f for f in (*self.machine.frames, *frames_of_bodies(self.machine))}

    @cached_property
    def rotations(self) -> Mapping[str, Matrix | None]:
        """Return R that takes components along a frame to its parent's; None if not known."""
        return {name: self._rotation(frame) for name, frame in self.each.items()}

    def _rotation(self, frame: Frame) -> Matrix | None:
        if frame.attitude:
            parts = self.words.vocabulary.column(frame.attitude)
            known = {"q_w": parts[0], "q_v": Matrix(parts[1:])}
            images = [by_law("rotation_of_vector", known | {"v": eye(3)[:, k]}) for k in range(3)]
            return Matrix.hstack(*images)
        if frame.angular_velocity is not None:
            return None
        R = eye(3)
        for turn in frame.turned:
            R = R * self.one_turn(turn)[0]
        return R

    @cached_property
    def Omega(self) -> Mapping[str, Matrix]:
        """Return the angular velocity of every frame in the inertial one."""
        found: dict[str, Matrix] = {INERTIAL: ZERO}
        for name, frame in self.each.items():
            if name != INERTIAL:
                total, step = self._turning(frame, found)
                found[name] = self.sheet.column(f"{name}.Omega", total, step)
        return found

    def _turning(self, frame: Frame, found: Mapping[str, Matrix]) -> tuple[Matrix, str]:
        """Return the angular velocity of a frame, and the lecture step that adds it up, if any."""
        total = found[frame.parent]
        adds = ""
        if frame.angular_velocity is not None:
            own = self.words.column(frame.angular_velocity)
            R = self.rotations[frame.name]
            if total != ZERO and R is None:
                raise SceneError(
                    f"frame '{frame.name}' has no attitude in '{frame.parent}', which turns; "
                    "give turned or attitude"
                )
            adds = "" if total == ZERO else ADDED
            return angular_velocities_summed(R if R is not None else eye(3), total, own), adds
        for turn in frame.turned:
            R, rate = self.one_turn(turn)
            own = by_law("rate_of_simple_turn", {"angle_dot": rate, "e": unit_vector(turn.axis)})
            adds = adds if total == ZERO else ADDED
            total = angular_velocities_summed(R, total, own)
        return total, adds

    def one_turn(self, turn: Turning) -> tuple[Matrix, Expr]:
        angle = self.words.expression(turn.angle)
        R = turn_matrix(turn.axis, angle).applyfunc(expand_trig)
        return R, self.sheet.rate(angle)

    @cached_property
    def Omega_dot(self) -> Mapping[str, Matrix]:
        """Return the rate of each frame's angular velocity, seen from the frame."""
        return {
            name: self.sheet.column(f"{name}.Omega_dot", self.sheet.rate_of_column(Omega))
            for name, Omega in self.Omega.items()
        }

    def velocity(self, name: str) -> Matrix:
        """Return the velocity of a frame's origin in the inertial frame."""
        frame = self.each[name]
        if name == INERTIAL:
            return ZERO
        if frame.velocity is not None:
            return self.words.column(frame.velocity)
        if frame.acceleration is not None:
            raise SceneError(f"frame '{name}' has an acceleration, but its velocity is not given")
        if frame.rolls is not None:
            return self.sheet.column(f"{name}.v", self._rolling(frame), "velocity_of_particle")
        along, here = self.origin_velocity(name)
        return self.sheet.column(f"{name}.v", self.carried(here, along, name))

    def origin_velocity(self, name: str) -> tuple[str, Matrix]:
        """Return the velocity of a frame's origin along the axes of the frame that places it."""
        frame = self.each[name]
        if name == INERTIAL or not _has_place(frame):
            return name, self.velocity(name)
        offset = self.words.column(frame.origin)
        seen = self._velocity_seen(frame.parent, offset)
        return frame.parent, self.velocity(frame.parent) + seen

    def _velocity_seen(self, name: str, offset: Matrix) -> Matrix:
        known = {"rho_i": offset, "rho_i_dot": self.sheet.rate_of_column(offset)}
        return by_law("velocity_seen_from_axes", known | {"Omega": self.Omega[name]})

    def _rolling(self, frame: Frame) -> Matrix:
        """Return the velocity of the origin that leaves the particle in contact at rest."""
        rolls = frame.rolls
        assert rolls is not None  # noqa: S101
        turns = self.carried(self.turning_of_body(rolls.body), self.own(rolls.body), frame.name)
        known = {"rho_i": self.words.column(rolls.at), "omega": turns}
        return -by_law("velocity_of_particle", known)

    @cached_property
    def acceleration(self) -> Mapping[str, ByFrame]:
        """Return the acceleration of every frame's origin, each part along its own axes."""
        found: dict[str, ByFrame] = {INERTIAL: {}}
        for name, frame in self.each.items():
            if name != INERTIAL:
                found[name] = self._accelerated(frame, found)
        return found

    def _accelerated(self, frame: Frame, found: Mapping[str, ByFrame]) -> ByFrame:
        name = frame.name
        if frame.acceleration is not None:
            return {name: self.words.column(frame.acceleration)}
        if frame.velocity is not None or frame.rolls is not None:
            v = self.velocity(name)
            known = {"any": v, "any_dot": self.sheet.rate_of_column(v), "Omega": self.Omega[name]}
            return {name: self.sheet.column(f"{name}.a", transported(known), "transport_theorem")}
        offset = self.words.column(frame.origin)
        return self.accelerated(frame.parent, offset, found[frame.parent])

    def accelerated(self, name: str, offset: Matrix, origin: ByFrame) -> ByFrame:
        """Return the acceleration of a point placed in a frame, by that of the frame's origin."""
        seen = self.acceleration_seen(name, offset)
        own = self.sheet.column(f"{name}.a_seen", seen, "acceleration_seen_from_axes")
        if own == ZERO:
            return origin
        return dict(origin) | {name: origin.get(name, ZERO) + own}

    def acceleration_seen(self, name: str, offset: Matrix) -> Matrix:
        """Return the acceleration, relative to a frame's origin, of a point placed in it."""
        first = self.sheet.rate_of_column(offset)
        known = {
            "rho_i": offset,
            "rho_i_dot": first,
            "rho_i_ddot": self.sheet.rate_of_column(first),
            "Omega": self.Omega[name],
            "Omega_dot": self.Omega_dot[name],
        }
        return by_law("acceleration_seen_from_axes", known)

    def fixed_in_parent(self, name: str) -> bool:
        """Tell whether a frame keeps its place and its axes in its parent."""
        frame = self.each[name]
        if name == INERTIAL or frame.parent == INERTIAL:
            return False
        moves = (frame.angular_velocity, frame.velocity, frame.acceleration, frame.rolls)
        given = (*(t.angle for t in frame.turned), *frame.origin)
        still = all(self.sheet.rate(self.words.expression(f)) == 0 for f in given)
        return all(m is None for m in moves) and still

    def own(self, body: str) -> str:
        """Return the frame of a body's own axes."""
        member = self.machine.body(body)
        return own_axes(body) if member.turned else member.frame

    def turning_of_body(self, body: str) -> Matrix:
        """Return the angular velocity of a body, along its own axes."""
        member = self.machine.body(body)
        Omega = self.Omega[self.own(body)]
        if member.angular_velocity is not None:
            return Omega + self.words.column(member.angular_velocity)
        if member.axis is None:
            return Omega
        e = unit_vector(member.axis)
        if member.spin is not None:
            s = self.words.expression(member.spin)
            return by_law("spins_in_axes", {"Omega": Omega, "s": s, "e": e})
        if member.axial_speed is not None:
            s = self.words.expression(member.axial_speed) - (e.T * Omega)[0]
            return by_law("spins_in_axes", {"Omega": Omega, "s": s, "e": e})
        return Omega

    def direction(self, axis: str) -> Matrix:
        """Return the unit vector of an axis: x, y, z, or that which a body spins about."""
        if axis in AXES:
            return unit_vector(axis)
        line = self.machine.body(axis).spin_axis
        assert line is not None  # noqa: S101
        return self.words.column(line)

    def chain(self, name: str) -> list[str]:
        """Return a frame, its parent, and so on to the inertial frame."""
        found = [name]
        while found[-1] != INERTIAL:
            found.append(self.each[found[-1]].parent)
        return found

    def common(self, first: str, second: str) -> str:
        """Return the last frame that carries both."""
        above = self.chain(second)
        return next(name for name in self.chain(first) if name in above)

    def carried(self, vector: Matrix, start: str, end: str) -> Matrix:
        """Return the components of a vector along another frame's axes."""
        if start == end or vector == ZERO:
            return vector
        top = self.common(start, end)
        for name in self.chain(start)[: self.chain(start).index(top)]:
            vector = self._rotation_given(name, start, end) * vector
        for name in reversed(self.chain(end)[: self.chain(end).index(top)]):
            vector = self._rotation_given(name, start, end).T * vector
            if len(self.chain(end)) > 1:
                vector = self.sheet.column(f"along.{name}", vector)
        return vector

    def _rotation_given(self, name: str, start: str, end: str) -> Matrix:
        R = self.rotations[name]
        if R is None:
            raise SceneError(
                f"a vector along '{start}' is needed along '{end}', but the attitude of frame "
                f"'{name}' is not known; give it turned, or name the axes of the load by along"
            )
        return R

    def linked(self, first: str, second: str) -> bool:
        """Tell whether vectors can be carried from one frame to the other."""
        top = self.common(first, second)
        names = [
            n for end in (first, second) for n in self.chain(end)[: self.chain(end).index(top)]
        ]
        return all(self.rotations[n] is not None for n in names)

    def placed(self, first: str, second: str) -> bool:
        """Tell whether the origin of one frame is known from that of the other."""
        top = self.common(first, second)
        names = [
            n for end in (first, second) for n in self.chain(end)[: self.chain(end).index(top)]
        ]
        return all(_has_place(self.each[n]) for n in names)

    def anchor(self, name: str) -> str:
        """Return the nearest frame of the chain whose origin has no known place in its parent."""
        return next(n for n in self.chain(name) if n == INERTIAL or not _has_place(self.each[n]))

    def apart(self, start: Located, end: Located, along: str) -> Matrix:
        """Return the vector from one point to another, along the axes of a frame."""
        top = self.common(start[0], end[0])
        here, there = (self._from(top, point) for point in (start, end))
        return self.carried(there - here, top, along)

    def _from(self, top: str, point: Located) -> Matrix:
        """Return where a point is from the origin of a frame that carries it, along its axes."""
        name, at = point
        while name != top:
            parent = self.each[name].parent
            if not _has_place(self.each[name]):
                raise SceneError(
                    f"the origin of frame '{name}' is needed as a place in '{parent}', but only "
                    "its motion is given; say where it is by origin, with a coordinate if need be"
                )
            at = self.words.column(self.each[name].origin) + self.carried(at, name, parent)
            name = parent
        return at


def _has_place(frame: Frame) -> bool:
    """Tell whether the place of a frame's origin in its parent is given, not only its motion."""
    return frame.velocity is None and frame.acceleration is None and frame.rolls is None


def transported(known: Mapping[str, Matrix]) -> Matrix:
    """Return the rate of any vector seen from the inertial frame."""
    v, v_dot, Omega = known["any"], known["any_dot"], known["Omega"]
    return by_law("transport_theorem", {"l": v, "l_dot": v_dot, "Omega": Omega})
