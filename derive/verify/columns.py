"""Programs on columns of numbers: thousands of samples in one operation, in floats and in pairs.

What is no longer needed is let go, so that columns stay in the cache. What libm knows is rounded
correctly: atan2 by a value of more digits, or by a ball where even that leaves a doubt, all others
by balls.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
from flint import arb, ctx
from numpy.typing import NDArray

from derive.program.arithmetic import LIBM, extended, pair_of, working
from derive.program.indexed import Loop
from derive.program.pairs import Pair
from derive.program.program import Line, Op, Program, component_names, operands_of
from derive.program.run import numbers_of, run_lines, values_of
from derive.scene.formula import Arithmetic
from derive.verify.operators import IN_BALLS, IN_DOUBLES, UNROUNDED, Column

FAR = 2.0**200
"""Components of an angle's direction are taken in pairs up to this, and down to its inverse."""
QUICKLY = ("atan2",)
"""Functions of libm that more digits than a float's round rightly nearly always, before balls."""
BITS = 200  # of balls: a double's range apart, two pairs differ within 106
SURE = {np.float32: 2.0**-46, np.float64: 2.0**-94}
"""Relative errors that the values of more digits keep: a libm's in double, and a pair's."""


@dataclass(frozen=True)
class Plan:
    """A program, and after each of its lines the values that nothing needs any more."""

    program: Program
    spent: tuple[tuple[str, ...], ...]


def planned(program: Program) -> Plan:
    """Return a program with the places at which its values can go."""
    last: dict[str, int] = {}
    for place, line in enumerate(program.ops):
        last |= dict.fromkeys(_names(line), place)
    kept = operands_of((), program.results)
    spent: list[list[str]] = [[] for _ in program.ops]
    for name, place in last.items():
        if name not in kept and "[" not in name:  # loops find places of arrays by counters
            spent[place].append(name)
    return Plan(program, tuple(map(tuple, spent)))


def _names(line: Line) -> set[str]:
    own = operands_of((line,))
    if isinstance(line, Op):
        own.add(line.result)
    return own | {*line.carried} if isinstance(line, Loop) else own


def in_columns(plan: Plan, arithmetic: Arithmetic, known: Mapping[str, Any]) -> list[Any]:
    """Return the results of a program by component, from the columns of its inputs by name."""
    program = plan.program
    own = {c: known[c] for q in program.inputs for c in q.components}
    own |= numbers_of(program, arithmetic)
    for line, spent in zip(program.ops, plan.spent, strict=True):
        run_lines((line,), arithmetic, own)
        for name in spent:
            own.pop(name, None)
    return values_of(program.results, arithmetic, own)


@dataclass(frozen=True)
class Arithmetics:
    """What a program of floats is run in, and what it is held against.

    made, true_made : pairs of the precision, as of set-up; and of doubles, with nothing rounded
    own             : floats of the precision
    true            : double for float, pairs of doubles for double
    """

    dtype: type
    made: Arithmetic
    own: Arithmetic
    true_made: Arithmetic
    true: Arithmetic

    def number(self, pair: Pair) -> Any:
        """Return a constant of ``true_made`` as ``true`` has it."""
        return pair[0] if self.dtype is np.float32 else pair

    def given(self, column: Column) -> Any:
        """Return a column of floats as ``true`` has it."""
        wide = column.astype(np.float64)
        return wide if self.dtype is np.float32 else (wide, wide * 0)

    def off(self, found: Column, true: Any) -> Column:
        """Return found - true, in double."""
        if self.dtype is np.float32:
            return np.asarray(found.astype(np.float64) - true)
        return np.asarray((found - true[0]) - true[1])


@cache
def arithmetics(dtype: type) -> Arithmetics:
    """Return the arithmetics of a precision: of float or of double."""
    made = _with_numbers(extended(dtype))
    own = _with_numbers({**working(dtype), **{n: _correctly(n, dtype) for n in LIBM}})
    true_made = _with_numbers(_unrounded())
    true = true_made if dtype is np.float64 else doubles()
    return Arithmetics(dtype, made, own, true_made, true)


def _unrounded() -> Arithmetic:
    """Return pairs of doubles as if they were numbers of all digits: nothing is left below."""
    own = {**extended(np.float64), **UNROUNDED}
    return {**own, **{name: _by_balls(name) for name in sorted(LIBM) if name not in own}}


