"""What acts on the bodies of a machine: every load as a force and a couple at a point."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from sympy import Expr, Integer, Matrix, Rational, Symbol, sqrt

from derive.lecture.stated import by_law
from derive.mechanics.bodies import centre, inertia_tensor, mass
from derive.mechanics.box import ranges
from derive.mechanics.frames import ZERO, Frames, Located
from derive.mechanics.meeting import ends
from derive.mechanics.probe import NOTHING, at_rest, random_probe, vanishes
from derive.mechanics.sweep import Sweep, weakest
from derive.scene import SceneError
from derive.scene.machine import INERTIAL, Force, Gradient, Load, Spring, Weight

FEW = 4
"""Frames of a chain up which places are carried."""


@dataclass(frozen=True)
class Wrench:
    """A force at a point of a body and a couple on it, both along the axes of a frame."""

    load: str
    body: str
    point: Located
    along: str
    force: Matrix
    couple: Matrix

    def without(self, gone: Iterable[Symbol]) -> "Wrench":
        """Return it with some unknowns zero."""
        none = dict.fromkeys(gone, Integer(0))
        if not none:
            return self
        return replace(self, force=self.force.xreplace(none), couple=self.couple.xreplace(none))


def wrenches(frames: Frames) -> tuple[Wrench, ...]:
    """Return all that acts on the bodies."""
    return tuple(w for load in frames.machine.loads for w in _of(frames, load))


def _of(frames: Frames, load: Load) -> Iterator[Wrench]:
    match load:
        case Force():
            yield from _force(frames, load)
        case Weight():
            yield from _weight(frames, load)
        case Gradient():
            yield from _gradient(frames, load)
        case Spring():
            yield from _spring(frames, load)


def _force(frames: Frames, load: Force) -> Iterator[Wrench]:
    force, couple = frames.words.column(load.force), frames.words.column(load.couple)
    couples = {load.on: couple, load.against: -couple}
    for body, places in ends(frames, load).items():
        for point, sign in places:
            own = couples.pop(body, ZERO)
            yield Wrench(load.name, body, point, load.along, sign * force, own)


def _weight(frames: Frames, load: Weight) -> Iterator[Wrench]:
    g = frames.words.column(load.gravity)
    for body in load.on:
        force = mass(frames, body) * g
        yield Wrench(load.name, body, centre(frames, body), load.along, force, ZERO)


def _gradient(frames: Frames, load: Gradient) -> Iterator[Wrench]:
    strength = frames.words.expression(load.strength)
    for body in load.on:
        own = frames.own(body)
        c = frames.carried(frames.words.column(load.towards), load.along, own)
        c = frames.sheet.column(f"{body}.towards", c)
        known = {"k": strength * Rational(1, 3), "c": c, "I_G": inertia_tensor(frames, body)}
        couple = by_law("gravity_gradient", known)
        yield Wrench(load.name, body, centre(frames, body), own, ZERO, couple)


def stretched(frames: Frames, load: Spring) -> tuple[Matrix, str]:
    """Return the vector from the spring's point on ``on`` to its other end, and its axes."""
    start = (load.frame, frames.words.column(load.at))
    end = (load.to_frame, frames.words.column(load.to))
    top = frames.common(load.frame, load.to_frame)
    if not frames.placed(load.frame, load.to_frame):
        raise SceneError(f"load '{load.name}': the place of '{load.frame}' is not known in "
                         f"'{load.to_frame}', so the spring has no length")  # fmt: skip
    return frames.sheet.column(f"{load.name}.d", frames.apart(start, end, top)), top


def along_one_line(frames: Frames, d: Matrix) -> Expr | None:
    """Return the length of a vector along one axis, whose sign is one on the declared ranges.

    So its length has no root. None if it is along several, or vanishes on its way.
    """
    parts = [x for x in d if x != 0]
    if len(parts) != 1:
        return None
    (one,), below = parts, frames.sheet.needed(parts)
    box = replace(ranges(frames.words), onto=None)
    least = (weakest(box, below, partial(_value, e)).least for e in (one, -one))
    return next((e for e, low in zip((one, -one), least, strict=False) if low >= 0), None)


def _value(e: Expr, at: Sweep) -> Any:
    return at.of(e)[0]


