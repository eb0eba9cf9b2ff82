"""What an operator means: one table an arithmetic, one row an operator.

A backend is a table. The same program runs in exact fractions, in floats of either precision, in
pairs of floats (twice the working precision, for set-up) and in CasADi, and prints as C.
"""

import operator
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import flint
import numpy as np
from numpy.typing import NDArray

from derive.program.pair_sine import PI, pair_sine
from derive.program.pairs import (
    MANTISSA,
    Pair,
    pair_add,
    pair_div,
    pair_minus,
    pair_mul,
    pair_select,
    pair_sqrt,
    splitter,
)

Table = dict[str, Callable[..., Any]]

_PYTHON: Table = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "neg": operator.neg,
}


def _exact_power_of_two(x: Fraction) -> Fraction:
    return Fraction(2) ** (abs(x).numerator.bit_length() - abs(x).denominator.bit_length())


# Roots, sines and their like have no row here: a proof must bring its own (see ``prove``).
EXACT: Table = _PYTHON | {
    "number": Fraction,
    "power_of_two": _exact_power_of_two,
    "abs": abs,
    "floor": lambda x: Fraction(x.numerator // x.denominator),
    "less": operator.lt,
    "at_most": operator.le,
    "both": operator.and_,
    "either": operator.or_,
    "select": lambda condition, yes, no: yes if condition else no,
}

# Operators whose result is a truth and not a number, and those that ask the platform's libm.
TRUTHS = frozenset(("less", "at_most", "both", "either"))
LIBM = frozenset(("sin", "cos", "atan2"))


def rounded(q: Fraction, dtype: type) -> Any:
    """Return the float of ``dtype`` nearest to ``q``, rounded once.

    >>> float(rounded(Fraction(1, 3), np.float32))
    0.3333333432674408
    """
    if dtype is np.float64:
        return np.float64(q.numerator / q.denominator)
    first = np.float32(q.numerator / q.denominator)
    near = (
        np.nextafter(first, np.float32(-np.inf)),
        first,
        np.nextafter(first, np.float32(np.inf)),
    )
    finite = [x for x in near if np.isfinite(x)]
    best = min(abs(Fraction(float(x)) - q) for x in finite)
    ties = [x for x in finite if abs(Fraction(float(x)) - q) == best]
    return min(ties, key=lambda x: int(np.float32(x).view(np.uint32)) & 1)


def _correctly(function: str, dtype: type) -> Callable[..., Any]:
    """Return a function of libm correctly rounded, the same on every machine."""

    def one(*given: Any) -> Any:
        with flint.ctx.workprec(200):
            first, *rest = (flint.arb(float(x)) for x in given)
            ball = getattr(flint.arb, function)(first, *rest)
            if not ball.is_finite():
                return dtype(_at_the_edge(function, *given))
            man, exp = ball.mid().man_exp()
        return rounded(Fraction(int(man)) * Fraction(2) ** int(exp), dtype)

    def each(*given: Any) -> Any:
        several = np.broadcast_arrays(*given)
        flat = zip(*(np.ravel(x) for x in several), strict=True)
        return np.array([one(*values) for values in flat], dtype).reshape(several[0].shape)

    return each


def _at_the_edge(function: str, *given: Any) -> float:
    """Return what numpy gives where no finite ball is the answer: zeros, infinities, NaN."""
    with np.errstate(all="ignore"):
        return float(getattr(np, {"atan2": "arctan2"}.get(function, function))(*given))


def working(dtype: type) -> Table:
    """Return the arithmetic of one float type, vectorised over samples."""
    return _PYTHON | {
        "number": lambda q: rounded(q, dtype),
        "sqrt": np.sqrt,
        **{name: _correctly(name, dtype) for name in sorted(LIBM)},
        "abs": np.abs,
        "floor": np.floor,
        **_CHOICES,
        "pi": lambda: rounded(PI, dtype),
        "power_of_two": lambda x: power_of_two(x, dtype),
        "unit_roundoff": lambda: dtype(2.0 ** -MANTISSA[dtype]),
        "splitter": lambda: dtype(splitter(MANTISSA[dtype])),
    }


_CHOICES: Table = {
    "less": np.less,
    "at_most": np.less_equal,
    "both": np.logical_and,
    "either": np.logical_or,
    "select": np.where,
}


def power_of_two(x: Any, dtype: type) -> Any:
    """Return the power of two at or next to x > 0, by float operations only (Rump)."""
    p = MANTISSA[dtype]
    q = dtype(2.0 ** (p - 1) + 1.0) * x
    return q - dtype(1.0 - 2.0**-p) * q


def pair_of(q: Fraction, dtype: type) -> tuple[Fraction, Fraction]:
    """Return the two floats whose sum is next to ``q``."""
    high = Fraction(float(rounded(q, dtype)))
    return high, Fraction(float(rounded(q - high, dtype)))


def extended(dtype: type) -> Table:
    """Return the arithmetic of pairs of ``dtype``, vectorised over samples."""
    factor = dtype(splitter(MANTISSA[dtype]))

    def number(q: Fraction) -> Pair:
        high, low = pair_of(q, dtype)
        return rounded(high, dtype), rounded(low, dtype)

    sine = pair_sine(dtype, lambda q: rounded(q, dtype))
    return {
        "number": number,
        "add": pair_add,
        "sub": lambda a, b: pair_add(a, pair_minus(b)),
        "neg": pair_minus,
        "low": lambda a: (a[1], a[1] * 0),
        "mul": lambda a, b: pair_mul(a, b, factor),
        "div": lambda a, b: pair_div(a, b, factor),
        "sqrt": lambda a: pair_sqrt(a, factor, np.sqrt),
        "sin": lambda a: sine(a, 0),
        "cos": lambda a: sine(a, 1),
        "power_of_two": lambda a: (power_of_two(a[0], dtype), a[0] * 0),
        "abs": lambda a: pair_select(a[0] < 0, pair_minus(a), a),
        "less": lambda a, b: (a[0] < b[0]) | ((a[0] == b[0]) & (a[1] < b[1])),
        "at_most": lambda a, b: (a[0] < b[0]) | ((a[0] == b[0]) & (a[1] <= b[1])),
        "both": np.logical_and,
        "either": np.logical_or,
        "select": pair_select,
        "pi": lambda: number(PI),
        "unit_roundoff": lambda: number(Fraction(1, 2 ** MANTISSA[dtype])),
        "splitter": lambda: number(Fraction(splitter(MANTISSA[dtype]))),
    }


def paired(values: NDArray[Any]) -> list[Pair]:
    """Return inputs as pairs: exact floats with nothing behind them."""
    return [(value, value * 0) for value in values]
