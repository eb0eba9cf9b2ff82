"""Ranges of what a function divides by, or takes the root of, that keep away from zero: proved.

Ranges are cut into as many parts as that takes, far more than a tool for C is given. A divisor is
looked at alone: of the angles that it rests on, and of divisors before it, ranges stand for what
they are made of, so that the same divisor of each stage of a step is as easy as that of a rate.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from math import prod

import numpy as np

from derive.library.library import Library
from derive.program.precision import Precision
from derive.program.program import Op, Program, component_names
from derive.program.run import run, run_lines
from derive.verify.proved.scaled import Scaled, scaling
from derive.verify.proved.slivers import Slivers, choosing
from derive.verify.proved.sphere import near_the_sphere
from derive.verify.proved.traits import choice_name, traits
from derive.verify.proved.unfolded import Operation, Recorder, Spot, pruned

WAVES = ("sin", "cos")
DIVIDES = ("div", "sqrt")
ANGLES = 32
"""Pieces of an angle before anything is cut where the worst of them is: sines are not linear."""
LOOKED_AT = 1_500_000_000
"""Operations over a box that are spent on the divisors of a function at most."""
NEAR = 1 / 8
"""Of the value nearest to zero that is met: parts are cut until none may be nearer than that."""
NEVER_LESS = ("sqrt", "abs")
"""What gives no number below zero."""
NEXT = 2.0**-16
"""Far more than rounding adds to products and sines, relative to them."""


@dataclass(frozen=True)
class ProvedRange:
    """A value of a function by its name, and between which floats it is wherever it is called.

    quotient : whether it is one whose divisor, by itself, may be as near to zero as it will
    """

    name: str
    low: float
    high: float
    quotient: bool = False


@dataclass
class Work:
    """What is left to spend."""

    left: int = LOOKED_AT


def divisors(
    library: Library,
    function: Program,
    boxes: Mapping[str, tuple[float, float]],
    precision: Precision,
) -> tuple[ProvedRange, ...]:
    """Return the divisors of a function whose ranges are proved, in its order.

    boxes : of parameters and of the function's other inputs, the ends by component
    It ends before the first that is not: what follows rests on it.
    """
    return _walked(library, function, boxes, precision)[1]


def ranges_of_results(
    library: Library,
    function: Program,
    boxes: Mapping[str, tuple[float, float]],
    precision: Precision,
) -> tuple[ProvedRange, ...]:
    """Return the ranges of a function's results, its divisors' known; boxes as of ``divisors``."""
    at, _, by_name = _walked(library, function, boxes, precision)
    names = [str(o) for o in function.results if o in by_name]
    return tuple(ProvedRange(name, *at.enclosed(by_name[name])) for name in names)


def _walked(
    library: Library,
    function: Program,
    boxes: Mapping[str, tuple[float, float]],
    precision: Precision,
) -> "tuple[Walk, tuple[ProvedRange, ...], dict[str, int]]":
    """Return a function with divisors that are done with, these, and where values stand by name."""
    steps, divided, by_name = _recorded(library, function, precision)
    quaternions = [q.components for q in function.inputs if q.is_quaternion]
    at = Walk(steps, dict(boxes), quaternions, precision, Work())
    found, sized = dict[str, ProvedRange](), list[Scaled]()
    for op in divided:
        name = str(op.operands[-1])
        if name in found or at.is_root_of_none_below(op, by_name[name]):
            continue
        sized += [] if sized else scaling(steps, by_name[name], at.boxes, precision)
        told = _of_any_size(sized, op, by_name) or at.quotient(op, by_name)
        ends = None if told else at.proved(by_name[name])
        if not (told or ends):
            break
        told = told or ProvedRange(name, *(ends or ()))
        at.stands_for(by_name[told.name], (told.low, told.high))
        found[told.name] = told
    return at, tuple(found.values()), by_name


def _of_any_size(sized: Sequence[Scaled], op: Op, places: Mapping[str, int]) -> ProvedRange | None:
    """Return the range of a divisor that is the same for values of any size, or its quotient's."""
    for each in sized:
        name = str(op.operands[-1])
        ends = each.ends(places[name])
        if ends and not ends[0] <= 0 <= ends[1]:
            return ProvedRange(name, *ends)
        ends = each.ends(places[op.result]) if op.operator == "div" else None
        if ends:
            return ProvedRange(op.result, *ends, quotient=True)
    return None


