"""A program: named inputs, straight-line operations, named outputs.

This is the only thing the derivation hands to the printers. SymPy stops before it: an operand
is the name of an earlier value or an exact number.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal

Operand = str | Fraction

FLOPS = ("add", "sub", "mul", "div")


@dataclass(frozen=True)
class Quantity:
    """One input or output: what it is called, measured in, seen from, and may range over."""

    name: str
    components: tuple[str, ...]
    shape: tuple[int, ...]
    unit: str
    frame: str
    low: Fraction | None
    high: Fraction | None
    meaning: str


@dataclass(frozen=True)
class Sparsity:
    """The pattern of a matrix in compressed-column order, with its row and column labels."""

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    colind: tuple[int, ...]
    row: tuple[int, ...]

    def places(self) -> tuple[tuple[int, int], ...]:
        """Return (row, column) of each nonzero, in storage order."""
        return tuple(
            (self.row[k], column)
            for column in range(len(self.columns))
            for k in range(self.colind[column], self.colind[column + 1])
        )


@dataclass(frozen=True)
class Op:
    """``result = operator(*operands)``."""

    result: str
    operator: str
    operands: tuple[Operand, ...]


@dataclass(frozen=True)
class Repeat:
    """``carried`` begin as ``start`` and become ``then`` after each pass, until ``done`` is true.

    A loop that means the same unrolled: there are never more than ``passes`` passes, and what is
    done stays as it is.
    """

    carried: tuple[str, ...]
    start: tuple[Operand, ...]
    ops: tuple[Op, ...]
    then: tuple[Operand, ...]
    done: Operand | None
    passes: int


Line = Op | Repeat


@dataclass(frozen=True)
class Program:
    """A function without branches, ready for any arithmetic; its loops have an end known before.

    ``results`` are the values of the outputs' components in order; ``sparsity`` gives the pattern
    of an output that holds the nonzeros of a matrix; ``positive`` are results of ``ops`` that
    must be above zero for the inputs to be admissible. In ``arithmetic`` "pairs" every operation
    works on pairs of floats, and results are rounded once.
    """

    name: str
    says: str
    inputs: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    ops: tuple[Line, ...]
    results: tuple[Operand, ...]
    steps: tuple[str, ...] = ()
    assumptions: tuple[str, ...] = ()
    sparsity: Mapping[str, Sparsity] | None = None
    positive: tuple[Operand, ...] = ()
    arithmetic: Literal["working", "pairs"] = "working"

    def count(self) -> dict[str, int]:
        """Return how often each operator is used at most, every pass of a loop counted."""
        found: dict[str, int] = {}
        for op, times in every_op(self.ops):
            found[op.operator] = found.get(op.operator, 0) + times
        return dict(sorted(found.items()))

    def flops(self) -> int:
        """Return the number of + - * / in the operations, every pass of a loop counted."""
        return sum(times for op, times in every_op(self.ops) if op.operator in FLOPS)


def every_op(lines: Sequence[Line]) -> Iterator[tuple[Op, int]]:
    """Yield each operation with how often it is run at most."""
    for line in lines:
        if isinstance(line, Repeat):
            yield from ((op, line.passes) for op in line.ops)
        else:
            yield line, 1


def run(
    program: Program, arithmetic: Mapping[str, Callable[..., Any]], values: Sequence[Any]
) -> list[Any]:
    """Run ``program`` in an arithmetic: floats, exact fractions, intervals, CasADi.

    ``values`` are the input components in declared order. The arithmetic maps each operator,
    and "number" for constants, to a callable; loops need its "select" and "either".
    """
    names = [name for quantity in program.inputs for name in quantity.components]
    known = dict(zip(names, values, strict=True))

    def value(operand: Operand) -> Any:
        return known[operand] if isinstance(operand, str) else arithmetic["number"](operand)

    def operate(ops: Sequence[Op]) -> None:
        for op in ops:
            known[op.result] = arithmetic[op.operator](*map(value, op.operands))

    def repeat(loop: Repeat) -> None:
        known.update(zip(loop.carried, map(value, loop.start), strict=True))
        done: Any = None
        for _ in range(loop.passes):
            operate(loop.ops)
            new = [value(operand) for operand in loop.then]
            if done is not None:
                old = [known[name] for name in loop.carried]
                new = [
                    arithmetic["select"](done, o, n) for o, n in zip(old, new, strict=True)
                ]
            known.update(zip(loop.carried, new, strict=True))
            if loop.done is not None:
                now = value(loop.done)
                done = now if done is None else arithmetic["either"](done, now)

    for line in program.ops:
        if isinstance(line, Repeat):
            repeat(line)
        else:
            operate((line,))
    return [value(result) for result in program.results]


@dataclass(frozen=True)
class Measurement:
    """The error of one output of one function in one precision, in ulps of its largest term."""

    function: str
    precision: str
    output: str
    median: float
    worst: float
    sample: int
    samples: int
