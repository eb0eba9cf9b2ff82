"""The solution of a function's balances, for readers: what the balances leave together, resolved.

It is the plain way to compute them, by quotients, determinants and pivots, without what makes code
cheap; the emitted programs go their own ways, and both satisfy the same balances.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace

from sympy import Expr, Symbol

from derive.emit.page.equation import for_readers, written_equations
from derive.library.library import Library
from derive.lower.arrange.block import Solution
from derive.lower.arrange.pivots import pivots
from derive.lower.arrange.plan import constants
from derive.lower.arrange.solve import solve

SHORT = 6
"""Operations of what is put into those that use it."""


def resolved(library: Library, base: str) -> dict[Symbol, Expr]:
    """Return what the answers need of the unknowns, and what stands between, each after its parts.

    Unknowns that stand alone on the left of their balance are solved there, and left out.
    """
    known = library.mechanism
    own, written = known.posed(base), written_equations(known, base)
    if not written.rows:
        return {}
    problem = replace(for_readers(known, base), definitions=written.named, rows=written.rows)
    found = Solution(constants(problem, own.vocabulary), pivots(own.words, problem.definitions))
    solve(found, problem.parts, problem.unknowns, ())
    each = _put_in({d.symbol: d.value for d in found.definitions}, frozenset(problem.unknowns))
    alone = {left for _, lines in written.groups for _, left, _ in lines}
    return _read({s: v for s, v in each.items() if s not in alone}, written.answers.values())


def _read(values: Mapping[Symbol, Expr], ends: Iterable[Expr]) -> dict[Symbol, Expr]:
    """Return those values that others, or the ends, are made of, in their order."""
    read = {s for e in ends for s in e.free_symbols}
    kept: dict[Symbol, Expr] = {}
    for symbol, value in reversed(list(values.items())):
        if symbol in read:
            kept[symbol] = value
            read |= value.free_symbols
    return dict(reversed(kept.items()))


def _put_in(values: Mapping[Symbol, Expr], kept: frozenset[Symbol]) -> dict[Symbol, Expr]:
    """Return values with what is short, or one over another, put into those that use it."""
    short: dict[Expr, Expr] = {}
    found: dict[Symbol, Expr] = {}
    for symbol, value in values.items():
        whole = value.xreplace(short)
        if symbol not in kept and (whole.count_ops() <= SHORT or (1 / whole).is_Symbol):
            short[symbol] = whole
        else:
            found[symbol] = whole
    return found