def _recorded(
    library: Library, function: Program, precision: Precision
) -> tuple[list[Operation], list[Op], dict[str, int]]:
    """Return all that a function does, what of it divides, and where values stand by name in C."""
    recorder = Recorder(precision.bits, "pairs")
    parameters = [c for q in library.setup.inputs for c in q.components]
    made = run(library.setup, recorder.arithmetic(), list(map(recorder.given, parameters)))
    constants = dict(zip(component_names(library.setup), map(recorder.rounded, made), strict=True))
    recorder.origin = function.arithmetic
    names = [c for q in function.inputs for c in q.components]
    known: dict[str, Spot] = {n: constants.get(n) or recorder.given(n) for n in names}
    lines = [op for op in function.ops if isinstance(op, Op)]
    if len(lines) < len(function.ops) or function.numbers:
        return recorder.steps, [], {}
    run_lines(lines, recorder.arithmetic(), known)
    asked = [op for op in lines if op.operator in DIVIDES and isinstance(op.operands[-1], str)]
    return recorder.steps, asked, {name: spot.index for name, spot in known.items()}


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
            ends = self.enclosed(angle)
            if not np.all(np.isfinite(ends)):
                return None
            self.stands_for(angle, ends)
        found = self._away_from_zero(place)
        if found is not None:
            self.stands_for(place, found)
        return found

    def is_root_of_none_below(self, op: Op, place: int) -> bool:
        """Tell whether a root is of what is never below zero, for any floats."""
        return op.operator == "sqrt" and self._never_below(place)

    def _never_below(self, place: int) -> bool:
        step = self.steps[place]
        if step.operator == "mul" and step.operands[0] == step.operands[1]:
            return True
        every = step.operator in ("add", "mul") and all(map(self._never_below, step.operands))
        return every or step.operator in NEVER_LESS or (step.number or -1) > 0

    def quotient(self, op: Op, places: Mapping[str, int]) -> ProvedRange | None:
        """Return the range of a sine by what its angle is a multiple of, None of other quotients.

        The divisor is above zero, or a number stands for it. What underflow takes of the angle is
        next to nothing beside the least divisor there is.
        """
        if op.operator != "div" or not isinstance(op.operands[0], str):
            return None
        above, below = (places[str(o)] for o in op.operands)
        size = self._guarded(below)
        factors = self._factors(self.steps[above].operands[0]) if self._is_sine(above) else []
        if size is None or factors.count(size) != 1:
            return None
        ends = [self.enclosed(n) for n in factors if n != size]
        most = prod(float(np.max(np.abs(e))) for e in ends)
        least = float(np.finfo(self.precision.dtype).smallest_subnormal)
        smallest = np.sqrt(least) if self.steps[size].operator == "sqrt" else least
        reach = most * (1 + NEXT) + (len(ends) + 2) * max(1.0, most) * float(least / smallest)
        return ProvedRange(op.result, -reach, reach, quotient=True) if np.isfinite(reach) else None

    def _is_sine(self, place: int) -> bool:
        return self.steps[place].operator == "sin"

    def _guarded(self, place: int) -> int | None:
        """Return the value that is taken if it is above zero, a number above it if not."""
        step = self.steps[place]
        if step.operator != "select":
            return None
        asked, _, other = (self.steps[o] for o in step.operands)
        compared = asked.operator == "less" and asked.operands[1] == step.operands[1]
        from_zero = compared and self.steps[asked.operands[0]].number == 0
        never_less = from_zero and self.steps[step.operands[1]].operator in NEVER_LESS
        return step.operands[1] if never_less and (other.number or 0) > 0 else None

    def _factors(self, place: int) -> list[int]:
        """Return what a value is the product of."""
        step = self.steps[place]
        if step.operator != "mul":
            return [place]
        return [n for o in step.operands for n in self._factors(o)]

    def stands_for(self, place: int, ends: tuple[float, float]) -> None:
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

    def enclosed(self, place: int) -> tuple[float, float]:
        """Return the range of a value over the whole box."""
        cells = self._cells(place, 1)
        low, high = cells.ranges(*cells.whole)
        return float(low.min()), float(high.max())

    def _cells(self, place: int, pieces: int) -> Slivers:
        """Return what looks at parts of the box for one value."""
        of = traits(pruned(self.steps, [place]), self.precision, self.quaternions)
        names = tuple(s.name for s in of.trace.steps if s.name)
        free = tuple(map(choice_name, choosing(of)))
        waves = [s.operands[0] for s in of.trace.steps if s.operator in WAVES]
        angles = {of.trace.steps[n].name for n in waves} & {*names}
        outcomes = np.array([*product((0.0, 1.0), repeat=len(free))]).T
        ends = np.array([self.boxes[n] for n in names]).reshape(-1, 2, 1)
        each = (np.repeat(ends[:, k], outcomes.shape[1], axis=1) for k in (0, 1))
        low, high = (np.concatenate([end, outcomes]) for end in each)
        for n in sorted(angles):
            edges = np.linspace(*self.boxes[n], 1 + max(1, int(pieces ** (1 / len(angles)))))
            count, k = low.shape[1], names.index(n)
            low, high = (np.repeat(x, len(edges) - 1, axis=1) for x in (low, high))
            low[k], high[k] = np.tile(edges[:-1], count), np.tile(edges[1:], count)
        whole = tuple(tuple(map(names.index, each)) for each in of.quaternions)
        return Slivers(of, (*names, *free), (low, high), whole)

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
