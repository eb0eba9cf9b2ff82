"""Unknowns with a constant coefficient in one balance eliminated first, as those of wheels are.

The balance of a wheel along its axis, C (s_dot + a . omega_dot) = u, yields s_dot by a quotient
that rests on parameters only; so what is left holds fewer unknowns and no other divisor.
"""

from sympy import Matrix

from derive.lower.arrange.block import LinearSystem, Solution, Solve, by_pivots
from derive.lower.arrange.pivots import MatrixEntry


def constant_coefficients(found: Solution, block: LinearSystem, rest: Solve) -> bool:
    """Eliminate by coefficients that rest on parameters only, wherever one stands in a balance."""
    taken = _pivots(found, block.matrix)
    if not taken or found.pivots.vanish(block.matrix, taken):
        return False
    by_pivots(found, block, taken, rest)
    return True


def _pivots(found: Solution, matrix: Matrix) -> list[MatrixEntry]:
    """Return (row, column) of constant coefficients, those first that leave the fewest entries."""
    A, taken = matrix.as_mutable(), list[MatrixEntry]()
    rows, columns = list(range(A.rows)), list(range(A.rows))
    while len(rows) > 1 and not found.is_fixed(A.extract(rows, columns)):
        places = [
            (r, c) for r in rows for c in columns if A[r, c] != 0 and found.is_fixed([A[r, c]])
        ]
        if not places:
            break
        r, c = min(places, key=lambda place: (_fill(A, place, rows, columns), place))
        taken.append((r, c))
        rows.remove(r)
        columns.remove(c)
        for n in (n for n in rows if A[n, c] != 0):
            for k in columns:
                A[n, k] -= A[n, c] / A[r, c] * A[r, k]
    return taken


def _fill(A: Matrix, place: MatrixEntry, rows: list[int], columns: list[int]) -> int:
    """Return how many entries an elimination changes."""
    r, c = place
    across = sum(A[r, k] != 0 for k in columns if k != c)
    return int(across * sum(A[n, c] != 0 for n in rows if n != r))
