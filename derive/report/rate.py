"""The rate of a state as the lecture's equations give it, in long floats, prepared for a motion.

The equations stand as they are: sums of products, solved block by block. What rests on held numbers
alone is worked out before, what the rate does not need is left out, and a product that several sums
hold is taken once; nothing is multiplied out, eliminated or re-ordered otherwise.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, partial
from typing import Any

from flint import arb, arb_mat

from derive.library.library import Library
from derive.report.states import rate_equations
from derive.verify.equations import Block, Equations, Sum
from derive.verify.operators import LONG_FLOATS
from derive.verify.valuation import AtomPowers, raised, value

RateLine = tuple[str, tuple[int, ...]]
"""What is done, the place where it goes, and those that it is made of, as ``DONE`` reads them."""
Done = Callable[[list[Any]], None]
ONE = arb(1)
FUNCTION = 50
"""Operations that a function is counted as: a sine of two doubles takes so many."""


@dataclass(frozen=True)
class RateOfState:
    """The rate of a state: lines to be done in a row, on numbers by place.

    numbers : where those that are held stand already      count : operations of all lines
    """

    numbers: list[Any]
    states: tuple[int, ...]
    rates: tuple[int, ...]
    lines: tuple[RateLine, ...]
    count: int

    @cached_property
    def done(self) -> list[Done]:
        """Return what does each line."""
        return [DONE[name](places) if name in DONE else _applied(LONG_FLOATS[name], places)
                for name, places in self.lines]  # fmt: skip

    def __call__(self, state: Sequence[Any]) -> list[Any]:
        """Return the rates of a state's components.

        Raises ZeroDivisionError where the equations have no solution.
        """
        at = self.numbers
        for place, x in zip(self.states, state, strict=True):
            at[place] = x
        for line in self.done:
            line(at)
        return [at[place].mid() for place in self.rates]


def rate_of_state(library: Library, given: Mapping[str, Any]) -> RateOfState:
    """Return the rate of a scene's state, all but the state held at what is given."""
    equations, rates = rate_equations(library)
    place = {name: n for n, name in equations.names.items()}
    sought = {u: block for block in equations.blocks for u in block.unknowns}
    states = [c for q in library.vocabulary.states for c in q.components]
    held = {n: given[c] for c, n in place.items()
            if c in given and c not in states and n not in sought}  # fmt: skip
    made = _Prepared(equations, sought, held)
    own = [made.place(None) for _ in states]
    made.places.update({place[c]: own[k] for k, c in enumerate(states) if c in place})
    found = tuple(made.whole(place[name]) for name in rates)
    return RateOfState(made.numbers, tuple(own), found, tuple(made.lines), made.count)


