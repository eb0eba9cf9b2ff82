"""What checks make of an operator: one table, a row an operator, a column an arithmetic.

Balls and fractions share nothing with the floats that programs are run in (``program.arithmetic``).
"""

import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from flint import arb, ctx, fmpq
from numpy.typing import NDArray

from derive.program.arithmetic import rounded
from derive.program.pair_sine import PI, pair_sine
from derive.program.pairs import (
    MANTISSA,
    Pair,
    fast_two_sum,
    pair_add,
    pair_div,
    pair_minus,
    pair_mul,
    splitter,
)
from derive.scene.formula import Arithmetic
from derive.scene.functions import PLAIN

Column = NDArray[Any]
FACTOR = np.float64(splitter(MANTISSA[np.float64]))


class IrrationalError(ArithmeticError):
    """A root that no fraction is, or an angle beside its half."""


@dataclass(frozen=True)
class Meaning:
    """What an operator does to numbers of each kind; None where none of that kind is asked.

    balls     : numbers with as many digits as are set, and power series of them
    fractions : exact numbers; a sine and a cosine are those of an angle that goes with the number;
                where there are none, balls prove
    doubles   : columns of doubles, by the platform's library
    wide      : columns of pairs of doubles without rounding, where a program's pairs differ
    slope     : the derivative, in any arithmetic, from the operand and the value
    """

    balls: Callable[..., Any] | None = None
    fractions: Callable[..., Any] | None = None
    doubles: Callable[..., Any] | None = None
    wide: Callable[..., Any] | None = None
    slope: Callable[[Arithmetic, Any, Any], Any] | None = None


def _root(x: Any) -> Any:
    top, bottom = fmpq(x).p, fmpq(x).q
    if x < 0 or top.isqrt() ** 2 != top or bottom.isqrt() ** 2 != bottom:
        raise IrrationalError
    return fmpq(top.isqrt(), bottom.isqrt())


def _no_fraction(*_: Any) -> Any:
    raise IrrationalError


def _power_of_two(x: Any) -> Any:
    if not x.is_finite() or x == 0:
        return x  # on a way that is not taken
    mantissa, exponent = x.mid().man_exp()
    return arb(2) ** (int(exponent) + int(abs(mantissa)).bit_length() - 1)


def _exact_power_of_two(x: Any) -> Any:
    return fmpq(2) ** (int(abs(x.p)).bit_length() - int(x.q).bit_length())


def _pair_floor(a: Pair) -> Pair:
    whole = np.floor(a[0])
    return np.where(whole == a[0], whole + np.floor(a[1]), whole), whole * 0


def _pair_atan2(y: Pair, x: Pair) -> Pair:
    """Return the angle of (x, y): a libm's, turned on by the sine of what it leaves."""
    start = np.arctan2(y[0], x[0])
    sine = pair_sines()
    s, c = sine((start, start * 0), 0), sine((start, start * 0), 1)
    across = pair_add(pair_mul(y, c, FACTOR), pair_minus(pair_mul(x, s, FACTOR)))
    along = pair_add(pair_mul(x, c, FACTOR), pair_mul(y, s, FACTOR))
    rest = pair_div(across, along, FACTOR)
    high, low = fast_two_sum(start, rest[0])
    there = along[0] > 0
    return np.where(there, high, start), np.where(there, low + rest[1], start * 0)


@cache
def pair_sines() -> Callable[[Pair, int], Pair]:
    """Return sine and cosine of pairs of doubles."""
    return pair_sine(np.float64, lambda q: rounded(q, np.float64))


MEANINGS: Mapping[str, Meaning] = {
    **{name: Meaning(does, does) for name, does in PLAIN.items()},
    "low": Meaning(
        lambda a: a * 0, lambda a: a * 0, lambda a: a * 0, lambda a: (a[0] * 0, a[0] * 0)
    ),
    "sin": Meaning(
        lambda x: x.sin(),
        lambda x: 2 * x / (1 + x * x),
        np.sin,
        slope=lambda by, x, _: by["cos"](x),
    ),
    "cos": Meaning(
        lambda x: x.cos(),
        lambda x: (1 - x * x) / (1 + x * x),
        np.cos,
        slope=lambda by, x, _: -by["sin"](x),
    ),
    "tan": Meaning(lambda x: x.tan()),
    "sqrt": Meaning(lambda x: x.sqrt(), _root, np.sqrt, slope=lambda _, __, root: 1 / (2 * root)),
    "atan2": Meaning(lambda y, x: arb.atan2(y, x), doubles=np.arctan2, wide=_pair_atan2),
    "abs": Meaning(abs),
    "floor": Meaning(lambda x: x.floor(), wide=_pair_floor),
    "power_of_two": Meaning(_power_of_two, _exact_power_of_two),
    "less": Meaning(lambda a, b: bool(a < b)),
    "at_most": Meaning(lambda a, b: bool(a <= b)),
    "both": Meaning(lambda a, b: a and b),
    "either": Meaning(lambda a, b: a or b),
    "select": Meaning(lambda condition, yes, no: yes if condition else no),
    "power": Meaning(operator.pow),
    # any fraction will do for pi: it enters nowhere but as a name
    "pi": Meaning(lambda: arb.pi(), lambda: fmpq(355, 113), lambda: float(PI)),
    "unit_roundoff": Meaning(lambda: arb(2) ** (-ctx.prec // 2)),
    "splitter": Meaning(lambda: arb(1), wide=lambda: (np.float64(1), np.float64(0))),
}


def _rounded(operation: Callable[..., Any]) -> Callable[..., Any]:
    """Return an operation on numbers of many digits, rounded like those of floats."""

    def one(*given: Any) -> Any:
        found = operation(*given)
        return found.mid() if isinstance(found, arb) else found

    return one


IN_BALLS: Arithmetic = {
    "number": lambda q: (
        arb(q.numerator) / q.denominator if q.denominator != 1 else arb(q.numerator)
    ),
    **{name: row.balls for name, row in MEANINGS.items() if row.balls},
}
IN_FRACTIONS: Arithmetic = {
    "number": lambda q: fmpq(q.numerator, q.denominator),
    **{n: row.fractions or _no_fraction for n, row in MEANINGS.items() if row.balls},
}
IN_DOUBLES: Arithmetic = {
    "number": lambda q: q.numerator / q.denominator,
    **{name: row.doubles for name, row in MEANINGS.items() if row.doubles},
}
SLOPES = {name: row.slope for name, row in MEANINGS.items() if row.slope}
UNROUNDED: Arithmetic = {name: row.wide for name, row in MEANINGS.items() if row.wide}
LONG_FLOATS: Arithmetic = {name: _rounded(operation) for name, operation in IN_BALLS.items()}
"""Floats of whatever precision is set: balls would lose a choice that is made next to zero."""
