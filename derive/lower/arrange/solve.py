"""Blocks of linear balances solved one by one: a quotient, determinants, or elimination."""

from collections.abc import Callable, Mapping, Sequence

from mpmath import mp
from sympy import Expr, Integer, Matrix, Symbol

from derive.lower.arrange.block import Block, Rule, Solution, by_determinants, by_pivots
from derive.lower.arrange.matching import blocks
from derive.mechanics.probe import DIGITS, Probe

SMALL = 3  # blocks up to this size are solved by determinants

Split = Callable[[Expr], tuple[Expr, Mapping[Symbol, Expr]]]


def solve(
    found: Solution,
    rows: Sequence[Expr],
    unknowns: Sequence[Symbol],
    split: Split,
    rules: Sequence[Rule],
) -> None:
    """Add stages that yield every unknown, each block from those before.

    rules : tried on each block before what serves every block
    """

    def one(found: Solution, block: Block) -> None:
        if not any(rule(found, block, one) for rule in rules):
            _solve_block(found, block)

    parts = [split(row) for row in rows]
    holds = [frozenset(unknowns.index(u) for u in slopes) for _, slopes in parts]
    for equations, own in blocks(holds):
        block = [unknowns[k] for k in own]
        matrix = Matrix([[parts[n][1].get(u, Integer(0)) for u in block] for n in equations])
        right = Matrix([_right(parts[n], block) for n in equations])
        one(found, Block(matrix, right, block))


def _right(part: tuple[Expr, Mapping[Symbol, Expr]], block: Sequence[Symbol]) -> Expr:
    rest, slopes = part
    return -rest - sum((c * u for u, c in slopes.items() if u not in block), Integer(0))


def _solve_block(found: Solution, block: Block) -> None:
    matrix = block.matrix
    if matrix.rows == 1:
        found.solved(block.unknowns[0], block.right[0] / matrix[0, 0])
    elif matrix.rows <= SMALL:
        by_determinants(found, block)
    else:
        taken = [(r, c) for c, r in enumerate(_order(matrix, found.probe))]
        if found.pivots.vanish(matrix, taken):
            taken = found.pivots.chosen(matrix, block.unknowns, SMALL)
        by_pivots(found, block, taken, by_determinants)


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
