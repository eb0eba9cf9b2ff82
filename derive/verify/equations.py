"""A problem as linear equations, multiplied out, in an order in which they can be solved.

Rows that need each other's unknowns form a block; all other terms of a row are made of inputs and
of unknowns solved before, so that the size of each term can be told.
"""

from collections.abc import Iterable, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from derive.library.library import Library
from derive.lower.arrange.matching import blocks
from derive.mechanics.mechanism import Mechanism, mechanism
from derive.mechanics.problem import Problem
from derive.scene import Scene
from derive.verify.valuation import Atom, AtomPowers, Atoms, Polynomial, collected_terms

Coefficient = tuple[tuple[AtomPowers, Fraction], ...]


@dataclass(frozen=True)
class Part:
    """A term whose coefficient is kept by its place."""

    coefficient: int
    factors: AtomPowers


Sum = tuple[Part, ...]


@dataclass(frozen=True)
class Block:
    """Linear equations, matrix @ unknowns = right, in inputs and in unknowns of earlier blocks."""

    unknowns: tuple[int, ...]
    matrix: tuple[tuple[Sum, ...], ...]
    right: tuple[Sum, ...]


@dataclass(frozen=True)
class Equations:
    """A problem ready to be solved: atoms, coefficients made of parameters, blocks in order."""

    atoms: tuple[Atom, ...]
    names: Mapping[int, str]  # the component that an atom is
    fixed: frozenset[int]  # atoms made of parameters only
    coefficients: tuple[Coefficient, ...]
    blocks: tuple[Block, ...]

    @cached_property
    def signs(self) -> tuple[int, ...]:
        """Return of each block 1 or -1 if that is its matrix, most being definitions, else 0."""
        return tuple(self._sign(block.matrix) for block in self.blocks)

    def _sign(self, matrix: tuple[tuple[Sum, ...], ...]) -> int:
        entries = [part for row in matrix for entry in row for part in entry]
        if len(matrix) != 1 or len(entries) != 1 or entries[0].factors:
            return 0
        coefficient = self.coefficients[entries[0].coefficient]
        return next((sign for sign in (1, -1) if coefficient == (((), Fraction(sign)),)), 0)

    @cached_property
    def functions(self) -> dict[int, frozenset[int]]:
        """Return the atoms that are functions, each with the atoms that it is made of."""
        return {
            place: frozenset(_made_of(atom))
            for place, atom in enumerate(self.atoms)
            if place not in self.names
        }


@dataclass
class _Splitter:
    """Collects the coefficients of terms as equations are taken apart."""

    atoms: Atoms
    fixed: frozenset[int]
    places: dict[Coefficient, int]

    def sum(self, polynomial: Polynomial) -> Sum:
        found = []
        for term in collected_terms(polynomial, lambda atom: atom not in self.fixed):
            place = self.places.setdefault(term.coefficient, len(self.places))
            found.append(Part(place, term.factors))
        return tuple(found)

    def block(self, rows: Sequence[Polynomial], unknowns: Sequence[int], later: set[int]) -> Block:
        matrix, right = [], []
        for row in rows:
            rest = {m: -c for m, c in row.items() if not later & self.atoms.within(m)}
            matrix.append(tuple(self.sum(_coefficient_of(row, u)) for u in unknowns))
            right.append(self.sum(rest))
        return Block(tuple(unknowns), tuple(matrix), tuple(right))


def _coefficient_of(row: Polynomial, unknown: int) -> Polynomial:
    return {
        tuple((a, p) for a, p in m if a != unknown): c for m, c in row.items() if (unknown, 1) in m
    }


def stated(library: Library) -> dict[str, Equations]:
    """Return the equations of every function that the lecture states, by its name."""
    every = library.problems.items()
    return {base: equations_of(library.mechanism, problem) for base, problem in every}


def retold(scene: Scene, bases: Iterable[str]) -> dict[str, Equations]:
    """Return the equations of functions of a scene, derived from it anew."""
    told = mechanism(scene)
    return {base: equations_of(told, told.problem(base)) for base in bases}


def equations_of(machine: Mechanism, problem: Problem) -> Equations:
    """Return the equations of a problem, multiplied out and in an order to solve them in."""
    vocabulary, atoms = machine.posed(problem.name).vocabulary, Atoms()
    rows = [atoms.polynomial(residual) for residual in problem.residuals]
    unknowns = [atoms.symbol(symbol) for symbol in problem.sought]
    splitter = _Splitter(atoms, _fixed(atoms, vocabulary.fixed()), {})
    found, later = [], set(unknowns)
    for places, solved in blocks([_uses(atoms, row, unknowns) for row in rows]):
        own = [unknowns[u] for u in solved]
        found.append(splitter.block([rows[r] for r in places], own, later))
        later -= set(own)
    component = {symbol: name for name, symbol in vocabulary.symbols.items()}
    names = {n: component[a.symbol] for n, a in enumerate(atoms.each) if a.symbol is not None}
    return Equations(tuple(atoms.each), names, splitter.fixed, tuple(splitter.places), tuple(found))


def _uses(atoms: Atoms, row: Polynomial, unknowns: Sequence[int]) -> frozenset[int]:
    present = {atom for monomial in row for atom in atoms.within(monomial)}
    return frozenset(place for place, atom in enumerate(unknowns) if atom in present)


def _fixed(atoms: Atoms, parameters: AbstractSet[Any]) -> frozenset[int]:
    fixed: set[int] = set()
    for place, atom in enumerate(atoms.each):
        if atom.symbol in parameters if atom.kind == "symbol" else _made_of(atom) <= fixed:
            fixed.add(place)
    return frozenset(fixed)


def _made_of(atom: Atom) -> set[int]:
    return {a for monomial, _ in atom.inner for a, _ in monomial}
