"""A problem in fewer words: like terms gathered, sin^2 + cos^2 = 1, constants without names."""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import replace
from math import prod

from sympy import Add, Expr, Mul, Pow, Symbol, factor_terms, sin

from derive.lecture.turning import reduced
from derive.lower.arrange.block import unused_symbol
from derive.lower.arrange.like_terms import gathered
from derive.mechanics.problem import Problem, substituted
from derive.mechanics.sheet import Split

LONGEST = 150  # operations of a term that is multiplied out
MANY_TERMS = 10  # a named quantity of more terms is not multiplied out by its users


def without_constants(problem: Problem, parameters: AbstractSet[Symbol]) -> Problem:
    """Return the problem without names for short sums of parameters: set-up finds them itself."""
    known: dict[Symbol, Expr] = {}
    for symbol, value in problem.definitions.items():
        made = value.xreplace(known)
        if made.free_symbols <= parameters and term_count(made, {}) <= MANY_TERMS:
            known[symbol] = min(made, factor_terms(made), key=lambda form: form.count_ops())
    return substituted(problem, known)


def tidied(problem: Problem, shorter: Callable[[Expr], Expr]) -> Problem:
    """Return the problem with every term in shorter words."""
    rows = [shorter(rest) + sum(shorter(c) * u for u, c in slopes.items())
            for rest, slopes in problem.parts]  # fmt: skip
    made = replace(
        problem,
        definitions={s: shorter(e) for s, e in problem.definitions.items()},
        rows=tuple(rows),
        answers={s: shorter(e) for s, e in problem.answers.items()},
    )
    return substituted(made, {})


def without_squares(e: Expr) -> Expr:
    """Return a term with sin^2 = 1 - cos^2 if that is shorter."""
    if not e.has(sin) or e.count_ops() > LONGEST:
        return e
    other = reduced(e)
    return other if other.count_ops() < e.count_ops() else e


def with_like_terms(e: Expr, constant: AbstractSet[Symbol]) -> Expr:
    """Return a sum with its like terms gathered if that takes fewer operations."""
    if not isinstance(e, Add) or e.count_ops() > LONGEST:
        return e
    return min(e, gathered(e, constant), key=lambda form: _operations(form, constant))


def shortened(problem: Problem, constant: AbstractSet[Symbol]) -> Problem:
    """Return the problem with rows in what is given, sin^2 = 1 - cos^2, like terms gathered."""

    def short(e: Expr) -> Expr:
        whole = in_what_is_given(problem, e, constant)
        return e if whole is None else gathered(reduced(whole), constant)

    rows = [sum((c * u for u, c in slopes.items()), rest) for rest, slopes in (
        primitive(problem, (short(rest), slopes), constant) for rest, slopes in problem.parts
    )]  # fmt: skip
    answers = {s: short(e) for s, e in problem.answers.items()}
    return substituted(replace(problem, rows=tuple(rows), answers=answers), {})


def primitive(problem: Problem, row: Split, constant: AbstractSet[Symbol]) -> Split:
    """Return a balance without the powers of parameters that all its terms have in common.

    They stay where a term is too long to be looked into, where there are none, and where the
    range of a parameter holds 0, at which the balance would say nothing.
    """
    parts = [in_what_is_given(problem, e, constant) for e in (row[0], *row[1].values())]
    terms = [term for e in parts if e is not None for term in Add.make_args(e) if term != 0]
    if None in parts or not terms:
        return row
    powers = [term.as_powers_dict() for term in terms]
    above = (s for s in constant & powers[0].keys() if s.is_positive)
    common = {s: min(own[s] for own in powers) for s in above}
    shared = Mul(*(s**p for s, p in common.items() if p > 0))
    if shared == 1:
        return row
    rest, *slopes = (gathered(reduced((e / shared).expand()), constant) for e in parts)
    return rest, dict(zip(row[1], slopes, strict=True))


def in_what_is_given(problem: Problem, e: Expr, constant: AbstractSet[Symbol]) -> Expr | None:
    """Return an expression in what is given and constant, multiplied out; None if it is long."""
    varying = {s: value for s, value in problem.definitions.items() if s not in constant}
    while e.free_symbols & varying.keys():
        e = e.xreplace(varying)
        if e.count_ops() > LONGEST:
            return None
    return e.expand()


def _operations(e: Expr, constant: AbstractSet[Symbol]) -> int:
    """Return how many operations of an expression are not on parameters alone."""
    if e.is_Symbol or e.free_symbols <= constant:
        return 0
    varying = [a for a in e.args if not a.free_symbols <= constant]
    between = len(varying) - (len(varying) == len(e.args))
    return between + sum(_operations(a, constant) for a in varying)


def sums_in_common(answers: Iterable[Expr], constant: AbstractSet[Symbol]) -> dict[Symbol, Expr]:
    """Return names for the sums that are factors in several answers, the shortest first.

    Rates of angles hold such sums: w_y sin(phi) + w_z cos(phi) stands in two of three.

    >>> from sympy import symbols
    >>> a, b, x, y = symbols("a b x y")
    >>> sums_in_common([(a + b) * x, (a + b) / y, a - b], {x, y})
    {sum: a + b}
    """
    each = [{f for part in e.atoms(Mul) for f in part.args if f.is_Add} for e in answers]
    uses = Counter(f for own in each for f in own if not f.free_symbols <= constant)
    named: dict[Symbol, Expr] = {}
    for e in sorted((e for e, n in uses.items() if n > 1), key=lambda e: (e.count_ops(), str(e))):
        named[unused_symbol("sum", named)] = e.xreplace({value: s for s, value in named.items()})
    return named


def term_count(e: Expr, sizes: Mapping[Symbol, int]) -> int:
    """Return how many terms an expression has when it is multiplied out."""
    if isinstance(e, Add):
        return sum(term_count(part, sizes) for part in e.args)
    if isinstance(e, Mul):
        return int(prod(term_count(part, sizes) for part in e.args))
    if isinstance(e, Pow) and e.exp.is_Integer and e.exp > 0:
        return int(term_count(e.base, sizes) ** min(int(e.exp), 4))
    return sizes.get(e, 1)
