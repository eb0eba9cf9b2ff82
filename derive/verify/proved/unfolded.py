"""A function as a list of operations from parameters and inputs on: set-up, rounding, its own.

It is recorded by a run (``program.run``) whose values are places in the list, so that loops are
walked and every program that can be run can be recorded.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial
from typing import Literal

from derive.library.library import Library
from derive.program.arithmetic import OPERATORS
from derive.program.program import Program, component_names
from derive.program.run import run
from derive.scene.formula import Arithmetic

NEUTRAL = {"add": 0, "sub": 0, "mul": 1, "div": 1}
Origin = Literal["given", "pairs", "rounded", "working"]
"""What a value is: given, made on pairs of floats, rounded from one, made in floats."""


@dataclass(frozen=True)
class Operation:
    """An operation on earlier places; a number has its value, something given its name."""

    operator: str
    operands: tuple[int, ...]
    origin: Origin
    number: Fraction | None = None
    name: str = ""


@dataclass(frozen=True)
class Spot:
    """A place in the list; of a number its value too, for who asks for the unit roundoff."""

    index: int
    value: Fraction | None = None

    def __float__(self) -> float:
        return float(self.value or 0)


@dataclass
class Recorder:
    """Operations as they come, each number and each operation on the same operands once."""

    bits: int
    origin: Origin
    steps: list[Operation] = field(default_factory=list)
    places: dict[Operation, Spot] = field(default_factory=dict)

    def add(self, step: Operation) -> Spot:
        """Return the place of a step."""
        if step not in self.places:
            self.places[step] = Spot(len(self.steps), step.number)
            self.steps.append(step)
        return self.places[step]

    def given(self, name: str) -> Spot:
        """Return the place of something given."""
        return self.add(Operation("given", (), "given", name=name))

    def number(self, q: Fraction) -> Spot:
        """Return the place of a number."""
        return self.add(Operation("number", (), self.origin, number=q))

    def rounded(self, place: Spot) -> Spot:
        """Return the place of a pair that is rounded to a float; what is a float stays."""
        step = self.steps[place.index]
        if step.operator == "given":
            return place
        return self.add(Operation("rounded", (place.index,), "rounded"))

    def done(self, operator: str, *operands: Spot) -> Spot:
        """Return the place of an operation; what adds nothing, or takes once, does nothing."""
        neutral = NEUTRAL.get(operator)
        if neutral is not None:
            first, second = operands
            if second.value == neutral:
                return first
            if first.value == neutral and operator in ("add", "mul"):
                return second
            if operator == "mul" and 0 in (first.value, second.value):
                return self.number(Fraction(0))
        return self.add(Operation(operator, tuple(o.index for o in operands), self.origin))

    def arithmetic(self) -> Arithmetic:
        """Return what a program is run in to be recorded."""
        own: dict[str, Callable[..., Spot]] = {n: partial(self.done, n) for n in OPERATORS}
        fixed = {n: row.number for n, row in OPERATORS.items() if row.number is not None}
        numbers = {n: partial(self.number, of(self.bits)) for n, of in fixed.items()}
        return {**own, **numbers, "number": self.number}


@dataclass(frozen=True)
class Unfolded:
    """All that a function does, and where its results stand."""

    steps: tuple[Operation, ...]
    results: tuple[int, ...]


def unfolded(library: Library, program: Program, bits: int) -> Unfolded:
    """Return all that a function does from parameters and inputs on, set-up's part included."""
    recorder = Recorder(bits, "pairs")
    parameters = [c for q in library.setup.inputs for c in q.components]
    made = run(library.setup, recorder.arithmetic(), list(map(recorder.given, parameters)))
    constants = dict(zip(component_names(library.setup), map(recorder.rounded, made), strict=True))
    recorder.origin = program.arithmetic
    names = [c for q in program.inputs for c in q.components]
    given = [constants[c] if c in constants else recorder.given(c) for c in names]
    results = run(program, recorder.arithmetic(), given)
    if program.arithmetic == "pairs":
        results = list(map(recorder.rounded, results))
    return pruned(recorder.steps, [place.index for place in results])


def pruned(steps: Sequence[Operation], results: Sequence[int]) -> Unfolded:
    """Return a trace of what results rest on alone."""
    needed = set(results)
    for index in range(len(steps) - 1, -1, -1):
        if index in needed:
            needed.update(steps[index].operands)
    place = {index: n for n, index in enumerate(sorted(needed))}
    kept = [
        Operation(s.operator, tuple(place[o] for o in s.operands), s.origin, s.number, s.name)
        for s in (steps[index] for index in sorted(needed))
    ]
    return Unfolded(tuple(kept), tuple(place[r] for r in results))
