"""A program: named inputs, straight-line operations, named outputs.

This is the only thing the derivation hands to the printers. SymPy stops before it: an operand
is the name of an earlier value or an exact number.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any, Literal

from derive.program.arithmetic import FLOPS
from derive.program.indexed import Arrays, Even, Indexed, Integers, Loop, names_in, operators_in

Operand = str | Fraction
MATRIX = "jacobian"
"""What outputs are called that hold a Jacobian; no quantity of a scene may be called so."""

Role = Literal["value", "attitude", "constants", "plan", "remainder"]
"""What a quantity is for: a value of its own, be it an attitude, or made for others to read."""


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
    role: Role = "value"

    def __post_init__(self) -> None:
        """Refuse a range of one value: whatever is sampled on it would go unseen."""
        if self.low is not None and self.high is not None and self.low >= self.high:
            raise ValueError(f"quantity '{self.name}' ranges over {self.low} to {self.high} only")

    @property
    def is_quaternion(self) -> bool:
        """Tell whether this is an attitude, of length 1."""
        return self.role == "attitude"

    @property
    def is_value(self) -> bool:
        """Tell whether this has a value of its own, which a user may set."""
        return self.role in ("value", "attitude")

    @property
    def ends(self) -> tuple[Fraction, Fraction]:
        """Return the range that samples are drawn from.

        Raises ValueError for a quantity that has none.
        """
        if self.low is None or self.high is None:
            raise ValueError(f"quantity '{self.name}' has no range to draw samples from")
        return self.low, self.high


@dataclass(frozen=True)
class Sparsity:
    """The pattern of a matrix in compressed-column order, with its row and column labels."""

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    colind: tuple[int, ...]
    row: tuple[int, ...]

    @property
    def shape(self) -> tuple[int, int]:
        """Return how many rows and columns the matrix has."""
        return len(self.rows), len(self.columns)

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


Line = Op | Indexed


@dataclass(frozen=True)
class Precondition:
    """What set-up's parameters must keep: a value above zero, not below it, or within its range.

    status : what set-up returns if not        says : the rule in words, with its quantity
    ends   : of the range
    """

    status: int
    says: str
    value: Operand
    relation: Literal["positive", "not negative", "within"]
    ends: tuple[Fraction, ...] = ()


@dataclass(frozen=True)
class Singular:
    """Where a function has no value, in words, and the outputs that are infinite or no number."""

    where: str
    outputs: tuple[str, ...]


@dataclass(frozen=True)
class Program:
    """A function without branches, ready for any arithmetic; its loops have an end known before.

    ``results`` are the values of the outputs' components in order; ``sparsity`` gives the pattern
    of an output that holds the nonzeros of a matrix; ``rules`` are what ``ops`` find out about
    the inputs of set-up. ``singular`` are the places that comments warn of. In ``arithmetic``
    "pairs" every operation works on pairs of floats, and results are rounded once. ``free`` is what
    the slopes of an exact flow rest on (``motion.exact``), ``slopes`` a program with the same
    values, by operations that may be differentiated; ``unrolled`` one without loops over arrays.
    ``numbers`` are those that rest on the precision, by its bits: of a float, and of all else.
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
    rules: tuple[Precondition, ...] = ()
    arithmetic: Literal["working", "pairs"] = "working"
    singular: tuple[Singular, ...] = ()
    free: tuple[Operand, ...] = ()
    slopes: "Program | None" = None
    unrolled: "Program | None" = None
    numbers: Mapping[str, Mapping[int, Fraction]] = field(default_factory=dict)

    def makes(self, role: Role) -> bool:
        """Tell whether it is the function that makes what others read: constants, or a plan."""
        return any(q.role == role for q in self.outputs)

    @cached_property
    def count(self) -> dict[str, int]:
        """Return how often each operator is used at most, every turn of a loop counted."""
        return dict(sorted(Counter(_uses(self.ops, {}, {})).items()))

    def flops(self) -> int:
        """Return the number of + - * / in the operations, every turn of a loop counted."""
        return sum(times for operator, times in self.count.items() if operator in FLOPS)

    @property
    def has_arrays(self) -> bool:
        """Tell whether there are loops over places of arrays."""
        return any(isinstance(line, Arrays) for line in self.ops)


def _uses(lines: Sequence[Line], at: Mapping[str, int], tables: dict[str, Any]) -> Iterator[str]:
    """Yield the operator of each use that is made at most."""
    for line in lines:
        match line:
            case Op():
                yield line.operator
            case Loop() | Even():
                for turn in line.turns(at, tables):
                    yield from _uses(line.body, {**at, **turn}, tables)
            case Integers():
                tables[line.name] = line.values
            case _:
                yield from operators_in(line)


def every_op(lines: Sequence[Line]) -> Iterator[Op]:
    """Yield each operation, of a loop once."""
    for line in lines:
        if isinstance(line, Op):
            yield line
        elif isinstance(line, Loop | Even):
            yield from every_op(line.body)


def operands_of(lines: Sequence[Line], results: Sequence[Operand | None] = ()) -> set[str]:
    """Return the names that operations, loops and results refer to."""
    return {o for o in _operands(lines, results) if isinstance(o, str)}


def fixed_numbers(program: Program) -> tuple[Fraction, ...]:
    """Return the numbers that stand in a program, the largest first."""
    every = _operands(program.ops, program.results)
    return tuple(sorted((o for o in every if isinstance(o, Fraction)), key=abs, reverse=True))


def _operands(lines: Sequence[Line], results: Sequence[Operand | None] = ()) -> set[Operand | None]:
    found = set(results)
    for line in lines:
        match line:
            case Op():
                found |= {*line.operands}
            case Loop():
                found |= _operands(line.body, (*line.start, *line.then, line.done))
            case Even():
                found |= _operands(line.body)
            case _:
                found |= names_in(line)
    return found


def component_names(program: Program) -> list[str]:
    """Return the components of all outputs in order."""
    return [c for q in program.outputs for c in q.components]


def placed(quantities: Iterable[Quantity]) -> Iterator[tuple[Quantity, slice]]:
    """Yield quantities, and where the components of each stand among all of them."""
    start = 0
    for q in quantities:
        yield q, slice(start, start + len(q.components))
        start += len(q.components)


def read_by(program: Program) -> set[str]:
    """Return the names that a program's operations and results refer to."""
    return operands_of(program.ops, program.results)


@dataclass(frozen=True)
class Bound:
    """How far rounding moves an output at most on the declared ranges, in its unit: absolute.

    proved  : by ranges of all values; None if it is not        seen : the largest that was found
    assumed : what the proof rests on beside the ranges         why  : there is no proof
    """

    function: str
    precision: str
    output: str
    proved: float | None = None
    seen: float = 0.0
    assumed: tuple[str, ...] = ()
    why: str = ""


@dataclass(frozen=True)
class Measurement:
    """The error of one output of one function in one precision, in u of what it is counted in.

    within                  : the largest at samples of the declared ranges
    worst                   : the largest of all, at bodies and motions outside them too
    sample, kind            : number of the worst sample, and which kind of sample it is
    samples, searched, hard : how many were drawn on the ranges, searched from the worst, and hard
    bound                   : what is proved, absolute
    """

    function: str
    precision: str
    output: str
    median: float
    within: float
    worst: float
    sample: int
    kind: str
    samples: int
    searched: int
    hard: int
    bound: Bound | None = None
