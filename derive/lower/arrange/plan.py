"""A machine's arrangement: named quantities, solved balances, answers, in this order."""

from collections.abc import Mapping
from dataclasses import replace
from math import prod

from sympy import Add, Expr, Mul, Pow, Symbol, sin

from derive.lower.arrange.draft import Arrangement, Stage
from derive.lower.arrange.solve import solved
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.pivots import Pivots
from derive.mechanics.probe import point
from derive.mechanics.question import Question, substituted
from derive.mechanics.sheet import Sheet
from derive.mechanics.sweep import ranges
from derive.mechanics.truth import Truth
from derive.mechanics.turning import reduced
from derive.mechanics.vocabulary import Vocabulary

LONGEST_TIDIED = 150  # operations of a term in which squares of sines are looked for


MANY_TERMS = 10  # a named quantity of more terms is not multiplied out by its users


def arrange(known: Mechanism, fact: Truth) -> tuple[Arrangement, ...]:
    """Return the way to compute the outputs of ``fact``."""
    return (plain_arrangement(known, known.lean(fact.name).question),)


def plain_arrangement(known: Mechanism, question: Question) -> Arrangement:
    """Return the stages of a question: named quantities, solved balances, answers."""
    question = tidied(with_parameters_put_in(question, known.words), known.made.sheet)
    named = dict(question.definitions)
    if question.rows:
        probe = point(known.made, 0)
        probe.define(question.definitions)
        pivots = Pivots(ranges(known.made), question.definitions, known.made.sheet.label)
        found = solved(question.rows, question.unknowns, known.made.sheet.split, probe, pivots)
        named |= {stage.symbol: stage.value for stage in found.stages}
    outputs = tuple(question.answers.values())
    return Arrangement(tuple(staged(named)), outputs)


def with_parameters_put_in(question: Question, words: Vocabulary) -> Question:
    """Return the question without names for short sums of parameters: set-up finds them itself."""
    fixed = {words.symbols[c] for q in words.parameters for c in q.components}
    known: dict[Symbol, Expr] = {}
    for symbol, value in question.definitions.items():
        made = value.xreplace(known)
        if made.free_symbols <= fixed and _terms(made, {}) <= MANY_TERMS:
            known[symbol] = made
    return substituted(question, known)


def tidied(question: Question, sheet: Sheet) -> Question:
    """Return the question with sin^2 + cos^2 = 1 used wherever it makes a term shorter."""
    rows = []
    for row in question.rows:
        rest, slopes = sheet.split(row)
        rows.append(_shorter(rest) + sum(_shorter(c) * u for u, c in slopes.items()))
    return replace(
        question,
        definitions={s: _shorter(e) for s, e in question.definitions.items()},
        rows=tuple(rows),
        answers={s: _shorter(e) for s, e in question.answers.items()},
    )


def _shorter(e: Expr) -> Expr:
    squares = any(p.exp == 2 and isinstance(p.base, sin) for p in e.atoms(Pow))
    if not squares or e.count_ops() > LONGEST_TIDIED:
        return e
    other = reduced(e)
    return other if other.count_ops() < e.count_ops() else e


def staged(named: Mapping[Symbol, Expr]) -> list[Stage]:
    """Return the named quantities as stages; one that would multiply out to much is cut off."""
    sizes: dict[Symbol, int] = {}
    stages = []
    for symbol, value in named.items():
        size = _terms(value, sizes)
        sizes[symbol] = 1 if size > MANY_TERMS else size
        stages.append(Stage("cut" if size > MANY_TERMS else "let", symbol, value))
    return stages


def _terms(e: Expr, sizes: Mapping[Symbol, int]) -> int:
    """Return how many terms an expression has when it is multiplied out."""
    if isinstance(e, Add):
        return sum(_terms(part, sizes) for part in e.args)
    if isinstance(e, Mul):
        return int(prod(_terms(part, sizes) for part in e.args))
    if isinstance(e, Pow) and e.exp.is_Integer and e.exp > 0:
        return int(_terms(e.base, sizes) ** min(int(e.exp), 4))
    return sizes.get(e, 1)
