"""A scene at values that show it: where its axes and bodies are, as floats.

Parameters stand in the middle of their ranges; angles lean a little, so that nothing hides behind
something else; what moves along a line stands apart by about the size of the bodies.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

from flint import ctx
from mpmath import mp, mpf

from derive.emit.drawing.space import (
    ORIGIN,
    Basis,
    Position,
    basis_along,
    extent,
    shifted,
    times,
)
from derive.scene import Input, Scene
from derive.scene.declaration import Moving, Triple
from derive.scene.formula import Formula, evaluate
from derive.scene.machine import Force, Load, Member
from derive.verify.cloud.balance import at_instant
from derive.verify.cloud.history import History
from derive.verify.cloud.series import BITS, DIGITS, series
from derive.verify.operators import LONG_FLOATS

LEAN = Fraction(3, 5)  # rad
ROOM = Fraction(1, 10)  # of a range, that a quantity keeps from its ends
APART = 0.7  # of the size of all bodies
_TILTED = {"w": mpf(96) / 100, "x": mpf(-16) / 100, "y": mpf(-10) / 100, "z": mpf(10) / 100}


@dataclass(frozen=True)
class Stance:
    """A machine at values of all that it knows, and how far sets of its bodies are moved apart.

    shifts : by frame
    """

    history: History
    shifts: Mapping[str, Position]

    @property
    def machine(self) -> Scene:
        """Return the scene."""
        return self.history.machine

    @cached_property
    def frames(self) -> dict[str, tuple[Position, Basis]]:
        """Return origin and directions of each frame, along N."""
        return {
            f.name: (self.moved(f.name, self.history.origins[f.name]),
                     _basis(self.history.rotations[f.name]))
            for f in self.machine.frames
        }  # fmt: skip

    def moved(self, frame: str, place: Any) -> Position:
        """Return a place of a frame as a point."""
        return shifted(_spot(place), self.shifts.get(frame, ORIGIN))

    def place(self, frame: str, at: Triple) -> Position:
        """Return where a point given in a frame is."""
        return self.moved(frame, self.history.place(frame, at))

    def centre(self, body: Member) -> Position:
        """Return where the mass centre of a body is."""
        return self.place(body.frame, body.centre)

    def axes(self, body: Member) -> Basis:
        """Return the directions fixed in a body."""
        return _basis(self.history.body(body.name))

    @cached_property
    def _known(self) -> dict[str, Any]:
        """Return every scalar; loads that are to be found are 1, so that their signs show."""
        found = {u.name: series(1) for u in self.machine.unknowns}
        return found | self.history.scalars

    def figure(self, formula: Formula) -> float:
        """Return the value of a formula, in which any operator may stand."""
        with ctx.workprec(BITS):
            now = {name: series(known).terms[0] for name, known in self._known.items()}
            return float(evaluate(formula, now, LONG_FLOATS))

    def semi_axes(self, body: Member) -> tuple[Basis, bool]:
        """Return the semi-axes of the ellipsoid that has a body's inertia, and if there is one."""
        centre = at_instant(self.history.centre(body.name))
        pairs = self.history.particles(body.name)[:-1:2]
        arms = [(at_instant(place) - centre) * mp.sqrt(mpf(5) / 3) for _, place in pairs]
        x, y, z = (_spot(arm) for arm in arms)
        return (x, y, z), all(mass > 0 for mass, _ in pairs)


def stance(scene: Scene) -> Stance:
    """Return a scene as it is drawn."""
    with mp.workdps(DIGITS):
        history = History(scene, dict(_values(scene, mpf(0))))
        found = Stance(history, {})
        size = _size(found)
        if _slides(scene):
            found = Stance(History(scene, dict(_values(scene, mpf(APART * size)))), {})
        return replace(found, shifts=_alternatives(found, size))


def _slides(scene: Scene) -> bool:
    return any(c.unit == "m" for c in scene.coordinates)


def _size(found: Stance) -> float:
    """Return about how large the bodies of a scene are, with the arms that carry them."""
    sizes = [1e-9]
    for body in found.machine.bodies:
        own = [found.figure(f) for part in body.parts for rim in part.rims for f in rim]
        own += [found.figure(f) for part in body.parts for f in part.edges]
        if not body.parts and None not in body.inertia:
            own += [extent(a) for a in found.semi_axes(body)[0]]
        arm = extent(shifted(found.centre(body), found.frames[body.frame][0], -1.0))
        sizes.append(arm + 2 * max(map(abs, own), default=0.0))
    loads = [load for load in found.machine.loads if isinstance(load, Force)]
    arms = (shifted(found.place(w.frame, w.at), found.frames[w.frame][0], -1.0) for w in loads)
    return max([*sizes, *(2 * extent(arm) for arm in arms)])


