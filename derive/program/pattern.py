"""The pattern of a matrix and its nonzeros, in compressed columns, whatever its entries are."""

from collections.abc import Callable, Sequence
from typing import TypeVar

from derive.program.program import Sparsity

T = TypeVar("T")


def compressed(
    matrix: Sequence[Sequence[T]],
    rows: Sequence[str],
    columns: Sequence[str],
    vanishes: Callable[[T], bool],
) -> tuple[Sparsity, list[T]]:
    """Return the pattern and the nonzeros of a matrix, column by column."""
    colind, row, nonzeros = [0], list[int](), list[T]()
    for column in range(len(columns)):
        own = [i for i, entries in enumerate(matrix) if not vanishes(entries[column])]
        row += own
        nonzeros += [matrix[i][column] for i in own]
        colind.append(len(row))
    return Sparsity(tuple(rows), tuple(columns), tuple(colind), tuple(row)), nonzeros
