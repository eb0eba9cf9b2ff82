"""Columns of a problem: quantities that follow each other, and rules that rewrite them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations

from sympy import Expr, Integer, Matrix, Symbol

from derive.lower.arrange.block import unused_symbol
from derive.lower.arrange.like_terms import like_terms
from derive.lower.arrange.tidy import in_what_is_given
from derive.mechanics.problem import Problem, substituted


@dataclass
class NamedColumns:
    """What is known of symbols, and the columns that rules have named.

    constant    : what rests on parameters only
    quaternions : the components of each attitude
    named       : what the rule at work has named, since this was last taken
    families    : what components of one column share, in words of this program's own
    gathered    : the like terms of what rules have looked at
    """

    constant: frozenset[Symbol]
    quaternions: Sequence[Matrix]
    named: dict[Symbol, Expr] = field(default_factory=dict)
    families: dict[Symbol, str] = field(default_factory=dict)
    gathered: dict[Expr, Mapping[Expr, Expr]] = field(default_factory=dict)

    def like_terms(self, e: Expr) -> Mapping[Expr, Expr]:
        """Return the coefficient of every product of what varies in a sum."""
        if e not in self.gathered:
            self.gathered[e] = like_terms(e, self.constant)
        return self.gathered[e]

    def column(self, name: str, values: Matrix) -> Matrix:
        """Return a column with every component named that is not plain."""
        family = f"{name} {len(self.families)}"
        return values.applyfunc(lambda value: self._name(name, value, family))

    def _name(self, name: str, value: Expr, family: str) -> Expr:
        if value.is_Symbol or value.is_Number or (-value).is_Symbol:
            return value
        symbol = unused_symbol(name, self.families)
        self.families[symbol] = family
        self.named[symbol] = value
        return symbol

    def taken(self) -> dict[Symbol, Expr]:
        """Return what was named, and forget it."""
        found, self.named = self.named, {}
        return found


ColumnRule = Callable[[Matrix, NamedColumns], Matrix | None]
"""A column written in another way, with what is named on the way; None if there is no such way."""


def in_definitions(problem: Problem, rule: ColumnRule, columns: NamedColumns) -> Problem:
    """Return the problem with columns of named quantities rewritten wherever a rule applies."""
    done: dict[Symbol, Expr] = {}
    symbols = list(problem.definitions)
    while symbols:
        own = symbols[:3]
        values = Matrix([problem.definitions[s] for s in own])
        apart = values.free_symbols.isdisjoint(own)
        made = _rewritten(values, rule, columns) if apart else None
        new = [problem.definitions[own[0]]] if made is None else [*made]
        done |= columns.taken() | dict(zip(own, new, strict=False))
        symbols = symbols[len(new) :]
    return substituted(replace(problem, definitions=done), {})


def _rewritten(column: Matrix, rule: ColumnRule, columns: NamedColumns) -> Matrix | None:
    """Return a column rewritten, its components taken as x, y, z or as z, y, x."""
    orders = ((0, 1, 2), (2, 1, 0)) if column.rows == 3 else ()
    for order in orders:
        made = rule(column[list(order), :], columns)
        if made is not None:
            return made[list(order), :]
    return None


def in_answers(problem: Problem, rule: ColumnRule, columns: NamedColumns, size: int) -> Problem:
    """Return the problem with answers rewritten, ``size`` one after another, by a rule."""
    answers, symbols = dict(problem.answers), list(problem.answers)
    for own in (symbols[k : k + size] for k in range(len(symbols) - size + 1)):
        made = rule(Matrix([answers[s] for s in own]), columns)
        answers |= {} if made is None else dict(zip(own, made, strict=True))
    return replace(problem, answers=answers, definitions={**problem.definitions, **columns.taken()})


def in_rows(problem: Problem, rule: ColumnRule, columns: NamedColumns) -> Problem:
    """Return the problem with three of its rows rewritten, all that varies written out in them."""
    rests = [in_what_is_given(problem, rest, columns.constant) for rest, _ in problem.parts]
    short = [n for n, rest in enumerate(rests) if rest is not None and rest != 0]
    for places in combinations(short, 3):
        made = rule(Matrix([rests[n] for n in places]), columns)
        if made is None:
            continue
        rows = list(problem.rows)
        for n, e in zip(places, made, strict=True):
            rows[n] = e + sum((c * u for u, c in problem.parts[n][1].items()), Integer(0))
        definitions = {**problem.definitions, **columns.taken()}
        return substituted(replace(problem, definitions=definitions, rows=tuple(rows)), {})
    return problem
