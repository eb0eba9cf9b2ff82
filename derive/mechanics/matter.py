"""What an answer does not depend on, found at trial points, and taken out of the equations.

A quantity that is changed without any answer changing does not matter: a number takes its place.
The programs that follow are proved against the equations in which it still stands.
"""

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from typing import Any

from mpmath import mp, mpf
from sympy import Expr, Integer, Symbol

from derive.mechanics.probe import DIGITS, NOTHING, PROBES, Probe, random_probe
from derive.mechanics.problem import Problem, answered, substituted
from derive.mechanics.words import Words
from derive.scene import SceneError

STAND_INS = (0, 1, 2, 3)
OTHERS = 7919  # where trial points begin that share nothing with the first


@dataclass(frozen=True)
class Lean:
    """A problem without what does not matter, the symbols taken out, and what was put for all."""

    problem: Problem
    cancelled: tuple[Symbol, ...]
    taken: Mapping[Symbol, Expr]


def lean(problem: Problem, words: Words) -> Lean:
    """Return ``problem`` without the arguments that its answers do not depend on.

    Raises SceneError if an answer depends on data that the user left out.
    """
    here = [random_probe(words, n) for n in range(PROBES)]
    there = [random_probe(words, n + OTHERS).values for n in range(PROBES)]
    own = [_answers(problem, probe.values) for probe in here]
    if None in own:
        raise SceneError(f"'{problem.name}' has no answer at a trial point: "
                         "its balances are singular there")  # fmt: skip

    def stay(changed: Sequence[dict[Symbol, Any]]) -> bool:
        each = zip(own, here, changed, strict=True)
        return all(_same(one, _changed(problem, probe, more)) for one, probe, more in each)

    for probe in here:
        probe.define(problem.definitions)
    arguments = sorted(problem.arguments(), key=str)
    idle = [s for s in arguments if stay([{s: values[s]} for values in there])]
    for symbol, what in words.hidden.items():
        if symbol in arguments and symbol not in idle:
            raise SceneError(f"'{problem.name}' depends on {what}, which is not given")
    taken: dict[Symbol, Expr] = {}
    for symbol in idle:
        for number in STAND_INS:
            held = {s: mpf(int(x)) for s, x in (taken | {symbol: Integer(number)}).items()}
            if stay([held] * PROBES):
                taken[symbol] = Integer(number)
                break
    current = substituted(problem, taken)
    shown = tuple(s for s in idle if s in taken and s not in words.hidden)
    return Lean(current, shown, taken)


def _answers(problem: Problem, values: Mapping[Symbol, Any]) -> list[Any] | None:
    with mp.workdps(DIGITS):
        try:
            probe = Probe(dict(values))
            named = problem.definitions.items()
            probe.define({s: e for s, e in named if s not in probe.values})
            return answered(problem, probe)
        except ZeroDivisionError:
            return None


def _changed(problem: Problem, probe: Probe, more: Mapping[Symbol, Any]) -> list[Any] | None:
    """Return the answers where some values are others than at a point, all named values known."""
    other = set(more)
    for symbol, value in problem.definitions.items():
        if not other.isdisjoint(value.free_symbols):
            other.add(symbol)
    kept = {s: x for s, x in probe.values.items() if s not in other}
    return _answers(problem, kept | dict(more))


def _same(first: list[Any] | None, second: list[Any] | None) -> bool:
    if first is None or second is None:
        return False
    return all(
        abs(a - b) <= NOTHING * max(abs(a), abs(b)) for a, b in zip(first, second, strict=True)
    )


def without_factors(problem: Problem, words: Words, sought: AbstractSet[Symbol]) -> Problem:
    """Return a problem of what vanishes without the parameters that only multiply it.

    sought : what it vanishes at, which is kept; so is a state: sines of angles have roots too; and
             so is a parameter that may be 0, where everything vanishes

    A factor moves no root: with it and without it the answers at two points are in one ratio.
    """
    taken: dict[Symbol, Expr] = {}
    fixed = words.vocabulary.fixed()
    for symbol in sorted((problem.arguments() & fixed) - sought, key=str):
        if symbol.is_positive and _is_factor(problem, words, symbol):
            taken[symbol] = Integer(1)
    return substituted(problem, taken)


def _is_factor(problem: Problem, words: Words, symbol: Symbol) -> bool:
    first, second = (random_probe(words, n).values for n in range(PROBES))
    here, there, once, twice = (
        _answers(problem, values | {symbol: mpf(x)}) for x in (2, 3) for values in (first, second)
    )
    if here is None or there is None or once is None or twice is None:
        return False
    with mp.workdps(DIGITS):
        left = [a * d for a, d in zip(here, twice, strict=True)]
        right = [b * c for b, c in zip(there, once, strict=True)]
    return _same(left, right)
