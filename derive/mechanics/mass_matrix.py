"""A symmetric mass matrix and its right side, and their solution by L D L^T.

In any order L D L^T divides by what is positive, as the energy of every motion is.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from sympy import Expr, Integer, Matrix, Symbol

from derive.mechanics.links import BASE, Drift, Links


@dataclass(frozen=True)
class Factors:
    """L and the inverse of D, by unknown: L below its diagonal, in an order."""

    order: tuple[Symbol, ...]
    below: Mapping[tuple[Symbol, Symbol], Expr]
    inverses: Mapping[Symbol, Expr]


@dataclass
class MassMatrix:
    """What is computed on the way, in order, each by a symbol; then both sides, by unknown.

    factors : once it is solved
    """

    definitions: dict[Symbol, Expr] = field(default_factory=dict)
    entries: dict[tuple[Symbol, Symbol], Expr] = field(default_factory=dict)
    right: dict[Symbol, Expr] = field(default_factory=dict)
    factors: Factors | None = None
    named: dict[Expr, Expr] = field(default_factory=dict)

    def cut(self, name: str, value: Expr) -> Expr:
        """Return a symbol for a value, unless it is plain; equal ones have one, but for signs."""
        if value.is_Number or value.as_coeff_Mul()[1].is_Symbol:
            return value
        if value in self.named:
            return self.named[value]
        symbol = Symbol(name, real=True)
        if symbol in self.definitions:
            symbol = Symbol(f"{name}'{len(self.definitions)}", real=True)
        self.definitions[symbol] = value
        self.named |= {value: symbol, -value: -symbol}
        return symbol

    def column(self, name: str, values: Matrix) -> Matrix:
        """Return a column with every component by a symbol."""
        return values.applyfunc(lambda value: self.cut(name, value))

    def add(self, a: Symbol, b: Symbol, value: Expr) -> None:
        """Add to an entry of the matrix, and to that across its diagonal."""
        for pair in dict.fromkeys(((a, b), (b, a))):
            self.entries[pair] = self.entries.get(pair, Integer(0)) + value

    def act(self, unknown: Symbol, value: Expr) -> None:
        """Add to the right side."""
        self.right[unknown] = self.right.get(unknown, Integer(0)) + value

    def translate(self, m: Expr, drift: Drift, gravity: Matrix) -> None:
        """Add a mass that is carried through space without being turned."""
        for unknown, d in drift.slopes.items():
            self.act(unknown, -m * d.dot(drift.rest - gravity))
        self.carry(m, drift)

    def still(self, machine: Links) -> None:
        """Add all that does not turn: masses and wheels that the base carries, and what acts."""
        for m, drift in machine.carried:
            self.translate(m, drift, machine.gravity)
        for wheel in machine.wheels:
            if wheel.link == BASE:
                each = list(wheel.spinning.slopes.items())
                for u, d in each:
                    self.act(u, -wheel.inertia * d.dot(wheel.spinning.rest))
                self.alike(each, [wheel.inertia * d for _, d in each])
        for unknown, value in machine.acting.items():
            self.act(unknown, value)

    def alike(self, each: Sequence[tuple[Symbol, Matrix]], taken: Sequence[Matrix]) -> None:
        """Add what unknowns take that move one thing, each by how all others move it."""
        for n, (unknown, _) in enumerate(each):
            for other, d in each[n:]:
                self.add(unknown, other, d.dot(taken[n]))

    def carry(self, m: Expr, drift: Drift) -> None:
        """Add such a mass to the matrix alone."""
        each = list(drift.slopes.items())
        self.alike(each, [m * d for _, d in each])

    def copied(self) -> "MassMatrix":
        """Return one that is free to be added to."""
        each = (dict(self.definitions), dict(self.entries), dict(self.right))
        return MassMatrix(*each, named=dict(self.named))

    def solved(self, order: Sequence[Symbol]) -> tuple["MassMatrix", dict[Symbol, Expr]]:
        """Return the unknowns, and what is computed on the way to them in an order."""
        own = MassMatrix(dict(self.definitions), named=dict(self.named))
        A, left = dict(self.entries), list(order)
        b = {u: own.cut("b", self.right.get(u, Integer(0))) for u in order}
        factors, inverses = dict[tuple[Symbol, Symbol], Expr](), dict[Symbol, Expr]()
        for u in order:
            left.remove(u)
            inverses[u] = own.cut("inverse", 1 / A[u, u])
            held = [n for n in left if A.get((n, u), 0) != 0]
            for n in held:
                factors[n, u] = own.cut("factor", A[n, u] * inverses[u])
                b[n] = own.cut("b", b[n] - factors[n, u] * b[u])
            for place, n in enumerate(held):
                for m in held[place:]:
                    less = A.get((n, m), Integer(0)) - factors[n, u] * A[m, u]
                    A[n, m] = A[m, n] = own.cut("a", less)
        own.factors = Factors(tuple(order), factors, inverses)
        own.named, found = {}, dict[Symbol, Expr]()  # what is found stands by itself
        for u, inverse in reversed(inverses.items()):
            rest = sum((e * found[n] for (n, k), e in factors.items() if k == u), Integer(0))
            found[u] = own.cut("x", b[u] * inverse - rest)
        return own, found
