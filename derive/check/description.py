"""A machine described along other axes: the same bodies in the same motion, told anew.

Triples of formulas, tensors and axes are told along frames that are turned by a constant rotation.
Names keep their meaning, so answers are the same numbers; quaternions and angular momentum turn.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

from flint import arb

from derive.scene import Scene
from derive.scene.constraint import Constraint
from derive.scene.declaration import Axis, Triple, Turning
from derive.scene.formula import ZERO, Formula, number, substitute, symbol
from derive.scene.machine import (
    INERTIAL,
    Entries,
    Force,
    Frame,
    Gradient,
    Load,
    Member,
    Spring,
    Weight,
)
from derive.verify.differences import product

Quaternion = tuple[Fraction, Fraction, Fraction, Fraction]
HALF, FIFTH, ONE, NONE = Fraction(1, 2), Fraction(1, 5), Fraction(1), Fraction(0)
CYCLE: Quaternion = (HALF, HALF, HALF, HALF)  # x -> y -> z -> x
TURN: Quaternion = (4 * FIFTH, FIFTH, -2 * FIFTH, -2 * FIFTH)
STILL: Quaternion = (ONE, NONE, NONE, NONE)
XYZ: tuple[Axis, Axis, Axis] = ("x", "y", "z")
PLACES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
VECTORS = ("angular_momentum", "rate_in_axes", "rate_absolute")
"""Answers along the frame in which the scene wants its angular momentum."""


@dataclass(frozen=True)
class Description:
    """A machine told along other axes: components along a turned frame are R times the old ones.

    turn : quaternion of R      frames : those that are turned
    """

    machine: Scene
    turn: Quaternion
    frames: frozenset[str]

    @cached_property
    def rows(self) -> list[list[Fraction]]:
        """Return R, whose columns are the images of the unit vectors."""
        w, *v = self.turn
        back = (w, *(-x for x in v))
        units = [(NONE, *(Fraction(i == k) for i in range(3))) for k in range(3)]
        images = [product(product(self.turn, e), back)[1:] for e in units]
        return [list(row) for row in zip(*images, strict=True)]

    def told(self) -> Scene:
        """Return the machine as it is told along the turned frames."""
        machine, place = self.machine, self.machine.momentum
        results = tuple(replace(r, formula=self._formula(r.formula)) for r in machine.results)
        steady = {
            name: replace(own, vanishes=tuple(map(self._formula, own.vanishes)))
            for name, own in machine.steady.items()
        }
        return replace(
            machine,
            frames=tuple(map(self._frame, machine.frames)),
            bodies=tuple(map(self._member, machine.bodies)),
            loads=tuple(map(self._load, machine.loads)),
            constraints=tuple(map(self._constraint, machine.constraints)),
            momentum=replace(place, at=self._triple(place.at, place.frame)),
            results=results,
            steady=steady,
            inverse=replace(self, machine=machine.inverse).told() if machine.inverse else None,
        )

    def given(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return values, in balls, with every quaternion as it is told: r_P q r_F*."""
        found = dict(values)
        for parts, (left, right) in self._attitudes():
            first, last = (list(map(_ball, r)) for r in (left, _back(right)))
            turned = product(product(first, [values[c] for c in parts]), last)
            found |= dict(zip(parts, turned, strict=True))
        return found

    def told_back(self, answers: Mapping[str, Any]) -> dict[str, Any]:
        """Return answers, in balls, with vectors and quaternions as the machine tells them."""
        found = dict(answers)
        rates = self.machine.groups.rate_of_each()
        for q, (left, right) in self._attitudes():
            parts = [rates[c] for c in q]
            if parts[0] in answers:
                first, last = (list(map(_ball, r)) for r in (_back(left), right))
                turned = product(product(first, [answers[c] for c in parts]), last)
                found |= dict(zip(parts, turned, strict=True))
        for name in VECTORS:
            parts = [f"{name}_{a}" for a in XYZ]
            if parts[0] in answers and self.machine.momentum.frame in self.frames:
                own = [answers[c] for c in parts]
                found |= {c: dotted(map(_ball, column), own) for c, column in
                          zip(parts, zip(*self.rows, strict=True), strict=True)}  # fmt: skip
        return found

    def _attitudes(self) -> Iterator[tuple[list[str], tuple[Quaternion, Quaternion]]]:
        """Yield the quaternions of the state, each with the turns of its parent and its frame."""
        for frame in self.machine.frames:
            if frame.attitude:
                parts = [f"{frame.attitude}_{p}" for p in ("w", *XYZ)]
                yield parts, (self._turn(frame.parent), self._turn(frame.name))

    def _turn(self, frame: str) -> Quaternion:
        return self.turn if frame in self.frames else STILL

    @cached_property
    def _swaps(self) -> Mapping[str, Formula]:
        """Return what a formula that names a turned component must now say instead."""
        names = {c: symbol(c) for parts, _ in self._attitudes() for c in parts}
        swaps: dict[str, Formula] = {}
        for parts, (left, right) in self._attitudes():
            own = [names[c] for c in parts]
            factors = [[number(x) for x in r] for r in (_back(left), right)]
            swaps |= dict(zip(parts, product(product(factors[0], own), factors[1]), strict=True))
        if self.machine.momentum.frame in self.frames:
            own = [symbol(f"angular_momentum_{a}") for a in XYZ]
            for a, column in zip(XYZ, zip(*self.rows, strict=True), strict=True):
                swaps[f"angular_momentum_{a}"] = dotted(map(number, column), own)
        return swaps

    def _formula(self, formula: Formula) -> Formula:
        return substitute(formula, self._swaps)

    def _triple(self, triple: Triple, frame: str) -> Triple:
        told = [self._formula(f) for f in triple]
        if frame in self.frames:
            told = [dotted(map(number, row), told) for row in self.rows]
        x, y, z = told
        return x, y, z

    def _maybe(self, triple: Triple | None, frame: str) -> Triple | None:
        return None if triple is None else self._triple(triple, frame)

    def _axis(self, axis: Axis) -> Axis:
        """Return the axis that an axis is now called; only relabelled ones have a name."""
        column = [row[XYZ.index(axis)] for row in self.rows]
        return XYZ[column.index(ONE)]

    def _turned(self, turned: Sequence[Turning]) -> tuple[Turning, ...]:
        return tuple(Turning(self._axis(t.axis), t.angle) for t in turned)

    def _frame(self, frame: Frame) -> Frame:
        name, own = frame.name, frame.name in self.frames
        rolls = frame.rolls
        return replace(
            frame,
            turned=self._turned(frame.turned) if own else frame.turned,
            angular_velocity=self._maybe(frame.angular_velocity, name),
            origin=self._triple(frame.origin, frame.parent),
            velocity=self._maybe(frame.velocity, name),
            acceleration=self._maybe(frame.acceleration, name),
            rolls=None if rolls is None else replace(rolls, at=self._triple(rolls.at, name)),
        )

    def _member(self, body: Member) -> Member:
        if body.frame not in self.frames:
            return body
        centre = self._triple(body.centre, body.frame)
        omega = self._maybe(body.angular_velocity, body.frame)
        inertia, axis, spin = self._inertia(body.inertia), body.axis, body.spin
        if self.turn == CYCLE:
            axis = None if axis is None else self._axis(axis)
        elif axis is not None:  # the turned axis of a spin has no name
            e = [Fraction(a == axis) for a in XYZ]
            x, y, z = (dotted([number(f) for f in row], map(number, e)) for row in self.rows)
            omega = omega if spin is None else (spin * x, spin * y, spin * z)
            axis, spin = None, None
        return replace(
            body, turned=self._turned(body.turned), centre=centre, angular_velocity=omega,
            inertia=inertia, axis=axis, spin=spin,
            spin_axis=self._maybe(body.spin_axis, body.frame),
        )  # fmt: skip

    def _inertia(self, inertia: Entries) -> Entries:
        """Return moments and products of R I R^T, None where they are made of what is not known."""
        entry = dict(zip(PLACES, inertia, strict=True))
        found: list[Formula | None] = []
        for i, k in PLACES:
            total: Formula | None = ZERO
            for m, row in enumerate(self.rows[i]):
                for n, other in enumerate(self.rows[k]):
                    sign = 1 if (i == k) == (m == n) else -1
                    factor, own = sign * row * other, entry[min(m, n), max(m, n)]
                    if factor and total is not None:
                        total = None if own is None else total + number(factor) * own
            found.append(total)
        return tuple(found)

    def _load(self, load: Load) -> Load:
        match load:
            case Force():
                return replace(
                    load,
                    at=self._triple(load.at, load.frame),
                    force=self._triple(load.force, load.along),
                    couple=self._triple(load.couple, load.along),
                    other=load.other
                    and (load.other[0], self._triple(load.other[1], load.other[0])),
                )
            case Weight():
                return replace(load, gravity=self._triple(load.gravity, load.along))
            case Gradient():
                return replace(load, towards=self._triple(load.towards, load.along))
            case Spring():
                at, to = self._triple(load.at, load.frame), self._triple(load.to, load.to_frame)
                return replace(load, at=at, to=to)

    def _constraint(self, one: Constraint) -> Constraint:
        meeting = one.meeting
        return replace(
            one,
            zero=self._formula(one.zero),
            meeting=meeting and replace(
                meeting,
                at=self._triple(meeting.at, meeting.frame),
                to=self._triple(meeting.to, meeting.to_frame),
                directions=tuple(self._triple(e, meeting.along) for e in meeting.directions),
            ),
        )  # fmt: skip


def relabelled(machine: Scene) -> Description:
    """Return a machine with all axes of all frames relabelled, x -> y -> z -> x."""
    return Description(machine, CYCLE, frozenset(f.name for f in machine.frames))


def turned_machine(machine: Scene) -> Description | None:
    """Return a machine with the frames turned whose angular velocity is given along them.

    None if there is no such frame whose bodies can be told along any axes.
    """
    names = {f.name for f in machine.frames if f.angular_velocity is not None}
    names -= {f.parent for f in machine.frames} - {INERTIAL}
    names -= {b.frame for b in machine.bodies if b.turned or b.axial_speed or None in b.inertia}
    return Description(machine, TURN, frozenset(names)) if names else None


def _ball(x: Fraction) -> Any:
    return arb(x.numerator) / x.denominator


def dotted(first: Any, second: Any) -> Any:
    """Return the sum of the products of two rows."""
    one, *others = [a * b for a, b in zip(first, second, strict=True)]
    for other in others:
        one = one + other
    return one


def _back(q: Quaternion) -> Quaternion:
    w, x, y, z = q
    return w, -x, -y, -z
