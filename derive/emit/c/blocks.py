"""Blocks of a horizon's derivatives: their patterns, and where their entries come from.

A step's entries stand in one array: what is made at once, then a column for each change of what
all steps share. What a step has of its own has a block a step, on the diagonal; by what all steps
share blocks stand below each other or beside each other, and are summed where both are shared.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from textwrap import wrap

from derive.library.external import BY_LENGTH, BY_PARAMETERS, BY_STATE, StepDerivatives
from derive.motion.runge_kutta.dependence import rests_on
from derive.program.program import Program, Sparsity

LONGEST = 112
Entries = dict[tuple[int, int], int]


@dataclass(frozen=True)
class Sizes:
    """How many states, inputs and parameters there are."""

    states: int
    inputs: int
    parameters: int

    @property
    def own(self) -> int:
        """Return how many there are of states, inputs and the length of the step."""
        return self.states + self.inputs + 1

    def span(self, name: str) -> range:
        """Return where something stands among states, inputs, length and parameters."""
        first, held = self.states, self.states + self.inputs
        ends = {"x": (0, first), "u": (first, held), "time_step": (held, held + 1)}
        ends |= {"xn": (0, first), "parameters": (held + 1, held + 1 + self.parameters)}
        return range(*ends[name])


@dataclass(frozen=True)
class HorizonBlock:
    """A block that every step has, in compressed-column order, as C is told of it.

    down, across : whether each step has rows, and columns, of its own
    takes        : for each entry, its place among the step's entries
    """

    name: str
    rows: int
    columns: int
    down: bool
    across: bool
    colind: tuple[int, ...]
    row: tuple[int, ...]
    takes: tuple[int, ...]

    @property
    def way(self) -> str:
        """Return how C puts a step's entries into the matrix."""
        if self.across:
            return "put"
        return "put_below" if self.down else "put_sum"

    @property
    def pattern(self) -> str:
        """Return what C says where CasADi asks for the matrix's pattern."""
        many = " * STEPS"
        size = f"3 + {self.columns}{many * self.across}"
        size += f" + {len(self.row)}{many * (self.across or self.down)}"
        return f"{{ static casadi_int made[{size}]; return pattern(made, &{self.name}); }}"

    def declared(self) -> list[str]:
        """Return it as C; none of its arrays is empty, as C has it."""
        down, across = ("STEPS" if own else "1" for own in (self.down, self.across))
        own = f"{self.rows}, {down}, {self.columns}, {across}"
        found = [f"static const block {self.name} = {{{own},"]
        for values in (self.colind, self.row, self.takes):
            numbers = ", ".join(map(str, values or (0,)))
            found += wrap(f"(const int[]){{{numbers}}},", LONGEST)
        found[-1] = found[-1].removesuffix(",") + "};"
        return [found[0], *(f"    {line}" for line in found[1:])]


def first_entries(of: StepDerivatives, sizes: Sizes, names: list[str]) -> tuple[Entries, int]:
    """Return where d(state after)/d(what) stands among a step's entries, and their number.

    names : of the states and inputs, as the columns of the Jacobian call them
    """
    pattern: Sparsity = (of.jacobian.sparsity or {})["jacobian"]
    found: Entries = {}
    for at, (i, k) in enumerate(pattern.places()):
        if pattern.columns[k] in names:
            found[i, names.index(pattern.columns[k])] = at
    size = len(pattern.row)
    for name, by in ((BY_LENGTH, "time_step"), (BY_PARAMETERS, "parameters")):
        if name in of.first:
            found |= _columns(of.first[name], size, sizes.span(by))
            size += sizes.states * len(sizes.span(by))
    return found, size


def second_entries(of: StepDerivatives, sizes: Sizes) -> tuple[Entries, int]:
    """Return the same of the second derivatives of a weighed sum of the states after."""
    found: Entries = {}
    if of.lower is not None:
        pattern: Sparsity = (of.lower.sparsity or {})["hessian"]
        for at, (i, k) in enumerate(pattern.places()):
            found[i, k] = found[k, i] = at
        size = len(pattern.row)
        length = _columns(of.second[BY_LENGTH], size, sizes.span("time_step"))
    else:
        columns = _columns(of.second[BY_STATE], 0, range(sizes.own))
        size = sizes.own * (sizes.own - 1)
        last = sizes.own - 1
        found = {(i, k): at for (i, k), at in columns.items() if k < last and i < last}
        found = {(i, k): at for (i, k), at in found.items() if (k, i) in found}
        length = {(i, k): at for (i, k), at in columns.items() if k == last}
    found |= _both_ways(length)
    size += sizes.own
    if BY_PARAMETERS in of.second:
        own = _columns(of.second[BY_PARAMETERS], size, sizes.span("parameters"))
        found |= _both_ways({(i, k): at for (i, k), at in own.items() if i < sizes.own})
        found |= {(i, k): at for (i, k), at in own.items() if i >= sizes.own and (k, i) in own}
        size += sizes.parameters * (sizes.own + sizes.parameters)
    return found, size


def _both_ways(entries: Mapping[tuple[int, int], int]) -> Entries:
    return {place: at for (i, k), at in entries.items() for place in ((i, k), (k, i))}


def _columns(program: Program, start: int, columns: range) -> Entries:
    """Return where what a program gives along each change stands, column after column."""
    rows = len(program.results)
    if len(columns) == 1:
        some = [(i, 0) for i, r in enumerate(program.results) if r != Fraction(0)]
    else:
        rests = rests_on(program)
        some = [
            (i, k) for k in range(len(columns)) for i in range(rows) if f"change_{k}" in rests[i]
        ]
    return {(i, columns.start + k): start + k * rows + i for i, k in some}


def horizon_block(
    name: str, entries: Entries, rows: str, columns: str, sizes: Sizes
) -> HorizonBlock:
    """Return a block by some of what derivatives are taken of and by."""
    down, across = sizes.span(rows), sizes.span(columns)
    colind, row, takes = [0], list[int](), list[int]()
    for k in across:
        found = [(i, entries[i, k]) for i in down if (i, k) in entries]
        row += [i - down.start for i, _ in found]
        takes += [at for _, at in found]
        colind.append(len(row))
    own = ("x", "u", "xn")
    return HorizonBlock(
        name, len(down), len(across), rows in own, columns in own,
        tuple(colind), tuple(row), tuple(takes),
    )  # fmt: skip
