"""Trial values: expressions valued with many digits at random points of the declared ranges.

What is zero at two such points is zero; so it is told which unknowns a balance holds, and what an
answer does not depend on. Everything that is decided here is proved again, exactly, afterwards.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from random import Random
from typing import Any

from mpmath import mp, mpf
from sympy import Add, Expr, Mul, Pow, Rational, Symbol, nan, pi, zoo

from derive.mechanics.words import Words
from derive.program.program import Quantity

DIGITS = 1500
"""So many that numbers as large and as small as a double holds count beside each other."""
NOTHING = mpf(10) ** -1000
PROBES = 2
SEED = "derive: trial values"


@dataclass
class Probe:
    """Values of symbols at one point, and of expressions as they are asked for."""

    values: dict[Symbol, Any]
    memory: dict[Expr, Any] = field(default_factory=dict)

    def value(self, e: Expr) -> Any:
        """Return the value of an expression."""
        if e in self.values:
            return self.values[e]
        if e not in self.memory:
            self.memory[e] = self._valued(e)
        return self.memory[e]

    def _valued(self, e: Expr) -> Any:
        with mp.workdps(DIGITS):
            if e is pi:
                return +mp.pi
            if e in (nan, zoo):
                raise ZeroDivisionError
            match e:
                case Rational():
                    return mpf(int(e.p)) / int(e.q)
                case Add():
                    return mp.fsum(self.value(a) for a in e.args)
                case Mul():
                    return mp.fprod(self.value(a) for a in e.args)
                case Pow():
                    return self._power(e)
            return _called(e.func.__name__, self.value(e.args[0]))

    def _power(self, e: Expr) -> Any:
        base, exponent = self.value(e.base), e.exp
        if exponent.q == 2:
            base, exponent = mp.sqrt(base), 2 * exponent
        return base ** int(exponent)

    def define(self, definitions: Mapping[Symbol, Expr]) -> None:
        """Value named quantities, in order."""
        for symbol, value in definitions.items():
            self.values[symbol] = self.value(value)


@lru_cache(maxsize=1000)
def _called(function: str, x: Any) -> Any:
    with mp.workdps(DIGITS):
        return getattr(mp, function)(x)


def random_probe(words: Words, number: int) -> Probe:
    """Return random values of all arguments and of the data left out."""
    if number not in words.trials:
        words.trials[number] = _drawn(words, number)
    return Probe(dict(words.trials[number]))


def _drawn(words: Words, number: int) -> dict[Symbol, Any]:
    dice = Random(f"{SEED} {number}")  # noqa: S311 - trial values, no secret
    book = words.vocabulary
    values: dict[Symbol, Any] = {}
    with mp.workdps(DIGITS):
        for q in book.given():
            own = [_within(dice, q) for _ in q.components]
            size = mp.sqrt(mp.fsum(x * x for x in own)) if q.is_quaternion else mpf(1)
            values |= {book.symbols[c]: x / size for c, x in zip(q.components, own, strict=True)}
        for symbol in words.hidden:
            values[symbol] = _between(dice, mpf(1), mpf(2))
    return values


def vanishes(words: Words, value: Expr) -> bool:
    """Tell whether a value is zero whatever a machine does, and its unknowns are."""
    rest, slopes = words.sheet.split(value)
    for number in range(PROBES):
        probe = random_probe(words, number)
        probe.define(words.sheet.needed([value]))
        if any(abs(probe.value(part)) > NOTHING for part in (rest, *slopes.values())):
            return False
    return True


def at_rest(words: Words) -> Probe:
    """Return the first trial point with everything that varies at zero where it may be zero."""
    found, book = random_probe(words, 0), words.vocabulary
    for q in (*book.states, *book.inputs):
        low, high = q.ends
        if q.shape == () and low <= 0 <= high:
            found.values[book.symbols[q.name]] = mpf(0)
    return Probe(found.values)


def _within(dice: Random, q: Quantity) -> Any:
    low, high = (mpf(int(x.numerator)) / int(x.denominator) for x in q.ends)
    return _between(dice, low, high)


def _between(dice: Random, low: Any, high: Any) -> Any:
    return low + (high - low) * (mpf(dice.randrange(1, 10**9)) / 10**9)


def small(value: Any, size: Any) -> bool:
    """Tell whether a value is nothing beside a size."""
    return bool(abs(value) <= NOTHING * abs(size))


def solved(rows: Sequence[Sequence[Any]], right: Sequence[Any]) -> list[Any]:
    """Return the solution of linear equations, by Gauss and Jordan.

    Raises ZeroDivisionError where they do not determine it, if only by what rounding leaves.

    >>> [float(x) for x in solved([[mpf(0), mpf(2)], [mpf(1), mpf(1)]], [mpf(4), mpf(5)])]
    [3.0, 2.0]
    """
    with mp.workdps(DIGITS):
        sizes = [max(map(abs, row)) for row in rows]
        if not all(sizes):
            raise ZeroDivisionError
        augmented = [
            [x / s for x in (*row, b)] for row, b, s in zip(rows, right, sizes, strict=True)
        ]
        for k in range(len(augmented)):
            best = max(range(k, len(augmented)), key=lambda n: abs(augmented[n][k]))
            augmented[k], augmented[best] = augmented[best], augmented[k]
            pivot = augmented[k]
            if small(pivot[k], 1):
                raise ZeroDivisionError
            pivot[:] = [x / pivot[k] if x else x for x in pivot]
            live = [j for j, x in enumerate(pivot) if x]
            for row in augmented:
                if row is not pivot and (factor := row[k]):
                    for j in live:
                        row[j] -= factor * pivot[j]
        return [row[-1] for row in augmented]


def independent(rows: Iterable[Mapping[int, Any]], wanted: int) -> list[int]:
    """Return the places of the first rows that are independent of those before, at most so many."""
    return independent_at_all([rows], wanted)


def independent_at_all(
    matrices: Sequence[Iterable[Mapping[int, Any]]], wanted: int, nothing: Any = NOTHING
) -> list[int]:
    """Return the places of the first rows that are independent in every one of several matrices.

    nothing : what is left, at most, of a row that others make up
    """
    kept: list[list[tuple[int, dict[int, Any]]]] = [[] for _ in matrices]
    places: list[int] = []
    with mp.workdps(DIGITS):
        for place, rows in enumerate(zip(*matrices, strict=True)):
            if len(places) == wanted:
                break
            left = [_reduced(row, own, nothing) for row, own in zip(rows, kept, strict=True)]
            if all(left):
                for own, row in zip(kept, left, strict=True):
                    own.append((max(row, key=lambda k, row=row: abs(row[k])), row))  # type: ignore[misc]
                places.append(place)
    return places


def _reduced(
    row: Mapping[int, Any], kept: list[tuple[int, dict[int, Any]]], nothing: Any
) -> dict[int, Any]:
    """Return what is left of a row when earlier ones are taken off it."""
    left = dict(row)
    size = max((abs(v) for v in row.values()), default=mpf(0))
    for pivot, other in kept:
        if pivot in left:
            factor = left[pivot] / other[pivot]
            for k, v in other.items():
                left[k] = left.get(k, mpf(0)) - factor * v
            del left[pivot]
    return {k: v for k, v in left.items() if abs(v) > nothing * size}
