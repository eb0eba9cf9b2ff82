"""Small motion about a given one: mass, damping with gyroscopic terms, and stiffness matrices.

Every named quantity is carried along with its first derivatives by displacements and velocities,
valued at the given motion as it goes, so that the expressions stay as small as their results.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import networkx as nx
from mpmath import mp, mpf
from sympy import Expr, Integer, Matrix, Symbol, zeros

from derive.mechanics.balance import ValuedBalance
from derive.mechanics.balances import Balances
from derive.mechanics.choice import chosen
from derive.mechanics.inertia import require_held
from derive.mechanics.probe import DIGITS, Probe, at_rest, independent, random_probe, small, solved
from derive.mechanics.valued import Valued
from derive.mechanics.words import Words
from derive.scene import Input, Scene, SceneError
from derive.scene.declaration import Moving
from derive.scene.escape import brief

NEARBY = 1e-6
"""Change of what is set, relative to it, that nobody means: values are given to a few digits."""

WHOLE = 10**20
"""Times this, logarithms are rounded to whole numbers, which have one sum everywhere."""


@dataclass(frozen=True)
class Small:
    """A value at the given motion and its derivatives by each small variable."""

    value: Expr
    slopes: Mapping[Symbol, Expr]


@dataclass(frozen=True)
class Linearised:
    """The matrices of small motion, (n, n) each, and the balances that they are made of.

    written : the balances as expressions that are zero
    """

    matrices: Mapping[str, Matrix]
    rows: tuple[ValuedBalance, ...]
    written: tuple[Expr, ...]


def linearised(machine: Scene, balances: Balances) -> Linearised:
    """Return the three matrices of the free coordinates and speeds in order.

    Rows are in the order in which the masses on the diagonal have the largest product, each counted
    positive: so are those of any symmetric positive definite matrix, however rows are scaled.
    """
    free = [m for m in (*machine.coordinates, *machine.speeds) if m.free]
    sheet = balances.frames.sheet
    if not free:
        raise SceneError("'linearised' needs a free coordinate or speed")
    accelerations = [sheet.symbols[m.unknown] for m in free]
    every = balances.unknowns
    require_held(balances, accelerations)
    rows, held = chosen(balances, frozenset(every.index(a) for a in accelerations))
    written = [balances.written(row) for row in rows]
    below = sheet.needed(written)
    held_by = {s for e in (*written, *below.values()) for s in e.free_symbols}
    require_nothing_prescribed(
        [c for c in machine.coordinates if sheet.symbols[c.name] in held_by], "linearised"
    )
    reactions = [every[k] for k in sorted(held) if every[k] not in accelerations]
    base = {sheet.symbols[n]: balances.frames.words.expression(f) for n, f in machine.about.items()}
    velocities = [sheet.symbols[m.rate.name] if isinstance(m.rate, Input) else
                  sheet.symbols[m.name] for m in free]  # fmt: skip
    places = [sheet.symbols[m.name] if m.kind == "coordinate" else None for m in free]
    about = Expansion(base, [*velocities, *(p for p in places if p is not None)])
    about.define(below)
    eliminated = _Eliminated(balances, about, written, reactions)
    columns = {
        "mass_matrix": eliminated.coefficients(accelerations),
        "damping_matrix": eliminated.slopes(velocities),
        "stiffness_matrix": eliminated.slopes(places),
    }
    made = {name: eliminated.reduced(column) for name, column in columns.items()}
    own = _own_rows(made["mass_matrix"], balances)
    matrices = {name: _in_order(matrix, own) for name, matrix in made.items()}
    return Linearised(matrices, tuple(rows), tuple(written))


def require_nothing_prescribed(
    coordinates: Iterable[Moving], answer: str, way_out: str = ""
) -> None:
    """Refuse coordinates that formulas move: by them it cannot be told what is small, or rests."""
    for c in coordinates:
        if c.state and not c.free:
            rule = f"needs coordinates that are free, but the rate of '{c.name}' is"
            raise SceneError(f"'{answer}' {rule} '{brief(c.rate)}'; let it be free{way_out}")


def unsteady(machine: Scene, balances: Balances, given: Mapping[str, float]) -> Iterator[str]:
    """Yield a sentence for every free coordinate or speed that the given state accelerates.

    given : values that were set; all else is in the middle of its range, or at rest if it varies
        and may be. What is left is an acceleration if it is more than changes of those values by
        a millionth make of it. Where a scene has ``steady`` and nothing is set, nothing is said:
        the state is an equilibrium at its roots alone; nor where it is an argument that is not set.
    """
    open_ = {name for name, f in machine.about.items() if f.name == name} - given.keys()
    steady = bool(machine.steady) and not given
    if steady or open_ or not any("linearised" in a for a in machine.asked.values()):
        return
    sheet, every = balances.frames.sheet, balances.unknowns
    free = [m for m in (*machine.coordinates, *machine.speeds) if m.free]
    rows, held = chosen(balances, frozenset(every.index(sheet.symbols[m.unknown]) for m in free))
    wanted = [every.index(sheet.symbols[m.unknown]) for m in free]
    places = [*wanted, *sorted(held - {*wanted})]
    try:
        found = _accelerations(machine, balances, rows, places, given)
        nearby = {name: x * (1 + NEARBY / (2 + k)) for k, (name, x) in enumerate(given.items())}
        other = _accelerations(machine, balances, rows, places, nearby) if given else found
    except ZeroDivisionError:
        return  # these balances do not tell it there
    where = "at the values that are set" if given else "with all else in mid-range"
    for m, x, y in zip(free, found, other, strict=False):
        if not small(x, 1) and abs(x) > abs(x - y):
            unit = balances.frames.words.vocabulary[m.unknown].unit
            what = "acceleration" if m.kind == "coordinate" else "rate"
            yield (
                f"'linearised' is about a state that is no equilibrium: the {what} of "
                f"'{m.name}' is {float(x):.3g} {unit} there, {where}"
            )


def _accelerations(
    machine: Scene,
    balances: Balances,
    rows: Sequence[ValuedBalance],
    places: Sequence[int],
    given: Mapping[str, float],
) -> list[Any]:
    """Return the unknowns at these places by these balances, in the state of small motion.

    Raises ZeroDivisionError where they do not tell them.
    """
    sheet, words = balances.frames.sheet, balances.frames.words
    with mp.workdps(DIGITS):
        probe = _middle(words)
        probe.values |= {sheet.symbols[n]: mpf(x) for n, x in given.items()}
        probe.values |= {sheet.symbols[n]: probe.value(words.expression(f))
                         for n, f in machine.about.items()}  # fmt: skip
        probe.define(sheet.definitions)
        valued = Valued(balances.sides, probe)
        matrix = [balances.at(row, valued) for row in rows]
        return solved([[row[1 + k] for k in places] for row in matrix], [-row[0] for row in matrix])


def _middle(words: Words) -> Probe:
    """Return the middle of all ranges, and zero for what varies and may be zero."""
    found, book = at_rest(words), words.vocabulary
    for q in book.given():
        twice = q.ends[0] + q.ends[1]
        if q.shape == () and found.values[book.symbols[q.name]] != 0:
            found.values[book.symbols[q.name]] = mpf(twice.numerator) / (2 * twice.denominator)
    return Probe(found.values)


def _own_rows(mass: Matrix, balances: Balances) -> list[tuple[int, int]]:
    """Return for each free coordinate the row that is its own, and the sign of its mass there."""
    probe = random_probe(balances.frames.words, 0)
    size = mass.shape[0]
    values = [[probe.value(mass[i, k]) for k in range(size)] for i in range(size)]
    graph = nx.Graph()
    with mp.workdps(DIGITS):
        graph.add_edges_from(
            (("row", i), ("column", k), {"weight": int(mp.log(abs(x)) * WHOLE)})
            for i, row in enumerate(values) for k, x in enumerate(row) if x
        )  # fmt: skip
    mates = {}
    for pair in nx.max_weight_matching(graph, maxcardinality=True):
        column, row = sorted(pair)
        mates[column[1]] = row[1]
    if len(mates) < size:
        return [(i, 1) for i in range(size)]  # something moves without mass: no row is its own
    return [(mates[k], 1 if values[mates[k]][k] > 0 else -1) for k in range(size)]


def _in_order(matrix: Matrix, own: Sequence[tuple[int, int]]) -> Matrix:
    return Matrix.vstack(*(matrix.row(i) * sign for i, sign in own))


@dataclass
class Expansion:
    """Values and first derivatives of named quantities at the given motion."""

    base: Mapping[Symbol, Expr]
    variables: Sequence[Symbol]

    def __post_init__(self) -> None:
        """Begin with the variables themselves."""
        one = Integer(1)
        self.known = {s: Small(v, {s: one} if s in self.variables else {})
                      for s, v in self.base.items()}  # fmt: skip

    def define(self, definitions: Mapping[Symbol, Expr]) -> None:
        """Expand named quantities, in order."""
        for symbol, value in definitions.items():
            self.known[symbol] = self.expanded(value)

    def expanded(self, e: Expr) -> Small:
        """Return an expression's value and derivatives at the given motion."""
        values = {s: self.known[s].value for s in e.free_symbols if s in self.known}
        slopes: dict[Symbol, Expr] = {}
        for s in sorted(values, key=str):
            if self.known[s].slopes:
                partial = e.diff(s).xreplace(values)
                for v, slope in self.known[s].slopes.items():
                    slopes[v] = slopes.get(v, Integer(0)) + partial * slope
        return Small(e.xreplace(values), {v: s for v, s in slopes.items() if s != 0})


