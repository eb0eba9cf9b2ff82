"""Pivots of an elimination that vanish nowhere in the declared ranges."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from mpmath import mp
from numpy.typing import NDArray
from sympy import Expr, Function, Matrix, Symbol, cos, sin, tan

from derive.mechanics.box import Box, ranges
from derive.mechanics.probe import DIGITS, Probe, random_probe
from derive.mechanics.sheet import below
from derive.mechanics.sweep import LEAST, Sweep, Weakest, matrices, reaches_of, sweep_at, weakest
from derive.mechanics.words import Words
from derive.scene import SceneError

MatrixEntry = tuple[int, int]


@dataclass
class Pivots:
    """The ranges, a trial point, the named quantities below, and what the unknowns are called."""

    ranges: Box
    probe: Probe
    definitions: dict[Symbol, Expr]
    label: Callable[[Symbol], str]

    def define(self, symbol: Symbol, value: Expr) -> None:
        """Add a named quantity, if it can be valued."""
        known_there = value.free_symbols <= self.probe.values.keys()
        if known_there and {type(f) for f in value.atoms(Function)} <= {sin, cos, tan}:
            self.probe.values[symbol] = self.probe.value(value)
            self.definitions[symbol] = value

    def order(self, matrix: Matrix) -> list[int]:
        """Return rows in the order of pivots at the trial point: the largest that is left."""
        size = matrix.rows
        with mp.workdps(DIGITS):
            A = [[self.probe.value(matrix[r, c]) for c in range(size)] for r in range(size)]
            rows = list(range(size))
            for k in range(size):
                pivot = max(rows[k:], key=lambda r: abs(A[r][k]))
                rows[k : rows.index(pivot) + 1] = [pivot, *rows[k : rows.index(pivot)]]
                for r in rows[k + 1 :]:
                    factor = A[r][k] / A[pivot][k]
                    A[r] = [a - factor * p for a, p in zip(A[r], A[pivot], strict=True)]
        return rows

    def vanish(self, matrix: Matrix, places: Sequence[MatrixEntry]) -> bool:
        """Tell whether some pivot vanishes, taken one after another at (row, column)."""
        return self._weakest(matrix, places, LEAST).vanishes

    def chosen(self, matrix: Matrix, unknowns: Sequence[Symbol], left: int) -> list[MatrixEntry]:
        """Return (row, column) of the pivots to take until so many rows are ``left``.

        Raises SceneError where none is found, naming the divisor and where it vanishes.
        """
        found = sweep_at(self.ranges, self.ranges.trials(), self._below(matrix))
        A, taken = matrices(found, matrix.tolist()), list[MatrixEntry]()
        rows, columns = list(range(matrix.rows)), list(range(matrix.rows))
        while len(rows) > left:
            sizes = {(r, c): float(abs(A[:, r, c]).min()) for r in rows for c in columns}
            r, c = max(sizes, key=lambda place: (round(sizes[place], 6), -place[0], -place[1]))
            taken.append((r, c))
            rows.remove(r)
            columns.remove(c)
            A = _eliminated(A, r, c)
        worst = self._weakest(matrix, taken, -np.inf)
        if worst.vanishes:
            names = ", ".join(f"'{self.label(u)}'" for u in unknowns)
            raise SceneError(f"a divisor of {names} vanishes {worst.where}")
        return taken

    def _weakest(self, matrix: Matrix, places: Sequence[MatrixEntry], enough: float) -> Weakest:
        """Return the weakest pivot beside sizes of terms; if it seems to vanish, beside reaches."""
        below, measure = self._below(matrix), self._measure(matrix, places)
        found = weakest(self.ranges, below, measure, enough=enough)
        if found.vanishes and below:
            reaches = reaches_of(self.ranges, below)
            found = weakest(self.ranges, below, measure, reaches=reaches, enough=enough)
        return found

    def _below(self, matrix: Matrix) -> Mapping[Symbol, Expr]:
        return below(self.definitions, matrix)

    def _measure(self, matrix: Matrix, places: Sequence[MatrixEntry]) -> Callable[[Sweep], Any]:
        """Return the smallest pivot, and singular value of what is left, of scaled matrices."""

        def smallest(found: Sweep) -> NDArray[Any]:
            A = matrices(found, matrix.tolist())
            each: list[NDArray[Any]] = []
            for r, c in places:
                each.append(abs(A[:, r, c]))
                A = _eliminated(A, r, c)
            rows, columns = (
                [n for n in range(matrix.rows) if n not in {p[k] for p in places}] for k in (0, 1)
            )
            if rows:
                left = np.nan_to_num(A[:, rows][:, :, columns])
                each.append(np.linalg.svd(left, compute_uv=False)[:, -1])
            least: NDArray[Any] = np.min(each, axis=0)
            return least

        return smallest


def _eliminated(A: NDArray[Any], r: int, c: int) -> NDArray[Any]:
    """Return matrices with a row taken off all others, so that their entries in a column vanish."""
    with np.errstate(all="ignore"):
        factor = A[:, :, c] / A[:, r, c][:, None]
        factor[:, r] = 0
        left: NDArray[Any] = A - factor[:, :, None] * A[:, r, :][:, None, :]
    return left


def pivots(words: Words, definitions: Mapping[Symbol, Expr]) -> Pivots:
    """Return the pivots of balances that stand on some named quantities."""
    probe = random_probe(words, 0)
    probe.define(definitions)
    return Pivots(ranges(words), probe, dict(definitions), words.sheet.label)
