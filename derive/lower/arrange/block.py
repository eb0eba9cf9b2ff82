"""A block of linear balances: what it holds, and the definitions that solve it."""

from collections.abc import Callable, Container, Iterable, Sequence
from dataclasses import dataclass, field

from sympy import Expr, Integer, Matrix, Symbol

from derive.lower.arrange.arrangement import Definition
from derive.lower.arrange.pivots import MatrixEntry, Pivots


@dataclass(frozen=True)
class LinearSystem:
    """``matrix`` times the unknowns is ``right``, one row a balance."""

    matrix: Matrix
    right: Matrix
    unknowns: Sequence[Symbol]


@dataclass
class Solution:
    """Definitions that solve balances, and what is known of the symbols in them.

    fixed  : what rests on parameters only
    pivots : finds where pivots vanish, and others that do not
    """

    fixed: frozenset[Symbol]
    pivots: Pivots
    definitions: list[Definition] = field(default_factory=list)

    def named(self, kind: str, name: str, value: Expr, family: str = "") -> Expr:
        """Return a symbol for a value, unless it is plain."""
        if value.is_Symbol or value.is_Number or (-value).is_Symbol:
            return value
        symbol = unused_symbol(name, {definition.symbol for definition in self.definitions})
        self.definitions.append(Definition(kind, symbol, value, family))
        self.pivots.define(symbol, value)
        if value.free_symbols <= self.fixed:
            self.fixed |= {symbol}
        return symbol

    def column(self, name: str, values: Matrix) -> Matrix:
        """Return a column with every component named, all of one family."""
        return values.applyfunc(lambda value: self.named("let", name, value, name))

    def solved(self, unknown: Symbol, value: Expr) -> None:
        """Note the value of an unknown."""
        self.definitions.append(Definition("let", unknown, value))

    def is_fixed(self, entries: Iterable[Expr]) -> bool:
        """Tell whether entries rest on parameters only."""
        return all(e.free_symbols <= self.fixed for e in entries)


def unused_symbol(name: str, taken: Container[Symbol]) -> Symbol:
    """Return a symbol that is not taken; ``name`` is no scene's."""
    symbol = Symbol(name, real=True)
    while symbol in taken:
        symbol = Symbol(f"{symbol.name}'", real=True)
    return symbol


Solve = Callable[[Solution, LinearSystem], None]
BlockRule = Callable[[Solution, LinearSystem, Solve], bool]
"""A way to solve some blocks, which tells whether this was one; what is left it hands on."""


def by_determinants(found: Solution, block: LinearSystem) -> None:
    """Solve a small block by Cramer's rule."""
    right = [found.named("let", "b", b) for b in block.right]
    determinant = found.named("let", "det", block.matrix.det(method="berkowitz"))
    inverse = found.named("let", "inverse_det", 1 / determinant)
    adjugate = block.matrix.adjugate()
    for k, u in enumerate(block.unknowns):
        top = sum((adjugate[k, n] * right[n] for n in range(len(right))), Integer(0))
        found.solved(u, inverse * top)


def by_pivots(
    found: Solution, block: LinearSystem, taken: Sequence[MatrixEntry], rest: Solve
) -> None:
    """Eliminate by pivots at (row, column), solve what is left, and go back."""
    A, b = block.matrix.as_mutable(), list(block.right)
    rows, columns = [r for r, _ in taken], list(range(A.rows))
    rows += [r for r in range(A.rows) if r not in rows]
    for r, c in taken:
        rows.remove(r)
        columns.remove(c)
        inverse = found.named("let", "pivot", 1 / A[r, c])
        for n in rows:
            if A[n, c] == 0:
                continue
            factor = found.named("let", "factor", A[n, c] * inverse)
            for k in columns:
                A[n, k] = found.named("let", "a", A[n, k] - factor * A[r, k])
            b[n] = found.named("let", "b", b[n] - factor * b[r])
    left = A.extract(rows, columns), Matrix([b[n] for n in rows])
    if columns:
        rest(found, LinearSystem(*left, [block.unknowns[c] for c in columns]))
    known = list(columns)
    for r, c in reversed(taken):
        other = sum((A[r, k] * block.unknowns[k] for k in known), Integer(0))
        found.solved(block.unknowns[c], (b[r] - other) / A[r, c])
        known.append(c)