@dataclass
class _Eliminated:
    """Balances expanded at the given motion, and the reactions that are eliminated from them."""

    balances: Balances
    small: Expansion
    rows: Sequence[Expr]
    reactions: Sequence[Symbol]

    def __post_init__(self) -> None:
        """Expand rests and coefficients; find the reactions of the given motion."""
        split = self.balances.frames.sheet.split
        parts = [split(row) for row in self.rows]
        self.rests = [self.small.expanded(rest) for rest, _ in parts]
        self.by = [{u: self.small.expanded(c) for u, c in slopes.items()} for _, slopes in parts]
        nothing = Small(Integer(0), {})
        self.held = Matrix(len(self.rows), len(self.reactions), lambda i, k:
                           self.by[i].get(self.reactions[k], nothing).value)  # fmt: skip
        self.pivots = self._pivots()
        self.others = [n for n in range(len(self.rows)) if n not in self.pivots]
        self.forces: list[Expr] = []
        if self.reactions:
            right = Matrix([-self.rests[n].value for n in self.pivots])
            self.forces = list(
                self.held.extract(self.pivots, range(len(self.reactions))).LUsolve(right)
            )

    def _pivots(self) -> list[int]:
        probe = random_probe(self.balances.frames.words, 0)
        matrix = [{k: probe.value(self.held[n, k]) for k in range(len(self.reactions))
                  if self.held[n, k] != 0} for n in range(len(self.rows))]  # fmt: skip
        return independent(matrix, len(self.reactions))

    def coefficients(self, unknowns: Sequence[Symbol]) -> Matrix:
        """Return the coefficients of the accelerations."""
        nothing = Small(Integer(0), {})
        return Matrix(len(self.rows), len(unknowns),
                      lambda i, k: self.by[i].get(unknowns[k], nothing).value)  # fmt: skip

    def slopes(self, variables: Sequence[Symbol | None]) -> Matrix:
        """Return the derivatives of the rows by small variables, reactions held."""
        found = zeros(len(self.rows), len(variables))
        for i, rest in enumerate(self.rests):
            for k, v in enumerate(variables):
                if v is not None:
                    found[i, k] = rest.slopes.get(v, Integer(0)) + self._by_reactions(i, v)
        return found

    def _by_reactions(self, i: int, v: Symbol) -> Expr:
        total: Expr = Integer(0)
        for u, force in zip(self.reactions, self.forces, strict=True):
            if u in self.by[i]:
                total += self.by[i][u].slopes.get(v, Integer(0)) * force
        return total

    def reduced(self, columns: Matrix) -> Matrix:
        """Return the rows that are left when changes of the reactions are eliminated."""
        if not self.reactions:
            return columns
        every, across = range(columns.shape[1]), range(len(self.reactions))
        own = self.held.extract(self.pivots, across)
        change = own.LUsolve(columns.extract(self.pivots, every))
        return columns.extract(self.others, every) - self.held.extract(self.others, across) * change
