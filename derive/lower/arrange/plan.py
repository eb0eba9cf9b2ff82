"""A machine's arrangements: named quantities, solved balances, answers, in this order.

Beside the plain way stand those that rules find; which is the cheapest is found out afterwards, and
the proof puts its program into the equations as they were.
"""

from collections.abc import Iterable, Iterator, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field, replace

from sympy import Symbol

from derive.lower.arrange.block import Rule, Solution
from derive.lower.arrange.column import Known, in_answers, in_definitions, in_rows
from derive.lower.arrange.column import Rule as ColumnRule
from derive.lower.arrange.constant_coefficients import constant_coefficients
from derive.lower.arrange.constant_tensor import constant_tensor
from derive.lower.arrange.draft import Arrangement, Stage
from derive.lower.arrange.quaternion import quaternion_rate, turned_by_quaternion
from derive.lower.arrange.solve import solve
from derive.lower.arrange.spherical_part import spherical_part
from derive.lower.arrange.tidy import (
    MANY_TERMS,
    sums_in_common,
    terms,
    tidied,
    with_like_terms,
    without_constants,
    without_squares,
    written_out,
)
from derive.lower.arrange.turns import turns_one_by_one
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.pivots import Pivots
from derive.mechanics.probe import point
from derive.mechanics.problem import Problem
from derive.mechanics.sweep import ranges
from derive.mechanics.vocabulary import Vocabulary

OF_COLUMNS: tuple[ColumnRule, ...] = (turns_one_by_one, turned_by_quaternion, spherical_part)
OF_ANSWERS: tuple[ColumnRule, ...] = (quaternion_rate,)
OF_ROWS: tuple[ColumnRule, ...] = (spherical_part,)
OF_BLOCKS: tuple[Rule, ...] = (constant_tensor, constant_coefficients)
MOST_TERMS = 60  # of a named quantity that rules have found; its users may multiply it out


@dataclass(frozen=True)
class Way:
    """A question in some words, the rules its balances are solved by, what components share.

    most : a named quantity of more terms is not multiplied out by its users
    """

    question: Problem
    rules: tuple[Rule, ...] = ()
    families: Mapping[Symbol, str] = field(default_factory=dict)
    most: int = MANY_TERMS


def arrange(known: Mechanism, fact: Problem) -> tuple[Arrangement, ...]:
    """Return the ways to compute the outputs of ``fact``, the plain one first."""
    known = known.posed(fact.name)
    question = prepared(known, known.lean(fact.name).question)
    ways = (Way(question), _ruled(known, question), _written_out(known, question))
    return tuple(dict.fromkeys(_arranged(known, way) for way in ways))


def plain_arrangement(known: Mechanism, question: Problem) -> Arrangement:
    """Return the stages of a question by what serves every question."""
    return _arranged(known, Way(prepared(known, question)))


def prepared(known: Mechanism, question: Problem) -> Problem:
    """Return a question without names of short constants, and no longer than it need be."""
    question = without_constants(question, parameters(known.words))
    return tidied(question, known.made.sheet, without_squares)


def _ruled(known: Mechanism, question: Problem) -> Way:
    """Return a question with its columns rewritten by rules, then its like terms gathered."""
    sheet, words = known.made.sheet, known.words
    attitudes = [words.column(q.name) for q in words.states if q.is_quaternion]
    own = Known(constants(question, words), attitudes)
    for rule in OF_COLUMNS:
        question = in_definitions(question, rule, own)
    for rule in OF_ANSWERS:
        question = in_answers(question, rule, own, 4)
    for rule in OF_ROWS:
        question = in_rows(question, sheet, rule, own)
        question = in_answers(question, rule, own, 3)
    question = tidied(question, sheet, lambda e: with_like_terms(e, own.constant))
    return Way(question, OF_BLOCKS, own.families, MOST_TERMS)


def _written_out(known: Mechanism, question: Problem) -> Way:
    """Return a question without named quantities wherever its rows stay short."""
    constant = constants(question, known.words)
    return Way(written_out(question, known.made.sheet, constant), OF_BLOCKS)


def _arranged(known: Mechanism, way: Way) -> Arrangement:
    """Return the stages of a question: named quantities, solved balances, answers."""
    question, of = way.question, way.families
    stages = [Stage("let", s, value, of.get(s, "")) for s, value in question.definitions.items()]
    if question.rows:
        probe = point(known.made, 0)
        probe.define(question.definitions)
        pivots = Pivots(ranges(known.made), question.definitions, known.made.sheet.label)
        found = Solution(constants(question, known.words), probe, pivots)
        solve(found, question.rows, question.unknowns, known.made.sheet.split, way.rules)
        stages += found.stages
    sums = sums_in_common(question.answers.values(), constants(question, known.words))
    stages += [Stage("cut", s, value) for s, value in sums.items()]
    names = {value: s for s, value in sums.items()}
    answers = tuple(e.xreplace(names) for e in question.answers.values())
    used = [stage.value for stage in stages] + [e for e in answers if not e.is_Symbol]
    done = {s for e in used for s in e.free_symbols if s in answers}
    return Arrangement(tuple(staged(stages, way.most, done)), answers)


def parameters(words: Vocabulary) -> frozenset[Symbol]:
    """Return the symbols of all parameters."""
    return frozenset(words.symbols[c] for q in words.parameters for c in q.components)


def constants(question: Problem, words: Vocabulary) -> frozenset[Symbol]:
    """Return the symbols of a question that rest on parameters only."""
    found = set(parameters(words))
    for symbol, value in question.definitions.items():
        if value.free_symbols <= found:
            found.add(symbol)
    return frozenset(found)


def staged(stages: Iterable[Stage], most: int, done: AbstractSet[Symbol]) -> Iterator[Stage]:
    """Yield named quantities, those cut off that would multiply out to more than ``most`` terms.

    done : what is computed in any case, and so is cut off too
    """
    sizes: dict[Symbol, int] = {}
    for stage in stages:
        size = terms(stage.value, sizes)
        kind = "cut" if size > most or stage.symbol in done else stage.kind
        sizes[stage.symbol] = 1 if kind == "cut" else size
        yield replace(stage, kind=kind)
