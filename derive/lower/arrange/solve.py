"""Blocks of linear balances solved one by one: a quotient, determinants, or elimination."""

from collections.abc import Sequence

from sympy import Expr, Integer, Matrix, Symbol

from derive.lower.arrange.block import BlockRule, LinearSystem, Solution, by_determinants, by_pivots
from derive.lower.arrange.matching import blocks
from derive.mechanics.sheet import Split

SMALL = 3  # blocks up to this size are solved by determinants


def solve(
    found: Solution, rows: Sequence[Split], unknowns: Sequence[Symbol], rules: Sequence[BlockRule]
) -> None:
    """Add definitions that yield every unknown, each block from those before.

    rows  : of each the part without unknowns, and each unknown's coefficient
    rules : tried on each block before what serves every block
    """

    def one(found: Solution, block: LinearSystem) -> None:
        if not any(rule(found, block, one) for rule in rules):
            _solve_block(found, block)

    holds = [frozenset(unknowns.index(u) for u in slopes) for _, slopes in rows]
    for equations, own in blocks(holds):
        block = [unknowns[k] for k in own]
        matrix = Matrix([[rows[n][1].get(u, Integer(0)) for u in block] for n in equations])
        right = Matrix([_right(rows[n], block) for n in equations])
        one(found, LinearSystem(matrix, right, block))


def _right(part: Split, block: Sequence[Symbol]) -> Expr:
    rest, slopes = part
    return -rest - sum((c * u for u, c in slopes.items() if u not in block), Integer(0))


def _solve_block(found: Solution, block: LinearSystem) -> None:
    matrix = block.matrix
    if matrix.rows == 1:
        found.solved(block.unknowns[0], block.right[0] / matrix[0, 0])
    elif matrix.rows <= SMALL:
        by_determinants(found, block)
    else:
        taken = [(r, c) for c, r in enumerate(found.pivots.order(matrix))]
        if found.pivots.vanish(matrix, taken):
            taken = found.pivots.chosen(matrix, block.unknowns, SMALL)
        by_pivots(found, block, taken, by_determinants)
