"""Ranges of what a function divides by, or takes the root of, that keep away from zero: proved.

Ranges are cut into as many parts as that takes, far more than a tool for C is given. A divisor is
looked at alone: of the angles that it rests on, and of divisors before it, ranges stand for what
they are made of, so that the same divisor of each stage of a step is as easy as that of a rate.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from derive.library.library import Library
from derive.program.precision import Precision
from derive.program.program import Op, Program, component_names
from derive.program.run import run, run_lines
from derive.verify.operators import Column
from derive.verify.proved.enclosed import enclosed
from derive.verify.proved.ranges import Interval
from derive.verify.proved.sphere import near_the_sphere
from derive.verify.proved.traits import Traits, traits
from derive.verify.proved.unfolded import Operation, Recorder, Spot, pruned

WAVES = ("sin", "cos")
DIVIDES = ("div", "sqrt")
ANGLES = 32
"""Pieces of an angle before anything is cut where the worst of them is: sines are not linear."""
LOOKED_AT = 1_500_000_000
"""Operations over a box that are spent on the divisors of a function at most."""
NEAR = 1 / 8
"""Of the value nearest to zero that is met: parts are cut until none may be nearer than that."""
AT_ONCE = 1 << 14


@dataclass(frozen=True)
class Divisor:
    """A value of a function by its name, and between which floats it is wherever it is called."""

    name: str
    low: float
    high: float


@dataclass
class Work:
    """What is left to spend."""

    left: int = LOOKED_AT


def divisors(
    library: Library,
    function: Program,
    boxes: Mapping[str, tuple[float, float]],
    precision: Precision,
) -> tuple[Divisor, ...]:
    """Return the divisors of a function whose ranges are proved, in its order.

    boxes : of parameters and of the function's other inputs, the ends by component
    It ends before the first that is not: what follows rests on it.
    """
    steps, by_name = _recorded(library, function, precision)
    quaternions = [q.components for q in function.inputs if q.is_quaternion]
    at = Walk(steps, dict(boxes), quaternions, precision, Work())
    found = list[Divisor]()
    for name, place in by_name.items():
        ends = at.proved(place)
        if ends is None:
            break
        found.append(Divisor(name, *ends))
    return tuple(found)


def _recorded(
    library: Library, function: Program, precision: Precision
) -> tuple[list[Operation], dict[str, int]]:
    """Return all that a function does, and where what it divides by stands, by its name in C."""
    recorder = Recorder(precision.bits, "pairs")
    parameters = [c for q in library.setup.inputs for c in q.components]
    made = run(library.setup, recorder.arithmetic(), list(map(recorder.given, parameters)))
    constants = dict(zip(component_names(library.setup), map(recorder.rounded, made), strict=True))
    recorder.origin = function.arithmetic
    names = [c for q in function.inputs for c in q.components]
    known: dict[str, Spot] = {n: constants.get(n) or recorder.given(n) for n in names}
    lines = [op for op in function.ops if isinstance(op, Op)]
    straight = len(lines) == len(function.ops) and not function.numbers
    run_lines(lines if straight else (), recorder.arithmetic(), known)
    asked = (op.operands[-1] for op in lines if straight and op.operator in DIVIDES)
    return recorder.steps, {o: known[o].index for o in asked if isinstance(o, str)}


@dataclass(frozen=True)
class Walk:
    """A function whose divisors are looked at in order; steps that are done with are given."""

    steps: list[Operation]
    boxes: dict[str, tuple[float, float]]
    quaternions: Sequence[Sequence[str]]
    precision: Precision
    work: Work

    def proved(self, place: int) -> tuple[float, float] | None:
        """Return the range of a divisor, which stands for it from now on, None if none is found."""
        if self.steps[place].origin == "given":
            return None
        for angle in self._angles(place):
            ends = self._enclosed(angle)
            if not np.all(np.isfinite(ends)):
                return None
            self._stands_for(angle, ends)
        found = self._away_from_zero(place)
        if found is not None:
            self._stands_for(place, found)
        return found

    def _stands_for(self, place: int, ends: tuple[float, float]) -> None:
        name = f"at {place}"
        self.steps[place] = Operation("given", (), "given", name=name)
        self.boxes[name] = ends

    def _angles(self, place: int) -> Iterator[int]:
        """Yield the angles that a value rests on and that are no inputs, in order."""
        needed = {place}
        for n in range(place, -1, -1):
            if n in needed:
                needed.update(self.steps[n].operands)
        own = [self.steps[n] for n in sorted(needed) if self.steps[n].origin == "working"]
        angles = {o for step in own if step.operator in WAVES for o in step.operands}
        yield from (n for n in sorted(angles) if self.steps[n].operator != "given")

    def _enclosed(self, place: int) -> tuple[float, float]:
        """Return the range of a value over the whole box."""
        cells = self._cells(place, 1)
        low, high = cells.ranges(*cells.whole)
        return float(low.min()), float(high.max())

    def _cells(self, place: int, pieces: int) -> "Slivers":
        """Return what looks at parts of the box for one value."""
        of = traits(pruned(self.steps, [place]), self.precision, self.quaternions)
        names = tuple(s.name for s in of.trace.steps if s.name)
        waves = [s.operands[0] for s in of.trace.steps if s.operator in WAVES]
        angles = {of.trace.steps[n].name for n in waves} & {*names}
        low, high = (np.array([[self.boxes[n][k]] for n in names]).reshape(-1, 1) for k in (0, 1))
        for n in sorted(angles):
            edges = np.linspace(*self.boxes[n], 1 + max(1, int(pieces ** (1 / len(angles)))))
            count, k = low.shape[1], names.index(n)
            low, high = (np.repeat(x, len(edges) - 1, axis=1) for x in (low, high))
            low[k], high[k] = np.tile(edges[:-1], count), np.tile(edges[1:], count)
        whole = tuple(tuple(map(names.index, each)) for each in of.quaternions)
        return Slivers(of, names, (low, high), whole)

    def _away_from_zero(self, place: int) -> tuple[float, float] | None:
        """Return the range of a value that is found to keep one sign, None if it is not."""
        cells, ends, nearest = self._cells(place, ANGLES), (np.inf, -np.inf), np.inf
        low, high = cells.whole
        while low.shape[1]:
            low, high = near_the_sphere(cells.quaternions, low, high)
            (least, most), middle = cells.ranges(low, high), (low + high) / 2
            at = np.abs(cells.ranges(middle, middle)[0])
            nearest = min(nearest, float(at.min(initial=np.inf)))
            self.work.left -= cells.price * low.shape[1] * (2 + 2 * len(cells.names))
            sure = (least > NEAR * nearest) | (most < -NEAR * nearest)
            ends = (min(ends[0], float(least[sure].min(initial=np.inf))),
                    max(ends[1], float(most[sure].max(initial=-np.inf))))  # fmt: skip
            if self.work.left < 0 or ends[0] <= 0 <= ends[1]:
                return None
            low, high = cells.halved(low[:, ~sure], high[:, ~sure], NEAR * nearest)
        return ends if ends[0] <= ends[1] else None


@dataclass(frozen=True)
class Slivers:
    """Parts of a box, and the range of one value in them."""

    of: Traits
    names: tuple[str, ...]
    whole: tuple[Column, Column]
    quaternions: tuple[tuple[int, ...], ...]

    @property
    def price(self) -> int:
        """Return what a look at one part costs."""
        return len(self.of.trace.steps)

    def ranges(self, low: Column, high: Column) -> Interval:
        """Return the range of the value in parts."""
        each = [np.zeros((2, 0))]
        for n in range(0, low.shape[1], AT_ONCE):
            own = slice(n, n + AT_ONCE)
            boxes = {name: (low[k, own], high[k, own]) for k, name in enumerate(self.names)}
            with np.errstate(all="ignore"):
                found = enclosed(self.of, boxes, low[:, own].shape[1])
            each.append(np.array(found.ranges[self.of.trace.results[0]]))
        least, most = np.concatenate(each, axis=1)
        return least, most

    def halved(self, low: Column, high: Column, away: float) -> tuple[Column, Column]:
        """Return parts cut in two, each where that leaves the least nearer to zero than that."""
        count, middle = low.shape[1], (low + high) / 2
        best, along = np.full(count, np.inf), np.zeros(count, int)
        for k in range(len(self.names)):
            over = np.maximum(
                *(self._beyond(*half, away) for half in _halves(low, high, middle, k))
            )
            over = np.where(low[k] < high[k], over, np.inf)
            along, best = np.where(over < best, k, along), np.minimum(over, best)
        at = along, np.arange(count)
        lower, upper = high.copy(), low.copy()
        lower[at], upper[at] = middle[at], middle[at]
        return np.concatenate([low, upper], axis=1), np.concatenate([lower, high], axis=1)

    def _beyond(self, low: Column, high: Column, away: float) -> Column:
        """Return how far the value may be from all that is on one side, and away from zero."""
        least, most = self.ranges(low, high)
        return np.asarray(np.maximum(np.minimum(-least, most) + away, 0.0))


def _halves(low: Column, high: Column, middle: Column, k: int) -> Iterator[tuple[Column, Column]]:
    """Yield the lower and the upper halves of parts along a side."""
    lower, upper = high.copy(), low.copy()
    lower[k], upper[k] = middle[k], middle[k]
    yield low, lower
    yield upper, high
