"""The classic Runge-Kutta step as loops over its stages and columns: small instead of fast.

Rates and the nonzeros of their Jacobian are worked out in one place, four times. Then one column
of derivatives after the other is carried forward through the stages, by a table of the pattern.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

from derive.motion.runge_kutta.system import System, pattern_of
from derive.program.arithmetic import FLOPS
from derive.program.program import Op, Program, Sparsity, operands_of, run

WEIGHTS = (1, 2, 2, 1)
SIXTH = Fraction(1, 6)
Arithmetic = Mapping[str, Callable[..., Any]]


@dataclass(frozen=True)
class Columns:
    """The derivatives that are carried: pattern of the rates' Jacobian and of the step's.

    first : which of the rates' columns the first of the step's is
    """

    rates: Sparsity
    step: Sparsity
    first: int


@dataclass(frozen=True)
class Compact:
    """A step in loops.

    names    : the components of all states
    rate     : program of the rates, and of the nonzeros of their Jacobian if there are ``columns``
    attitude : where the quaternion stands among the states, None if there is none
    unrolled : the same step without loops, for what has none
    """

    names: tuple[str, ...]
    rate: Program
    columns: Columns | None
    attitude: int | None
    unrolled: Program

    def count(self) -> dict[str, int]:
        """Return how often each operator is used."""
        return dict(sorted(_uses(self).items()))

    def flops(self) -> int:
        """Return the number of + - * / in the operations."""
        return sum(times for operator, times in _uses(self).items() if operator in FLOPS)

    def operands(self) -> set[str]:
        """Return the names that the operations refer to."""
        return operands_of(self.rate.ops, self.rate.results) | {*self.names, "time_step"}

    def run(self, arithmetic: Arithmetic, known: dict[str, Any]) -> list[Any]:
        """Return the results in an arithmetic, from the inputs by name: as the C does it."""
        now = _Run(self, arithmetic, known)
        stages, after = now.stages()
        columns = self.columns
        if columns is None:
            return after
        found, ends = list(after), columns.step.colind
        for k in range(len(columns.step.columns)):
            moved = now.column(columns, columns.first + k, stages)
            moved = now.on_the_sphere(moved, after)
            found += [moved[i] for i in columns.step.row[ends[k] : ends[k + 1]]]
        return found


def compact(system: System, step: Program) -> Program:
    """Return ``step``, a classic step of ``system``, in loops; of a tangent space as it is."""
    columns, rate = None, system.rate
    if step.sparsity:
        own = step.sparsity["jacobian"]
        if not {*own.columns} <= {*system.columns}:
            return step
        columns = Columns(pattern_of(system), own, system.columns.index(own.columns[0]))
        rate = system.slopes or rate
    starts = [place.start for place in system.quaternions]
    loops = Compact(system.names, rate, columns, starts[0] if starts else None, step)
    results = tuple(c for q in step.outputs for c in q.components)
    return replace(step, ops=(), results=results, loops=loops)


def _uses(loops: Compact) -> Counter[str]:
    """Return how often each operator is used, as ``run`` and the C do it."""
    n, columns = len(loops.names), loops.columns
    found = Counter({"mul": 2 + 9 * n, "add": 9 * n})
    for op in loops.rate.ops:
        if isinstance(op, Op):
            found[op.operator] += len(WEIGHTS)
    if loops.attitude is not None:
        found.update({"mul": 8, "add": 4, "div": 1, "sqrt": 1})
    if columns is None:
        return found
    each = 4 * len(columns.rates.row) + 9 * n
    each_on_sphere = Counter({"mul": 12, "add": 4, "sub": 4} if loops.attitude is not None else {})
    for _ in columns.step.columns:
        found.update({"mul": each, "add": each})
        found.update(each_on_sphere)
    return found


@dataclass
class _Run:
    """A run of a step: its loops, what operators mean, what is known by name."""

    loops: Compact
    table: Arithmetic
    known: dict[str, Any]
    scale: Any = None

    def add(self, a: Any, b: Any) -> Any:
        return self.table["add"](a, b)

    def mul(self, a: Any, b: Any) -> Any:
        return self.table["mul"](a, b)

    def number(self, q: Fraction | int) -> Any:
        return self.table["number"](Fraction(q))

    @cached_property
    def parts(self) -> list[Any]:
        """Return the parts of the step that the stages lead over, then the sixth of it."""
        h = self.known["time_step"]
        half = self.mul(self.number(Fraction(1, 2)), h)
        return [half, half, h, h, self.mul(self.number(SIXTH), h)]

    def stages(self) -> tuple[list[list[Any]], list[Any]]:
        """Return the nonzeros of the Jacobians at the stages, and the state after the step."""
        names, slopes = self.loops.names, list[list[Any]]()
        start = [self.known[name] for name in names]

        def rates(_: int, state: Sequence[Any]) -> list[Any]:
            given = self.known | dict(zip(names, state, strict=True))
            inputs = [given[c] for q in self.loops.rate.inputs for c in q.components]
            found = run(self.loops.rate, self.table, inputs)
            slopes.append(found[len(names) :])
            return found[: len(names)]

        after = self._through(start, rates)
        return slopes, self._unit(after)

    def column(self, columns: Columns, place: int, slopes: Sequence[Sequence[Any]]) -> list[Any]:
        """Return the derivatives by one of the rates' columns, before the attitude's length."""
        n, pattern = len(self.loops.names), columns.rates
        unit = [self.number(int(i == place)) for i in range(len(pattern.columns))]

        def change(stage: int, moved: Sequence[Any]) -> list[Any]:
            found = [self.number(0)] * n
            every = [*moved, *unit[n:]]
            for entry, (i, k) in zip(slopes[stage], pattern.places(), strict=True):
                found[i] = self.add(found[i], self.mul(entry, every[k]))
            return found

        return self._through(unit[:n], change)

    def _through(
        self, start: Sequence[Any], rates: Callable[[int, Sequence[Any]], list[Any]]
    ) -> list[Any]:
        """Return what ``start`` becomes: start + (k1 + 2 k2 + 2 k3 + k4) h / 6."""
        *parts, sixth = self.parts
        now, total = list(start), [self.number(0)] * len(start)
        for stage, part in enumerate(parts):
            found, weight = rates(stage, now), self.number(WEIGHTS[stage])
            total = [self.add(t, self.mul(weight, k)) for t, k in zip(total, found, strict=True)]
            now = [self.add(y, self.mul(part, k)) for y, k in zip(start, found, strict=True)]
        return [self.add(y, self.mul(sixth, t)) for y, t in zip(start, total, strict=True)]

    def _unit(self, after: list[Any]) -> list[Any]:
        """Return the state with its attitude made of length one."""
        place = self.loops.attitude
        if place is None:
            return after
        q = after[place : place + 4]
        self.scale = self.table["div"](self.number(1), self.table["sqrt"](self._dot(q, q)))
        return [*after[:place], *(self.mul(x, self.scale) for x in q), *after[place + 4 :]]

    def on_the_sphere(self, moved: list[Any], after: Sequence[Any]) -> list[Any]:
        """Return derivatives without what would change the attitude's length."""
        place = self.loops.attitude
        if place is None:
            return moved
        q = after[place : place + 4]
        d = [self.mul(x, self.scale) for x in moved[place : place + 4]]
        along = self._dot(q, d)
        d = [self.table["sub"](x, self.mul(y, along)) for x, y in zip(d, q, strict=True)]
        return [*moved[:place], *d, *moved[place + 4 :]]

    def _dot(self, a: Sequence[Any], b: Sequence[Any]) -> Any:
        total = self.number(0)
        for x, y in zip(a, b, strict=True):
            total = self.add(total, self.mul(x, y))
        return total
