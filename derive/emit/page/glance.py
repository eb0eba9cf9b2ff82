"""What a function answers, at a glance: the closed forms of a terminal, where these are short."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from sympy import Symbol

from derive.emit.equations.fitted import TwoSides
from derive.emit.equations.naming import Book, with_names
from derive.emit.equations.section import Paragraph, Section, of_parts, outline, section
from derive.emit.notation import equation_mathml, sympy_equation_mathml
from derive.emit.page.equation import is_short
from derive.library.library import Library

MOST = 4
"""Lines that are taken in at a glance."""


def at_a_glance(library: Library, base: str) -> list[str]:
    """Return the closed forms of a function's answers, or the law that they come from.

    An answer that is given or zero says nothing; what it is made of stands before it.
    """
    first = outline(library, base)
    one = with_names(_answers(library, base) if first.is_long else section(library, base), Book())
    shown = [] if first.is_long else short_forms(one, MOST)
    if shown:
        return [sympy_equation_mathml(left, right, one.names) for left, right in shown]
    return [*_sums(one), *_laws(first.parts if first.is_long else one.parts)]


def _answers(library: Library, base: str) -> Section:
    """Return the lines of answers alone, as they are first written."""
    first = outline(library, base)
    own = (replace(part, equations=tuple(e for e in part.equations if e[0] in first.answers))
           for part in first.parts)  # fmt: skip
    return of_parts(library, base, tuple(part for part in own if part.equations))


def _sums(one: Section) -> list[str]:
    """Return the lines of answers that are sums of others."""
    defined = _defined(one)
    ends = [defined[s] for s in one.answers.values() if s in defined]
    every = (e for e in ends if e[1].is_Add and all(term.is_Symbol for term in e[1].args))
    return [sympy_equation_mathml(*e, one.names) for e in every]


def _laws(parts: Sequence[Paragraph]) -> list[str]:
    """Return the laws that equations come from: of balances one says all."""
    parts = [part for part in parts if part.equations]
    parts = sorted(parts, key=lambda part: part.kind != "balance")
    steps = [step for part in parts for step in part.steps]
    one_says_all = bool(parts) and parts[0].kind == "balance"
    laws = [s for n, s in enumerate(steps) if s not in steps[:n]][: 1 if one_says_all else MOST]
    return [*map(equation_mathml, laws)]


def short_forms(one: Section, most: int) -> list[TwoSides]:
    """Return the closed forms of as many answers as fit on so many lines, where these are short."""
    defined, shown = _defined(one), dict[TwoSides, None]()
    for symbol in one.answers.values():
        chain = _chain(symbol, defined, set())
        whole = {**shown, **dict.fromkeys(chain)}
        if len(whole) <= most and all(is_short(right) for _, right in chain):
            shown = whole
    return [*shown]


def _defined(one: Section) -> dict[Symbol, TwoSides]:
    return {left: (left, right) for left, right in one.equations if one.assigns((left, right))}


def _chain(symbol: Symbol, defined: Mapping[Symbol, TwoSides], seen: set[Symbol]) -> list[TwoSides]:
    """Return the equations that a symbol stands on, its own last, each once.

    seen : symbols whose equations are not asked for again; one that is zero or given has none
    """
    if symbol not in defined or symbol in seen or defined[symbol][1] == 0:
        return []
    seen.add(symbol)
    sides = defined[symbol]
    below = sorted(sides[1].free_symbols & defined.keys(), key=str)
    return [*(line for s in below for line in _chain(s, defined, seen)), sides]
