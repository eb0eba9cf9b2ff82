"""A wanted function as a problem: answers, the balances they need, the named quantities below.

The reference solves it as it stands; how to compute its answers cheaply is left to arrangement,
and a program is right if it satisfies the problem.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from mpmath import mp, mpf
from sympy import Expr, Symbol

from derive.mechanics.balance import Balance
from derive.mechanics.probe import DIGITS, Probe, solved
from derive.mechanics.sheet import Split, below, split
from derive.program.program import Quantity


@dataclass(frozen=True)
class Problem:
    """Outputs with their values in named quantities and unknowns, and rows that are zero."""

    name: str
    says: str
    outputs: tuple[Quantity, ...]
    answers: Mapping[Symbol, Expr]
    definitions: Mapping[Symbol, Expr]
    rows: tuple[Expr, ...]
    unknowns: tuple[Symbol, ...]
    balances: tuple[Balance, ...]
    steps: tuple[str, ...]

    @property
    def sought(self) -> tuple[Symbol, ...]:
        """Return all that the residuals determine: named quantities, unknowns, answers."""
        answers = (s for s in self.answers if s not in self.unknowns)
        return (*self.definitions, *self.unknowns, *answers)

    @property
    def residuals(self) -> tuple[Expr, ...]:
        """Return expressions that are zero, linear in what is sought."""
        named = (value - s for s, value in self.definitions.items())
        answers = (value - s for s, value in self.answers.items() if s not in self.unknowns)
        return (*named, *self.rows, *answers)

    @cached_property
    def parts(self) -> tuple[Split, ...]:
        """Return of each row the part without unknowns, and each unknown's coefficient."""
        unknowns = frozenset(self.unknowns)
        return tuple(split(row, unknowns) for row in self.rows)

    def expressions(self) -> tuple[Expr, ...]:
        """Return all that the answers are made of, definitions apart."""
        return (*self.rows, *self.answers.values())

    def arguments(self) -> frozenset[Symbol]:
        """Return every symbol that is given: not named, not unknown, no output."""
        used = {
            s for e in (*self.expressions(), *self.definitions.values()) for s in e.free_symbols
        }
        return frozenset(used - set(self.definitions) - set(self.unknowns) - set(self.answers))


def answered(problem: Problem, probe: Probe) -> list[Any]:
    """Return the answers at a trial point.

    Raises ZeroDivisionError where the balances are singular.
    """
    with mp.workdps(DIGITS):
        found = dict(probe.values)
        if problem.rows:
            matrix = [[probe.value(slopes[u]) if u in slopes else mpf(0)
                       for u in problem.unknowns] for _, slopes in problem.parts]  # fmt: skip
            right = [-probe.value(rest) for rest, _ in problem.parts]
            found |= dict(zip(problem.unknowns, solved(matrix, right), strict=True))
        there = Probe(found)
        return [there.value(e) for e in problem.answers.values()]


def substituted(problem: Problem, values: Mapping[Symbol, Expr]) -> Problem:
    """Return the problem with symbols replaced, and named quantities that became plain put in."""
    known, definitions = dict(values), dict[Symbol, Expr]()
    for symbol, value in problem.definitions.items():
        made = value.xreplace(known)
        if made.is_Symbol or made.is_Number or (-made).is_Symbol:
            known[symbol] = made
        else:
            definitions[symbol] = made
    rows = tuple(row.xreplace(known) for row in problem.rows)
    answers = {s: e.xreplace(known) for s, e in problem.answers.items()}
    kept = below(definitions, [*rows, *answers.values()])
    return replace(problem, definitions=kept, rows=rows, answers=answers)
