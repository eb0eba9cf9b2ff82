"""Parameters and inputs to check a scene's functions at: ordinary ones and hard corners.

Every number is a float of the precision that it is for, with all its bits in use: products of
short numbers would be exact in double and flatter it. The same numbers on any machine:
``random.Random`` seeded by text, and basic float operations only.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import sqrt
from random import Random

from derive.mechanics.mechanism import Mechanism
from derive.program.added import added
from derive.program.arithmetic import rounded
from derive.program.precision import Precision
from derive.program.program import Quantity
from derive.scene import SceneError
from derive.verify.hard_bodies import (
    BODIES,
    Hard,
    admissible,
    bodies,
    hard_body,
    solvable,
)

Drawn = dict[str, float]
LARGE_SPIN = 1e4
DENORMAL = {"f32": 2.0**-140, "f64": 2.0**-1060}
TRIES = 200
FITS = 3  # tries after which a body is taken not to be a hard one at any parameters
PATIENCE = 20  # tries after which a tensor will do that breaks the triangle inequality
HALF_TURNS = ((0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1), (0, 0.6, 0, 0.8), (0, 2 / 3, 2 / 3, 1 / 3))


@dataclass(frozen=True)
class Sample:
    """One set of values by component, and what is hard about it."""

    number: int
    kind: str
    values: Drawn


@dataclass(frozen=True)
class Samples:
    """The samples of a scene for one precision, and the corners that the scene cannot take."""

    each: tuple[Sample, ...]
    skipped: tuple[str, ...]


@dataclass(frozen=True)
class Source:
    """Where samples come from: a scene, a precision, and dice for one kind of sample."""

    mechanism: Mechanism
    precision: Precision
    dice: Random

    def held(self, x: float) -> float:
        """Return the float of the precision next to ``x``, as a Python float."""
        return float(rounded(Fraction(x), self.precision.dtype))


def source(mechanism: Mechanism, precision: Precision, kind: str) -> Source:
    """Return the source of one kind of sample."""
    seed = f"derive: {mechanism.scene.name} {precision.name} {kind}"
    return Source(mechanism, precision, Random(seed))  # noqa: S311 - samples, no secret


def samples(mechanism: Mechanism, precision: Precision, ordinary: int, corners: int) -> Samples:
    """Return ``ordinary`` samples on the declared ranges, and ``corners`` of each hard kind."""
    plain = source(mechanism, precision, "ordinary")
    found = [("ordinary", _ordinary(plain)) for _ in range(ordinary)]
    skipped = []
    for kind, corner in CORNERS.items():
        own = source(mechanism, precision, kind)
        made = [corner(own, n) for n in range(corners)]
        found += [(kind, values) for values in made if values is not None]
        skipped += [kind] if all(values is None for values in made) else []
    for hard in BODIES:
        own = source(mechanism, precision, hard.kind)
        bodies_ = _with_hard_bodies(own, hard, corners)
        found += [(hard.kind, values) for values in bodies_]
        skipped += [] if bodies_ or not corners else [hard.kind]
    each = tuple(Sample(n, kind, values) for n, (kind, values) in enumerate(found))
    return Samples(each, tuple(skipped))


def _with_hard_bodies(of: Source, hard: Hard, corners: int) -> list[Drawn]:
    """Return samples in which one body is a hard one, in turns, the others as they come."""
    found: list[Drawn] = []
    places = range(len(bodies(of.mechanism.scene)) if corners else 0)
    able = [place for place in places if _with_hard_body(of, hard, place)]
    for n in range(max(corners, len(able)) if able else 0):
        values = _with_hard_body(of, hard, able[n % len(able)])
        found += [] if values is None else [values]
    return found


def _with_hard_body(of: Source, hard: Hard, place: int) -> Drawn | None:
    for _ in range(FITS):
        start = _ordinary(of)
        own = hard_body(of.mechanism.scene, place, hard, start, (of.dice, of.precision))
        if own is not None:
            return start | own
    return None


def _ordinary(of: Source) -> Drawn:
    parameters = of.mechanism.vocabulary.parameters
    for tries in range(TRIES):
        values = {n: of.held(uniform(of.dice, q)) for q in parameters for n in q.components}
        if admissible(of.mechanism.scene, values):
            return values | _motion(of)
        if tries > PATIENCE and solvable(of.mechanism.scene, values):
            return values | _motion(of)
    raise SceneError(
        f"scene '{of.mechanism.scene.name}': the ranges of its parameters must hold a body, "
        f"but none was found in {TRIES} tries"
    )


def _motion(of: Source) -> Drawn:
    values: Drawn = {}
    for q in varying(of.mechanism):
        own = [uniform(of.dice, q) for _ in q.components]
        own = _unit(own) if q.is_quaternion else own
        values |= {name: of.held(x) for name, x in zip(q.components, own, strict=True)}
    return values


def varying(mechanism: Mechanism) -> tuple[Quantity, ...]:
    """Return all quantities that vary with time and enter from outside."""
    return (*mechanism.vocabulary.states, *mechanism.vocabulary.inputs)


def uniform(dice: Random, q: Quantity) -> float:
    """Return a number on the range of a quantity."""
    low, high = map(float, q.ends)
    return low + (high - low) * dice.random()


def _unit(values: Sequence[float]) -> list[float]:
    """Return a direction of unit length, by operations that every machine rounds alike."""
    size = sqrt(added(x * x for x in values))
    return [x / size for x in values]


def _changed(of: Source, change: Callable[[Quantity, float], float]) -> Drawn:
    """Return an ordinary sample with every varying value changed by a rule."""
    values = _ordinary(of)
    for q in varying(of.mechanism):
        values |= {name: of.held(change(q, values[name])) for name in q.components}
    return values


def _large_spin(of: Source, _: int) -> Drawn | None:
    fast = [q for q in varying(of.mechanism) if q.unit == "rad/s"]

    def change(q: Quantity, x: float) -> float:
        reach = max(abs(float(end)) for end in q.ends)
        return x / reach * LARGE_SPIN if q in fast else x

    return _changed(of, change) if fast else None


def _at_rest(of: Source, _: int) -> Drawn | None:
    return _changed(of, lambda q, x: 0.0 if _may_vanish(q) else x)


def _denormal(of: Source, _: int) -> Drawn | None:
    if _steps_angles(of):
        return None  # parts of a step fall below the smallest float one after another
    tiny = DENORMAL[of.precision.name]
    return _changed(of, lambda q, x: x * tiny if _may_vanish(q) else x)


def _steps_angles(of: Source) -> bool:
    """Tell whether steps in time are wanted of a state that has angles, whose rates are sums."""
    moves = any(wanted.startswith("step_") for wanted in of.mechanism.scene.wanted)
    return moves and any(q.unit == "rad" for q in of.mechanism.vocabulary.states)


def _may_vanish(q: Quantity) -> bool:
    low, high = q.ends
    within = low <= 0 <= high
    return not q.is_quaternion and within


def _half_turn(of: Source, number: int) -> Drawn | None:
    attitudes = [q.components for q in varying(of.mechanism) if q.is_quaternion]
    turn = [of.held(x) for x in HALF_TURNS[number % len(HALF_TURNS)]]
    turned = {name: x for parts in attitudes for name, x in zip(parts, turn, strict=True)}
    return _ordinary(of) | turned if attitudes else None


def _range_ends(of: Source, number: int) -> Drawn | None:
    """Return a sample with every coordinate at an end of its range: closest to a gimbal lock."""
    scalars = {q.name for q in varying(of.mechanism)}
    names = [c.name for c in of.mechanism.scene.coordinates if c.name in scalars]

    def change(q: Quantity, x: float) -> float:
        return _end(of, q, number >> names.index(q.name) & 1) if q.name in names else x

    return _changed(of, change) if names else None


def _extremes(of: Source, _: int) -> Drawn | None:
    """Return a sample with every varying value at an end of its range."""

    def change(q: Quantity, x: float) -> float:
        return x if q.is_quaternion else _end(of, q, of.dice.randrange(2))

    return _changed(of, change)


def _end(of: Source, q: Quantity, which: int) -> float:
    """Return the low (0) or high (1) end of a quantity's range, as a float inside it."""
    x = float(q.ends[which])
    inside = x * (1 - 4 * of.precision.unit_roundoff)
    return of.held(x) if abs(of.held(x)) <= abs(x) else of.held(inside)


CORNERS: dict[str, Callable[[Source, int], Drawn | None]] = {
    "large spin": _large_spin,
    "at rest": _at_rest,
    "denormal": _denormal,
    "half turn": _half_turn,
    "gimbal": _range_ends,
    "extremes": _extremes,
}
