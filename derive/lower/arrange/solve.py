"""Blocks of linear balances solved one by one: a quotient, determinants, or elimination."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from mpmath import mp
from sympy import Expr, Integer, Matrix, Symbol

from derive.lower.arrange.draft import Stage
from derive.lower.arrange.matching import blocks
from derive.mechanics.pivots import Pivots
from derive.mechanics.probe import DIGITS, Probe

SMALL = 3  # blocks up to this size are solved by determinants

Split = Callable[[Expr], tuple[Expr, dict[Symbol, Expr]]]


@dataclass
class Solution:
    """Stages that solve balances."""

    stages: list[Stage]

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
    rows: Sequence[Expr], unknowns: Sequence[Symbol], split: Split, probe: Probe, pivots: Pivots
) -> Solution:
    """Return stages that yield every unknown, each block from those before.

    pivots : finds where pivots vanish, and others that do not
    """
    parts = [split(row) for row in rows]
    holds = [frozenset(unknowns.index(u) for u in slopes) for _, slopes in parts]
    found = Solution([])
    for equations, own in blocks(holds):
        block = [unknowns[k] for k in own]
        matrix = Matrix([[parts[n][1].get(u, Integer(0)) for u in block] for n in equations])
        right = Matrix([_right(parts[n], block) for n in equations])
        _solve_block(found, matrix, right, block, probe, pivots)
    return found


def _right(part: tuple[Expr, Mapping[Symbol, Expr]], block: Sequence[Symbol]) -> Expr:
    rest, slopes = part
    return -rest - sum((c * u for u, c in slopes.items() if u not in block), Integer(0))


def _solve_block(
    found: Solution,
    matrix: Matrix,
    right: Matrix,
    block: Sequence[Symbol],
    probe: Probe,
    pivots: Pivots,
) -> None:
    if len(block) == 1:
        found.stages.append(Stage("let", block[0], right[0] / matrix[0, 0]))
    elif len(block) <= SMALL:
        _by_determinants(found, matrix, right, block)
    else:
        order = _order(matrix, probe)
        if pivots.vanish(matrix, order):
            _by_chosen_pivots(found, matrix, right, block, pivots)
        else:
            _by_elimination(found, matrix, right, block, order)


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


def _order(matrix: Matrix, probe: Probe) -> list[int]:
    """Return rows in the order of pivots chosen at a trial point: the largest that is left."""
    size = matrix.rows
    with mp.workdps(DIGITS):
        A = [[probe.value(matrix[r, c]) for c in range(size)] for r in range(size)]
        rows = list(range(size))
        for k in range(size):
            pivot = max(rows[k:], key=lambda r: abs(A[r][k]))
            rows[k : rows.index(pivot) + 1] = [pivot, *rows[k : rows.index(pivot)]]
            for r in rows[k + 1 :]:
                factor = A[r][k] / A[pivot][k]
                A[r] = [a - factor * p for a, p in zip(A[r], A[pivot], strict=True)]
    return rows


def _by_chosen_pivots(
    found: Solution, matrix: Matrix, right: Matrix, block: Sequence[Symbol], pivots: Pivots
) -> None:
    """Eliminate by pivots that vanish nowhere, until determinants do the rest."""
    A, b = matrix.as_mutable(), list(right)
    rows, columns = list(range(len(block))), list(range(len(block)))
    taken = pivots.chosen(matrix, block, SMALL)
    for r, c in taken:
        rows.remove(r)
        columns.remove(c)
        inverse = found.named("pivot", 1 / A[r, c])
        for n in rows:
            if A[n, c] == 0:
                continue
            factor = found.named("factor", A[n, c] * inverse)
            for k in columns:
                A[n, k] = found.named("a", A[n, k] - factor * A[r, k])
            b[n] = found.named("b", b[n] - factor * b[r])
    left, own = A.extract(rows, columns), [block[c] for c in columns]
    _by_determinants(found, left, Matrix([b[n] for n in rows]), own)
    known = list(columns)
    for r, c in reversed(taken):
        rest = sum((A[r, k] * block[k] for k in known), Integer(0))
        found.stages.append(Stage("let", block[c], (b[r] - rest) / A[r, c]))
        known.append(c)


def _by_elimination(
    found: Solution, matrix: Matrix, right: Matrix, block: Sequence[Symbol], rows: Sequence[int]
) -> None:
    """Eliminate with the pivots of rows in an order."""
    size = len(block)
    A, b = matrix.as_mutable(), list(right)
    for k in range(size):
        pivot = rows[k]
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