def _spring(frames: Frames, load: Spring) -> Iterator[Wrench]:
    words, sheet = frames.words, frames.sheet
    d, top = stretched(frames, load)
    k, c, rest = (words.expression(f) for f in (load.stiffness, load.damping, load.length))
    force: Matrix = k * d
    if rest != 0 or c != 0:
        one = along_one_line(frames, d)
        if one is None:
            _require_length(frames, load, (d.T * d)[0])
        size = sheet.named(f"{load.name}.length", sqrt((d.T * d)[0]) if one is None else one)
        force = force - (k * rest / size) * d
        opening = sum((x * v for x, v in zip(d, sheet.rate_of_column(d), strict=True)), Integer(0))
        force = force + (c * opening / size**2) * d
    force = sheet.column(f"{load.name}.force", force)
    yield Wrench(load.name, load.on, (load.frame, words.column(load.at)), top, force, ZERO)
    if load.against:
        yield Wrench(load.name, load.against, (load.to_frame, words.column(load.to)), top,
                     -force, ZERO)  # fmt: skip


def _require_length(frames: Frames, load: Spring, square: Expr) -> None:
    """Refuse a spring or damper whose ends coincide: its force would have no direction."""
    words, sheet = frames.words, frames.sheet
    for probe, where in (
        (random_probe(words, 0), ""),
        (at_rest(words), " where all that varies is 0"),
    ):
        probe.define(sheet.needed([square]))
        if abs(probe.value(square)) <= NOTHING:
            raise SceneError(
                f"load '{load.name}': its two ends coincide{where}, so its force has no direction; "
                "move an end, or leave out length and damper"
            )


def idle_springs(frames: Frames) -> Iterator[str]:
    """Yield a sentence for every spring whose ends coincide, however the machine stands."""
    for load in frames.machine.loads:
        if isinstance(load, Spring):
            d, _ = stretched(frames, load)
            if vanishes(frames.words, (d.T * d)[0]):
                yield f"load '{load.name}': its two ends coincide always, so it has no force"


def potential_energy(frames: Frames) -> Expr:
    """Return the energy of weights and springs; a weight's is zero at the inertial origin.

    A frame whose origin has no known place may carry a body that keeps its height: then the
    energy is zero at that origin. Raises SceneError if a height or a force has no energy.
    """
    total: Expr = Integer(0)
    for load in frames.machine.loads:
        if isinstance(load, Weight):
            for body in load.on:
                g = frames.carried(frames.words.column(load.gravity), load.along, INERTIAL)
                _keeps(frames, load.name, "gravity", list(g))
                start = _level(frames, load.name, g, centre(frames, body)[0])
                total -= mass(frames, body) * _along(frames, g, start, centre(frames, body))
        elif isinstance(load, Spring):
            d, _ = stretched(frames, load)
            k, rest = (frames.words.expression(f) for f in (load.stiffness, load.length))
            _keeps(frames, load.name, "stiffness and length", [k, rest])
            square = (d.T * d)[0]
            one = along_one_line(frames, d) if rest != 0 else Integer(0)
            size = sqrt(square) if one is None else one
            total += Rational(1, 2) * k * (square - 2 * rest * size + rest**2)
    return total


def _along(frames: Frames, g: Matrix, start: str, end: Located) -> Expr:
    """Return how far a point is from a frame's origin along an inertial vector, times its length.

    Up a long chain the point is not carried: that doubles its terms at every turn. The vector is
    carried down instead, which has a name in every frame.
    """
    above = frames.chain(end[0])[: frames.chain(end[0]).index(start)]
    if len(above) <= FEW:
        return (g.T * frames.apart((start, ZERO), end, INERTIAL))[0]
    origins = ((frames.each[n].parent, frames.words.column(frames.each[n].origin)) for n in above)
    each = ((frames.carried(g, INERTIAL, name).T * at)[0] for name, at in (end, *origins))
    return sum(each, Integer(0))


def _keeps(frames: Frames, load: str, what: str, values: list[Expr]) -> None:
    """Refuse the energy of a load that changes in the inertial frame by itself."""
    if not all(vanishes(frames.words, frames.sheet.rate(_held(frames, v))) for v in values):
        rule = f"has no potential energy, for its {what} change with the motion"
        raise SceneError(f"load '{load}' {rule}; ask for kinetic_energy and add it in results")


def _held(frames: Frames, value: Expr) -> Expr:
    """Return a value with inputs held, whose rates are not known."""
    return value.xreplace(dict.fromkeys(frames.sheet.rateless, Integer(1)))


def _level(frames: Frames, load: str, g: Matrix, name: str) -> str:
    """Return the frame from whose origin heights count: inertial, or one that keeps its height."""
    start = frames.anchor(name)
    if start != INERTIAL:
        climbs = frames.carried(frames.velocity(start), start, INERTIAL)
        if not vanishes(frames.words, (g.T * climbs)[0]):
            raise SceneError(
                f"load '{load}': the height of frame '{start}' is not known, for only the motion "
                "of its origin is given; say where it is by origin, with a coordinate if need be, "
                "or ask for kinetic_energy and add the weight's energy in results"
            )
    return start
