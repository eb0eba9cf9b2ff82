"""What an operator means: one table, a row an operator, a column an arithmetic.

The same program runs in exact fractions, in floats of either precision, in pairs of floats (twice
the working precision, for set-up) and in CasADi, and prints as C.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from operator import add, and_, le, lt, mul, neg, or_, sub, truediv
from typing import Any, Literal

import flint
import numpy as np
from numpy.typing import NDArray

from derive.program.own_sine import FITTED, sine_and_cosine
from derive.program.pair_sine import PI, pair_sine
from derive.program.pairs import (
    MANTISSA,
    Pair,
    pair_absolute,
    pair_add,
    pair_below,
    pair_div,
    pair_minus,
    pair_mul,
    pair_select,
    pair_sqrt,
    splitter,
)
from derive.scene.formula import Arithmetic


@dataclass(frozen=True)
class Wide:
    """What operations on pairs of a float type need: the number that splits one, and sines."""

    dtype: type
    factor: Any
    sine: Callable[[Pair, int], Pair]


@dataclass(frozen=True)
class Operator:
    """What an operator is, and what it does; None where an arithmetic does not have it.

    kind   : "flop" counts as one, "truth" gives true or false, "libm" asks the platform's library,
             "turn" does so of large angles alone,
             "number" has no operands and rests on the precision alone
    exact  : what it does to fractions; roots, sines and their like need a proof's own (``prove``)
    floats : what it does to floats, in columns; a libm's is rounded correctly for every type, and
             so is a large angle's
    pairs  : what it does to pairs of floats, in columns, told the float first
    number : the number that it is, by the bits of a float
    libc   : the function of <math.h>; in float it takes an f at its end
    """

    kind: Literal["flop", "truth", "libm", "turn", "number", "value"]
    exact: Callable[..., Any] | None = None
    floats: Callable[..., Any] | None = None
    pairs: Callable[..., Any] | None = None
    number: Callable[[int], Fraction] | None = None
    libc: str = ""
    commutes: bool = False


def _exact_floor(x: Fraction) -> Fraction:
    return Fraction(x.numerator // x.denominator)


def _of_truths(operation: Callable[[Any, Any], Any]) -> Callable[..., Any]:
    return lambda _, a, b: operation(a, b)


def _exact_power_of_two(x: Fraction) -> Fraction:
    return Fraction(2) ** (abs(x).numerator.bit_length() - abs(x).denominator.bit_length())


OPERATORS: Mapping[str, Operator] = {
    "add": Operator("flop", add, add, lambda _, a, b: pair_add(a, b), commutes=True),
    "sub": Operator("flop", sub, sub, lambda _, a, b: pair_add(a, pair_minus(b))),
    "mul": Operator("flop", mul, mul, lambda by, a, b: pair_mul(a, b, by.factor), commutes=True),
    "div": Operator("flop", truediv, truediv, lambda by, a, b: pair_div(a, b, by.factor)),
    "neg": Operator("value", neg, neg, lambda _, a: pair_minus(a)),
    "low": Operator("value", pairs=lambda _, a: (a[1], a[1] * 0)),
    "sqrt": Operator("value", None, np.sqrt, lambda by, a: pair_sqrt(a, by.factor), libc="sqrt"),
    "sin": Operator(
        "turn", None, lambda x: _turned("sin", x), lambda by, a: by.sine(a, 0), libc="sin"
    ),
    "cos": Operator(
        "turn", None, lambda x: _turned("cos", x), lambda by, a: by.sine(a, 1), libc="cos"
    ),
    "atan2": Operator("libm", libc="atan2"),
    "abs": Operator("value", abs, np.abs, lambda _, a: pair_absolute(a), libc="fabs"),
    "floor": Operator("value", _exact_floor, np.floor, libc="floor"),
    "power_of_two": Operator(
        "value",
        _exact_power_of_two,
        lambda x: power_of_two(x, np.asarray(x).dtype.type),
        lambda by, a: (power_of_two(a[0], by.dtype), a[0] * 0),
    ),
    "less": Operator("truth", lt, np.less, lambda _, a, b: pair_below(np.less, a, b)),
    "at_most": Operator(
        "truth", le, np.less_equal, lambda _, a, b: pair_below(np.less_equal, a, b)
    ),
    "both": Operator("truth", and_, np.logical_and, _of_truths(np.logical_and), commutes=True),
    "either": Operator("truth", or_, np.logical_or, _of_truths(np.logical_or), commutes=True),
    "select": Operator(
        "value",
        lambda condition, yes, no: yes if condition else no,
        np.where,
        lambda _, condition, yes, no: pair_select(condition, yes, no),
    ),
    "pi": Operator("number", number=lambda _: PI),
    "unit_roundoff": Operator("number", number=lambda bits: Fraction(1, 2**bits)),
    "splitter": Operator("number", number=lambda bits: Fraction(splitter(bits))),
}
FLOPS, TRUTHS, LIBM, TURNS = (
    frozenset(name for name, row in OPERATORS.items() if row.kind == kind)
    for kind in ("flop", "truth", "libm", "turn")
)
EXACT: Arithmetic = {
    "number": Fraction,
    **{name: row.exact for name, row in OPERATORS.items() if row.exact is not None},
}


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
            if not ball.is_finite() or not np.all(np.isfinite(given)):
                return dtype(_at_the_edge(function, *given))
            man, exp = ball.mid().man_exp()
        return rounded(Fraction(int(man)) * Fraction(2) ** int(exp), dtype)

    def each(*given: Any) -> Any:
        several = np.broadcast_arrays(*given)
        flat = zip(*(np.ravel(x) for x in several), strict=True)
        return np.array([one(*values) for values in flat], dtype).reshape(several[0].shape)

    return each


def of_turns(name: str, x: Any, far: Callable[[Any], Any]) -> Any:
    """Return sines or cosines: our own, by ``far`` where an angle is too large for them."""
    angle = np.asarray(x)
    dtype = angle.dtype.type
    beyond = ~(np.abs(angle) <= FITTED[MANTISSA[dtype]].largest)
    both = sine_and_cosine(np.where(beyond, dtype(0), angle), dtype)
    found = np.asarray(both[("sin", "cos").index(name)])
    if np.any(beyond):
        found[beyond] = far(angle[beyond])
    return found[()]


def _turned(name: str, x: Any) -> Any:
    return of_turns(name, x, _correctly(name, np.asarray(x).dtype.type))


def _at_the_edge(function: str, *given: Any) -> float:
    """Return what numpy gives where no finite ball is the answer: zeros, infinities, NaN."""
    with np.errstate(all="ignore"):
        return float(getattr(np, {"atan2": "arctan2"}.get(function, function))(*given))


def working(dtype: type) -> Arithmetic:
    """Return the arithmetic of one float type, vectorised over samples."""

    def number(q: Fraction) -> Any:
        return rounded(q, dtype)

    own = {name: row.floats for name, row in OPERATORS.items() if row.floats is not None}
    own |= {name: _correctly(name, dtype) for name in sorted(LIBM)}
    return {"number": number, **own, **_numbers(number, dtype)}


def _numbers(number: Callable[[Fraction], Any], dtype: type) -> Arithmetic:
    """Return the operators without operands, as an arithmetic has numbers."""
    bits = MANTISSA[dtype]
    every = {name: row.number(bits) for name, row in OPERATORS.items() if row.number is not None}
    return {name: partial(number, q) for name, q in every.items()}


def power_of_two(x: Any, dtype: type) -> Any:
    """Return the power of two at or next to x > 0, by float operations only (Rump)."""
    p = MANTISSA[dtype]
    q = dtype(2.0 ** (p - 1) + 1.0) * x
    return q - dtype(1.0 - 2.0**-p) * q


def pair_of(q: Fraction, dtype: type) -> tuple[Fraction, Fraction]:
    """Return the two floats whose sum is next to ``q``."""
    high = Fraction(float(rounded(q, dtype)))
    return high, Fraction(float(rounded(q - high, dtype)))


def extended(dtype: type) -> Arithmetic:
    """Return the arithmetic of pairs of ``dtype``, vectorised over samples."""

    def number(q: Fraction) -> Pair:
        high, low = pair_of(q, dtype)
        return rounded(high, dtype), rounded(low, dtype)

    sine = pair_sine(dtype, lambda q: rounded(q, dtype))
    by = Wide(dtype, dtype(splitter(MANTISSA[dtype])), sine)
    own = {name: partial(row.pairs, by) for name, row in OPERATORS.items() if row.pairs is not None}
    return {"number": number, **own, **_numbers(number, dtype)}


def paired(values: NDArray[Any]) -> list[Pair]:
    """Return inputs as pairs: exact floats with nothing behind them."""
    return [(value, value * 0) for value in values]
