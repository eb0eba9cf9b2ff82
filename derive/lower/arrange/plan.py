"""A machine's arrangements: named quantities, solved balances, answers, in this order.

Beside the plain way stand those that rules find; which is the cheapest is found out afterwards, and
the proof puts its program into the equations as they were.
"""

from collections.abc import Iterable, Iterator, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field, replace

from sympy import Expr, Symbol

from derive.lower.arrange.arrangement import Arrangement, Definition
from derive.lower.arrange.block import BlockRule, Solution
from derive.lower.arrange.column import (
    ColumnRule,
    NamedColumns,
    in_answers,
    in_definitions,
    in_rows,
)
from derive.lower.arrange.constant_coefficients import constant_coefficients
from derive.lower.arrange.constant_tensor import constant_tensor
from derive.lower.arrange.pivots import pivots
from derive.lower.arrange.quaternion import quaternion_rate, turned_by_quaternion
from derive.lower.arrange.solve import solve
from derive.lower.arrange.spherical_part import spherical_part
from derive.lower.arrange.tidy import (
    MANY_TERMS,
    shortened,
    sums_in_common,
    term_count,
    tidied,
    with_like_terms,
    without_constants,
    without_squares,
)
from derive.lower.arrange.turns import turns_one_by_one
from derive.mechanics.by_links import by_links
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.problem import Problem
from derive.mechanics.vocabulary import Vocabulary
from derive.scene import SceneError

OF_COLUMNS: tuple[ColumnRule, ...] = (turns_one_by_one, turned_by_quaternion, spherical_part)
OF_ANSWERS: tuple[ColumnRule, ...] = (quaternion_rate,)
OF_ROWS: tuple[ColumnRule, ...] = (spherical_part,)
OF_BLOCKS: tuple[BlockRule, ...] = (constant_tensor, constant_coefficients)
LONGEST_ROW = (
    400  # terms of a balance: beyond, it is not solved as it stands if there is another way
)
MOST_UNKNOWNS = 13
"""Of balances of constraints, solved as they stand if there is another way: as Peaucellier's."""
MOST_TERMS = 60  # of a named quantity that rules have found; its users may multiply it out


@dataclass(frozen=True)
class Way:
    """A problem in some words, the rules its balances are solved by, what components share.

    most : a named quantity of more terms is not multiplied out by its users
    """

    problem: Problem
    rules: tuple[BlockRule, ...] = ()
    families: Mapping[Symbol, str] = field(default_factory=dict)
    most: int = MANY_TERMS


def arrange(mechanism: Mechanism, problem: Problem) -> tuple[Arrangement, ...]:
    """Return the ways to compute the outputs of ``problem``, the plain one first."""
    own = mechanism.posed(problem.name)
    lean = prepared(own, own.lean(problem.name).problem)
    answers = tuple(lean.answers.values())
    recursive = tuple(
        Arrangement(_cut(way, lean.unknowns), answers, how, implied)
        for how, way, implied in by_links(own, problem.name)
    )
    many = own.scene.constraints and len(lean.unknowns) > MOST_UNKNOWNS
    if recursive and (many or _longest(lean) > LONGEST_ROW):
        return recursive
    ways = (Way(lean), _ruled(own, lean), _written_out(own, lean))
    try:
        plain = [_arranged(own, way) for way in ways]
    except SceneError:
        if not recursive:
            raise
        plain = []  # a pivot vanishes wherever it is taken, and masses have none that does
    return tuple(dict.fromkeys((*plain, *recursive)))


def _cut(way: Mapping[Symbol, Expr], unknowns: Iterable[Symbol]) -> tuple[Definition, ...]:
    """Return values as they are to be computed, none multiplied out but those of unknowns."""
    free = frozenset(unknowns)
    return tuple(Definition("let" if s in free else "cut", s, e) for s, e in way.items())


def _longest(problem: Problem) -> int:
    """Return how many terms the longest balance has when it is multiplied out."""
    sizes: dict[Symbol, int] = {}
    for symbol, value in problem.definitions.items():
        sizes[symbol] = term_count(value, sizes)
    return max((term_count(row, sizes) for row in problem.rows), default=0)


def plain_arrangement(mechanism: Mechanism, problem: Problem) -> Arrangement:
    """Return the definitions of a problem by what serves every problem."""
    return _arranged(mechanism, Way(prepared(mechanism, problem)))


def prepared(mechanism: Mechanism, problem: Problem) -> Problem:
    """Return a problem without names of short constants, and no longer than it need be."""
    problem = without_constants(problem, mechanism.vocabulary.fixed())
    return tidied(problem, without_squares)


def _ruled(mechanism: Mechanism, problem: Problem) -> Way:
    """Return a problem with its columns rewritten by rules, then its like terms gathered."""
    vocabulary = mechanism.vocabulary
    attitudes = [vocabulary.column(q.name) for q in vocabulary.states if q.is_quaternion]
    own = NamedColumns(constants(problem, vocabulary), attitudes)
    for rule in OF_COLUMNS:
        problem = in_definitions(problem, rule, own)
    for rule in OF_ANSWERS:
        problem = in_answers(problem, rule, own, 4)
    for rule in OF_ROWS:
        problem = in_rows(problem, rule, own)
        problem = in_answers(problem, rule, own, 3)
    problem = tidied(problem, lambda e: with_like_terms(e, own.constant))
    return Way(problem, OF_BLOCKS, own.families, MOST_TERMS)


def _written_out(mechanism: Mechanism, problem: Problem) -> Way:
    """Return a problem without named quantities wherever its rows stay short."""
    constant = constants(problem, mechanism.vocabulary)
    return Way(shortened(problem, constant), OF_BLOCKS)


def _arranged(mechanism: Mechanism, way: Way) -> Arrangement:
    """Return the definitions of a problem: named quantities, solved balances, answers."""
    problem, of = way.problem, way.families
    definitions = [
        Definition("let", s, value, of.get(s, "")) for s, value in problem.definitions.items()
    ]
    if problem.rows:
        own = pivots(mechanism.words, problem.definitions)
        found = Solution(constants(problem, mechanism.vocabulary), own)
        solve(found, problem.parts, problem.unknowns, way.rules)
        definitions += found.definitions
    sums = sums_in_common(problem.answers.values(), constants(problem, mechanism.vocabulary))
    definitions += [Definition("cut", s, value) for s, value in sums.items()]
    names = {value: s for s, value in sums.items()}
    answers = tuple(e.xreplace(names) for e in problem.answers.values())
    used = [definition.value for definition in definitions] + [
        e for e in answers if not e.is_Symbol
    ]
    done = {s for e in used for s in e.free_symbols if s in answers}
    return Arrangement(tuple(with_cuts(definitions, way.most, done)), answers)


def constants(problem: Problem, vocabulary: Vocabulary) -> frozenset[Symbol]:
    """Return the symbols of a problem that rest on parameters only."""
    found = set(vocabulary.fixed())
    for symbol, value in problem.definitions.items():
        if value.free_symbols <= found:
            found.add(symbol)
    return frozenset(found)


def with_cuts(
    definitions: Iterable[Definition], most: int, done: AbstractSet[Symbol]
) -> Iterator[Definition]:
    """Yield named quantities, those cut off that would multiply out to more than ``most`` terms.

    done : what is computed in any case, and so is cut off too
    """
    sizes: dict[Symbol, int] = {}
    for definition in definitions:
        size = term_count(definition.value, sizes)
        kind = "cut" if size > most or definition.symbol in done else definition.kind
        sizes[definition.symbol] = 1 if kind == "cut" else size
        yield replace(definition, kind=kind)