def _values(scene: Scene, apart: Any) -> Iterator[tuple[str, Any]]:
    """Yield every argument of a machine."""
    for p in scene.parameters:
        middle = (p.low + p.high) / 2
        yield p.name, _number(middle if middle else (3 * p.low + 7 * p.high) / 10)
    for m in scene.moving:
        yield m.name, _posed(m, apart)
        for i in (m.rate, m.acceleration):
            if isinstance(i, Input):
                yield i.name, _number((3 * i.low + 7 * i.high) / 10)
        if m.free:
            yield m.unknown, mpf(0)
    for frame in scene.frames:
        if frame.attitude:
            yield from ((f"{frame.attitude}_{p}", x) for p, x in _TILTED.items())


def _posed(m: Moving, apart: Any) -> Any:
    """Return a coordinate where it shows, kept from the ends of its range; else seven tenths."""
    room = ROOM * (m.high - m.low)
    if m.kind != "coordinate" or m.unit not in ("rad", "m"):
        return _number((3 * m.low + 7 * m.high) / 10)
    wanted = _number(LEAN) if m.unit == "rad" else apart
    if m.unit == "m" and m.vector == "" and m.name.endswith("_z"):
        wanted = apart / 2
    return min(max(wanted, _number(m.low + room)), _number(m.high - room))


def _number(exact: Fraction) -> Any:
    return mpf(exact.numerator) / exact.denominator


def _spot(place: Any) -> Position:
    x, y, z = (float(getattr(v, "value", v)) for v in place)
    return x, y, z


def _basis(rotation: Any) -> Basis:
    R = at_instant(rotation)
    return _spot(R[:, 0]), _spot(R[:, 1]), _spot(R[:, 2])


def _alternatives(found: Stance, size: float) -> dict[str, Position]:
    """Return how far sets of frames are moved whose bodies lie in one place and share no load.

    A scene may hold several cases of one machine, which would be drawn over each other.
    """
    scene, sets = found.machine, list[set[str]]()
    for group in _together(scene):
        joined = set(group).union(*(s for s in sets if s & set(group)))
        sets = [s for s in sets if not s & joined] + [joined]
    cases = [s for s in sets if any(b.frame in s for b in scene.bodies)]
    cases.sort(key=lambda s: min(k for k, f in enumerate(scene.frames) if f.name in s))
    centres = [found.centre(next(b for b in scene.bodies if b.frame in s)) for s in cases]
    if any(extent(shifted(c, centres[0], -1.0)) > size / 10 for c in centres):
        return {}
    step = (0.0, 1.6 * size, 0.0)
    return {name: times(step, float(k)) for k, case in enumerate(cases) for name in case}


def _together(scene: Scene) -> Iterator[Sequence[str]]:
    """Yield frames that belong together: a frame and its carrier, and what a load joins."""
    inertial = scene.frames[0].name
    for frame in scene.frames[1:]:
        yield (frame.name,) if frame.parent == inertial else (frame.name, frame.parent)
    for load in scene.loads:
        joined = _joined_by(scene, load)
        if len(joined) > 1:
            yield joined


def _joined_by(scene: Scene, load: Load) -> list[str]:
    names = [getattr(load, "on", ""), getattr(load, "against", "")]
    frames = [b.frame for b in scene.bodies if b.name in names]
    frames += [getattr(load, name, "") for name in ("frame", "to_frame", "along")]
    return [f for f in dict.fromkeys(frames) if f and f != scene.frames[0].name]


def wheel_axis(found: Stance, body: Member) -> Basis:
    """Return directions of which the third is the axis that a body turns about."""
    if body.spin_axis is not None:
        axes = found.frames[body.frame][1]
        x, y, z = map(found.figure, body.spin_axis)
        along = shifted(shifted(times(axes[0], x), axes[1], y), axes[2], z)
        return basis_along(along)
    own = found.axes(body)
    place = "xyz".index(body.axis) if body.axis else _largest(found, body)
    return basis_along(own[place])


def _largest(found: Stance, body: Member) -> int:
    known = [found.figure(f) if f is not None else 0.0 for f in body.inertia[:3]]
    return max(range(3), key=known.__getitem__)
