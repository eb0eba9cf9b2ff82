"""Blocks of linear balances solved one by one: a quotient, determinants, or elimination."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from sympy import Expr, Integer, Matrix, Symbol

from derive.draft import Stage
from derive.machine.matching import blocks
from derive.machine.probe import Probe

SMALL = 3  # blocks up to this size are solved by determinants

Split = Callable[[Expr], tuple[Expr, dict[Symbol, Expr]]]


@dataclass
class Solution:
    """Stages that solve balances, and what must not vanish for them to exist."""

    stages: list[Stage]
    divisors: list[Symbol]

    def named(self, name: str, value: Expr) -> Expr:
        """Return a symbol for a value, unless it is plain."""
        if value.is_Symbol or value.is_Number or (-value).is_Symbol:
            return value
        taken = {stage.symbol for stage in self.stages}
        symbol = Symbol(name, real=True)
        while symbol in taken:
            symbol = Symbol(f"{symbol.name}'", real=True)
        self.stages.append(Stage("let", symbol, value))
        return symbol


def solved(
    rows: Sequence[Expr], unknowns: Sequence[Symbol], split: Split, probe: Probe
) -> Solution:
    """Return stages that yield every unknown, each block from those before."""
    parts = [split(row) for row in rows]
    holds = [frozenset(unknowns.index(u) for u in slopes) for _, slopes in parts]
    found = Solution([], [])
    for equations, own in blocks(holds):
        block = [unknowns[k] for k in own]
        matrix = Matrix([[parts[n][1].get(u, Integer(0)) for u in block] for n in equations])
        right = Matrix([_right(parts[n], block) for n in equations])
        _solve_block(found, matrix, right, block, probe)
    return found


def _right(part: tuple[Expr, Mapping[Symbol, Expr]], block: Sequence[Symbol]) -> Expr:
    rest, slopes = part
    return -rest - sum((c * u for u, c in slopes.items() if u not in block), Integer(0))


def _solve_block(
    found: Solution, matrix: Matrix, right: Matrix, block: Sequence[Symbol], probe: Probe
) -> None:
    if len(block) == 1:
        found.stages.append(Stage("let", block[0], right[0] / matrix[0, 0]))
        if matrix[0, 0].free_symbols:
            found.divisors.append(block[0])
    elif len(block) <= SMALL:
        _by_determinants(found, matrix, right, block)
    else:
        _by_elimination(found, matrix, right, block, probe)


def _by_determinants(
    found: Solution, matrix: Matrix, right: Matrix, block: Sequence[Symbol]
) -> None:
    right = Matrix([found.named("b", b) for b in right])
    determinant = found.named("det", matrix.det(method="berkowitz"))
    inverse = found.named("inverse_det", 1 / determinant)
    adjugate = matrix.adjugate()
    for k, u in enumerate(block):
        top = sum((adjugate[k, n] * right[n] for n in range(len(block))), Integer(0))
        found.stages.append(Stage("let", u, inverse * top))
    found.divisors += list(block)


def _by_elimination(
    found: Solution, matrix: Matrix, right: Matrix, block: Sequence[Symbol], probe: Probe
) -> None:
    """Eliminate with pivots chosen once, at a trial point: the largest that is left."""
    size = len(block)
    A, b, rows = matrix.as_mutable(), list(right), list(range(size))
    for k in range(size):
        _value_stages(found, probe)
        pivot = max(rows[k:], key=lambda r: abs(probe.value(A[r, k])))
        rows[k : rows.index(pivot) + 1] = [pivot, *rows[k : rows.index(pivot)]]
        inverse = found.named("pivot", 1 / A[pivot, k])
        for r in rows[k + 1 :]:
            if A[r, k] == 0:
                continue
            factor = found.named("factor", A[r, k] * inverse)
            for c in range(k + 1, size):
                A[r, c] = found.named("a", A[r, c] - factor * A[pivot, c])
            b[r] = found.named("b", b[r] - factor * b[pivot])
            A[r, k] = Integer(0)
    for k in reversed(range(size)):
        r = rows[k]
        above = sum((A[r, c] * block[c] for c in range(k + 1, size)), Integer(0))
        found.stages.append(Stage("let", block[k], (b[r] - above) / A[r, k]))
    found.divisors += list(block)


def _value_stages(found: Solution, probe: Probe) -> None:
    for stage in found.stages:
        if stage.symbol not in probe.values:
            probe.values[stage.symbol] = probe.value(stage.value)