def _by_balls(name: str) -> Callable[..., Pair]:
    """Return a function of libm on columns of pairs, each value found in a ball."""

    def one(*given: float) -> tuple[float, float]:
        with ctx.workprec(BITS):
            pairs = zip(given[::2], given[1::2], strict=True)
            ball = IN_BALLS[name](*(arb(float(a)) + arb(float(b)) for a, b in pairs))
            if not ball.is_finite():
                return float("nan"), 0.0
            mantissa, exponent = ball.mid().man_exp()
        high, low = pair_of(Fraction(int(mantissa)) * Fraction(2) ** int(exponent), np.float64)
        return float(high), float(low)

    each = np.vectorize(one, otypes=(np.float64, np.float64))
    return lambda *pairs: each(*(part for pair in pairs for part in pair))


@cache
def doubles() -> Arithmetic:
    """Return double with the libm of the machine: for what needs a few digits only."""
    return _with_numbers({**working(np.float64), **{n: IN_DOUBLES[n] for n in (*LIBM, "low")}})


def _with_numbers(arithmetic: Arithmetic) -> Arithmetic:
    """Return an arithmetic that works each constant out once."""
    return {**arithmetic, "number": cache(arithmetic["number"])}


def _correctly(name: str, dtype: type) -> Callable[..., Any]:
    """Return a function of libm correctly rounded, the same on every machine, for columns."""
    with_balls = working(dtype)[name]
    if name not in QUICKLY:
        return with_balls
    value = _single if dtype is np.float32 else _double

    def each(*given: Any) -> Any:
        several = [np.atleast_1d(x) for x in np.broadcast_arrays(*given)]
        found, sure = value(name, several)
        flat = (several[0] == 0) & (several[-1] > 0)
        found = np.where(flat, several[0], found).astype(dtype)
        doubt = ~(sure | flat)
        if np.any(doubt):
            found[doubt] = with_balls(*(x[doubt] for x in several))
        return found.reshape(np.broadcast_shapes(*(np.shape(x) for x in given)))

    return each


def _single(name: str, given: Sequence[Column]) -> tuple[Column, NDArray[np.bool_]]:
    wide = [x.astype(np.float64) for x in given]
    value = IN_DOUBLES[name](*wide)
    found = value.astype(np.float32)
    ends = [(value * (1 + side * SURE[np.float32])).astype(np.float32) for side in (-1, 1)]
    within = np.all(np.abs(wide) < FAR, axis=0)
    return found, (ends[0] == found) & (ends[1] == found) & (found != 0) & within


def _double(name: str, given: Sequence[Column]) -> tuple[Column, NDArray[np.bool_]]:
    high, low = UNROUNDED[name](*((x, x * 0) for x in given))
    sizes = np.abs(given)
    sure = np.all((sizes < FAR) & (sizes > 1 / FAR), axis=0)
    wrong = np.abs(high) * SURE[np.float64]
    same = (high + (low + wrong) == high) & (high + (low - wrong) == high)
    return high, same & sure & (high != 0)


@dataclass(frozen=True)
class Supplied:
    """Inputs and constants of a set of samples, as the program has them and as they truly are."""

    own: Mapping[str, Column]
    true: Mapping[str, Any]
    wide: Mapping[str, Column]  # the true ones in double


def supplied(setup: Plan, values: Mapping[str, Column], by: Arithmetics) -> Supplied:
    """Return samples with the constants that set-up makes of them."""
    names = component_names(setup.program)
    count = len(next(iter(values.values())))
    own, true = dict(values), {name: by.given(x) for name, x in values.items()}
    wide = {name: x.astype(np.float64) for name, x in values.items()}
    made = in_columns(setup, by.made, {n: (x, x * 0) for n, x in values.items()})
    whole = in_columns(setup, by.true_made, {n: (x, x * 0) for n, x in wide.items()})
    for name, rounded_once, pair in zip(names, made, whole, strict=True):
        own[name] = _filled(rounded_once[0], count).astype(by.dtype)
        both = (_filled(pair[0], count), _filled(pair[1], count))
        true[name], wide[name] = by.number(both), both[0]
    return Supplied(own, true, wide)


def _filled(x: Any, count: int) -> Column:
    return np.broadcast_to(np.asarray(x), (count,))


def found_and_true(plan: Plan, at: Supplied, by: Arithmetics) -> list[tuple[Column, Any]]:
    """Return what a program gives and what it should give, by component, at all samples."""
    count = len(next(iter(at.own.values())))
    if plan.program.arithmetic == "pairs":
        given = {name: (x, x * 0) for name, x in at.own.items()}
        found = [x[0] for x in in_columns(plan, by.made, given)]
    else:
        found = in_columns(plan, by.own, at.own)
    single = by.dtype is np.float32
    true = in_columns(plan, by.true, at.true)
    return [
        (
            _filled(f, count),
            _filled(t, count) if single else (_filled(t[0], count), _filled(t[1], count)),
        )
        for f, t in zip(found, true, strict=True)
    ]
