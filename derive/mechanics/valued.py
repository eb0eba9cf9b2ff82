"""Vectors of a machine at a trial point: what motion needs and what acts, in common axes."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from mpmath import mp
from numpy.typing import NDArray
from sympy import Matrix, Symbol

from derive.mechanics.bodies import Effort, effort
from derive.mechanics.constraints import symbols_held
from derive.mechanics.frames import ZERO, ByFrame, Frames, Located
from derive.mechanics.held import Bindings, bindings
from derive.mechanics.loads import Wrench, wrenches
from derive.mechanics.probe import NOTHING, PROBES, Probe, at_rest, random_probe
from derive.scene.machine import INERTIAL


@dataclass(frozen=True)
class Sides:
    """Both sides of every balance: the efforts of the bodies, by name, and the loads on them.

    unknowns : what is in them and to be found, in order of their names' places
    held     : what the constraints ask for besides
    """

    frames: Frames
    efforts: Mapping[str, Effort]
    wrenches: tuple[Wrench, ...]
    unknowns: tuple[Symbol, ...]
    held: Bindings = field(default_factory=Bindings)


def sides(frames: Frames) -> Sides:
    """Return both sides of every balance of a machine; what they name is on its sheet then."""
    efforts = {b.name: effort(frames, b.name) for b in frames.machine.bodies}
    own = bindings(frames)
    acting = tuple(w.without(own.told) for w in wrenches(frames))
    used = {s for e in efforts.values() for s in e.moment.free_symbols}
    used |= {s for e in efforts.values() for part in e.force.values() for s in part.free_symbols}
    used |= {s for w in acting for s in w.force.free_symbols | w.couple.free_symbols}
    used |= symbols_held(own.kept)
    unknowns = tuple(sorted(used & frames.sheet.unknowns, key=str))
    return Sides(frames, efforts, acting, unknowns, own)


def trial_probes(frames: Frames) -> tuple[Probe, ...]:
    """Return the trial points, all that is named so far valued."""
    found = (*(random_probe(frames.words, n) for n in range(PROBES)), at_rest(frames.words))
    for probe in found:
        probe.define(frames.sheet.definitions)
    return found


@dataclass
class Valued:
    """Vectors of a machine at one trial point, along the axes of the topmost linked frame."""

    sides: Sides
    probe: Probe

    def __post_init__(self) -> None:
        """Begin with nothing remembered."""
        self._turned: dict[str, NDArray[Any]] = {}
        self._bodies: dict[str, tuple[NDArray[Any], NDArray[Any]]] = {}

    def rotation(self, name: str) -> NDArray[Any]:
        """Return R from a frame to the topmost one that it is linked with."""
        frames = self.sides.frames
        if name not in self._turned:
            R = frames.rotations[name] if name != INERTIAL else None
            if R is None:
                self._turned[name] = np.array([[mp.mpf(i == k) for k in range(3)]
                                               for i in range(3)])  # fmt: skip
            else:
                own = self.array(R)
                self._turned[name] = self.rotation(frames.each[name].parent) @ own
        return self._turned[name]

    def direction(self, frame: str, axis: str) -> NDArray[Any]:
        """Return the unit vector of an axis of a frame."""
        found: NDArray[Any] = (
            self.rotation(frame) @ self.array(self.sides.frames.direction(axis))[:, 0]
        )
        return found

    def distinct(self, axes: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
        """Return axes of frames without those along others."""
        found: list[tuple[str, str]] = []
        seen: list[NDArray[Any]] = []
        for frame, axis in axes:
            e = self.direction(frame, axis)
            if not any(abs(abs(e @ other) - 1) < NOTHING for other in seen):
                found.append((frame, axis))
                seen.append(e)
        return found

    def array(self, matrix: Matrix) -> NDArray[Any]:
        """Return the values of a matrix."""
        rows, columns = matrix.shape
        return np.array([[self.probe.value(matrix[i, k]) for k in range(columns)]
                         for i in range(rows)])  # fmt: skip

    def linear(self, vector: Matrix, frame: str) -> NDArray[Any]:
        """Return a vector's rest and its coefficients of each unknown, (3, 1 + unknowns)."""
        columns = np.array([[mp.mpf(0)] * (1 + len(self.sides.unknowns)) for _ in range(3)])
        for i in range(3):
            rest, slopes = self.sides.frames.sheet.split(vector[i])
            columns[i, 0] = self.probe.value(rest)
            for u, slope in slopes.items():
                columns[i, 1 + self.sides.unknowns.index(u)] = self.probe.value(slope)
        turned: NDArray[Any] = self.rotation(frame) @ columns
        return turned

    def parts(self, vector: ByFrame) -> NDArray[Any]:
        """Return a vector that is a sum of parts along several frames."""
        total = self.linear(ZERO, INERTIAL)
        for name, part in vector.items():
            total = total + self.linear(part, name)
        return total

    def place(self, place: Located) -> NDArray[Any]:
        """Return where a point is from the origin of the topmost frame that it is placed in."""
        frames = self.sides.frames
        name, at = place[0], self.rotation(place[0]) @ self.array(place[1])[:, 0]
        while name != INERTIAL:
            parent = frames.each[name].parent
            if not (frames.placed(name, parent) and frames.linked(name, parent)):
                break
            own = self.array(frames.words.column(frames.each[name].origin))[:, 0]
            at = at + self.rotation(parent) @ own
            name = parent
        return np.asarray(at)

    def force(self, bodies: tuple[str, ...]) -> NDArray[Any]:
        """Return mass times acceleration less the forces."""
        return np.asarray(sum(self._left(name)[0] for name in bodies))

    def moment(self, bodies: tuple[str, ...], place: Located) -> NDArray[Any]:
        """Return the rate of angular momentum less the moments, about a point."""
        about_origin = sum(self._left(name)[1] for name in bodies)
        return np.asarray(about_origin - _crossed(self.place(place), self.force(bodies)))

    def _left(self, body: str) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return what forces leave of a body's effort, and of its moment about the origin."""
        if body not in self._bodies:
            own = self.sides.efforts[body]
            force, moment = self.parts(own.force), self.linear(own.moment, own.frame)
            moment = moment + _crossed(self.place(own.centre), force)
            for w in self.sides.wrenches:
                if w.body == body:
                    acting = self.linear(w.force, w.along)
                    force = force - acting
                    moment = moment - self.linear(w.couple, w.along)
                    if w.force != ZERO:
                        moment = moment - _crossed(self.place(w.point), acting)
            self._bodies[body] = (force, moment)
        return self._bodies[body]


def _crossed(arm: NDArray[Any], columns: NDArray[Any]) -> NDArray[Any]:
    x, y, z = arm
    return np.array([columns[2] * y - columns[1] * z, columns[0] * z - columns[2] * x,
                     columns[1] * x - columns[0] * y])  # fmt: skip