@dataclass
class _Prepared:
    """Lines under way. What is wanted is made when it is asked for, after what it is made of.

    held : numbers of atoms that do not vary      places : of those that do
    products, inverses : places of what was made of others, by these
    """

    equations: Equations
    sought: Mapping[int, Block]
    held: dict[int, Any]
    places: dict[int, int] = field(default_factory=dict)
    products: dict[tuple[int, ...], int] = field(default_factory=dict)
    numbers: list[Any] = field(default_factory=list)
    lines: list[RateLine] = field(default_factory=list)
    count: int = 0

    def place(self, number: Any) -> int:
        """Return a place of its own for a number."""
        self.numbers.append(number)
        return len(self.numbers) - 1

    def whole(self, atom: int) -> int:
        """Return the place of an atom, of one that is held too."""
        self.want(atom)
        return self.place(self.held[atom]) if atom in self.held else self.places[atom]

    def want(self, atom: int) -> None:
        """Make an atom, and first what it is made of."""
        if atom in self.held or atom in self.places:
            return
        if atom in self.sought:
            self.solve(self.sought[atom])
            return
        kind, inner = self.equations.atoms[atom].kind, self.equations.atoms[atom].inner
        if kind == "pi":
            self.held[atom] = LONG_FLOATS["pi"]()
            return
        operation = _inverse if kind == "inverse" else LONG_FLOATS[kind]
        number, terms = self.split((_of(c), factors) for factors, c in inner)
        if not terms:
            self.held[atom] = operation(number)
            return
        source, to = self.sum(number, terms), self.place(None)
        self.lines.append((kind, (to, source)))
        self.count += FUNCTION
        self.places[atom] = to

    def solve(self, block: Block) -> None:
        """Make the unknowns of a block."""
        right = [self.stated(s) for s in block.right]
        rows = [[self.stated(s) for s in row] for row in block.matrix]
        if len(right) == 1 and not rows[0][0][1]:
            self.define(block.unknowns[0], right[0], rows[0][0][0])
            return
        every = [self.sum(*s) for row, b in zip(rows, right, strict=True) for s in (*row, b)]
        to, size = [self.place(None) for _ in right], len(right)
        self.lines.append(("solve", (to[0], size, *every, *to)))
        self.count += size * size * (size + 3)
        self.places.update(zip(block.unknowns, to, strict=True))

    def define(self, unknown: int, made_of: tuple[Any, dict[int, Any]], divisor: Any) -> None:
        """Make an unknown that one equation gives, whose own factor is a number."""
        number, terms = made_of
        if not terms:
            self.held[unknown] = (number / divisor).mid()
            return
        more = {place: (x / divisor).mid() for place, x in terms.items()}
        self.places[unknown] = self.sum((number / divisor).mid(), more)

    def stated(self, parts: Sum) -> tuple[Any, dict[int, Any]]:
        """Return a sum of the equations: its number, and the factor of each place in it."""
        stated = self.equations.coefficients
        return self.split(
            (value(stated[part.coefficient], self.known(stated[part.coefficient]), LONG_FLOATS),
             part.factors)
            for part in parts
        )  # fmt: skip

    def known(self, polynomial: Iterable[tuple[AtomPowers, Fraction]]) -> Mapping[int, Any]:
        """Return numbers of parameters, those that are made of others among them."""
        for powers, _ in polynomial:
            for atom, _ in powers:
                self.want(atom)
        return self.held

    def split(self, parts: Iterable[tuple[Any, AtomPowers]]) -> tuple[Any, dict[int, Any]]:
        """Return a sum of products apart: what is held, and a number for each place that varies."""
        held, terms = arb(0), dict[int, Any]()
        for factor, factors in parts:
            number, varying = factor, list[int]()
            for atom, power in factors:
                self.want(atom)
                if atom in self.held:
                    number = number * raised(self.held[atom], power)
                else:
                    one = self.places[atom] if power > 0 else self.inverse(self.places[atom])
                    varying += [one] * abs(power)
            if varying:
                place = self.product(varying)
                terms[place] = (terms.get(place, 0) + number).mid()
            else:
                held = held + number
        return held.mid(), {place: x for place, x in terms.items() if x != 0}

    def inverse(self, source: int) -> int:
        """Return the place of one over a number."""
        if (source,) not in self.products:
            to = self.products[source,] = self.place(None)
            self.lines.append(("inverse", (to, source)))
            self.count += 1
        return self.products[source,]

    def product(self, varying: Sequence[int]) -> int:
        """Return the place of a product."""
        each = sorted(varying)
        first = each[0]
        for other in each[1:]:
            if (first, other) not in self.products:
                to = self.products[first, other] = self.place(None)
                self.lines.append(("mul", (to, first, other)))
                self.count += 1
            first = self.products[first, other]
        return first

    def sum(self, number: Any, terms: Mapping[int, Any]) -> int:
        """Return the place of a sum."""
        if not terms:
            return self.place(number)
        if len(terms) == 1 and number == 0 and [*terms.values()] == [ONE]:
            return next(iter(terms.keys()))
        to = self.place(None)
        plain = [place for place, x in terms.items() if x == ONE]
        scaled = [(x, place) for place, x in terms.items() if x != ONE]
        more = [place for x, by in scaled for place in (self.place(x), by)]
        self.lines.append(("sum", (to, self.place(number), len(plain), *plain, *more)))
        self.count += len(plain) + 2 * len(scaled)
        return to


def _of(number: Fraction) -> Any:
    return LONG_FLOATS["number"](number)


def _inverse(x: Any) -> Any:
    return (1 / x).mid()


def _applied(operation: Callable[[Any], Any], places: Sequence[int]) -> Done:
    to, source = places

    def line(at: list[Any]) -> None:
        at[to] = operation(at[source])

    return line


def _multiplied(places: Sequence[int]) -> Done:
    to, first, other = places

    def line(at: list[Any]) -> None:
        at[to] = at[first] * at[other]

    return line


def _added(places: Sequence[int]) -> Done:
    to, number, count, *rest = places
    plain, scaled = rest[:count], [*zip(rest[count::2], rest[count + 1 :: 2], strict=True)]

    def line(at: list[Any]) -> None:
        total = at[number]
        for place in plain:
            total = total + at[place]
        for factor, place in scaled:
            total = total + at[factor] * at[place]
        at[to] = total.mid()

    return line


def _solved(places: Sequence[int]) -> Done:
    _, size, *rest = places
    every, to = rest[:-size], rest[-size:]
    matrix = [place for k, place in enumerate(every) if (k + 1) % (size + 1)]
    right = every[size :: size + 1]

    def line(at: list[Any]) -> None:
        if size == 1:
            at[to[0]] = (at[right[0]] / at[matrix[0]]).mid()
            return
        known = arb_mat(size, 1, [at[place] for place in right])
        found = arb_mat(size, size, [at[place] for place in matrix]).solve(known)
        for place, x in zip(to, found.entries(), strict=True):
            at[place] = x.mid()

    return line


DONE: Mapping[str, Callable[[Sequence[int]], Done]] = {
    "mul": _multiplied,
    "sum": _added,  # a number, how many are added as they are, these, pairs of factors
    "solve": _solved,  # how many, row by row the matrix and the right side, where unknowns go
    "inverse": partial(_applied, _inverse),
}
