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

Table = dict[str, Callable[..., Any]]
Pair = tuple[Any, Any]

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
LIBM = frozenset(("sin", "cos", "exp", "log", "atan2"))

MANTISSA: dict[type, int] = {np.float64: 53, np.float32: 24}


def rounded(q: Fraction, dtype: type) -> Any:
    """Return the float of ``dtype`` nearest to ``q``, rounded once.

    >>> rounded(Fraction(1, 3), np.float32)
    np.float32(0.33333334)
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

PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899")


def power_of_two(x: Any, dtype: type) -> Any:
    """Return the power of two at or next to x > 0, by float operations only (Rump)."""
    p = MANTISSA[dtype]
    q = dtype(2.0 ** (p - 1) + 1.0) * x
    return q - dtype(1.0 - 2.0**-p) * q


def splitter(bits: int) -> int:
    """Return the number that splits a float of so many bits into halves (Veltkamp)."""
    return (1 << (bits + 1) // 2) + 1


def two_sum(a: Any, b: Any) -> Pair:
    """Return s and e with s + e = a + b exactly and s = fl(a + b) (Knuth)."""
    s = a + b
    t = s - a
    return s, (a - (s - t)) + (b - t)


def fast_two_sum(a: Any, b: Any) -> Pair:
    """Return s and e with s + e = a + b exactly where abs(a) >= abs(b) (Dekker)."""
    s = a + b
    return s, b - (s - a)


def _split(a: Any, factor: Any) -> Pair:
    c = factor * a
    high = c - (c - a)
    return high, a - high


def two_product(a: Any, b: Any, factor: Any) -> Pair:
    """Return p and e with p + e = a b exactly and p = fl(a b) (Veltkamp and Dekker)."""
    p = a * b
    ah, al = _split(a, factor)
    bh, bl = _split(b, factor)
    return p, ((ah * bh - p) + ah * bl + al * bh) + al * bl


def pair_add(a: Pair, b: Pair) -> Pair:
    """Return a + b within 3 u^2 relative, whatever cancels (Joldes, Muller and Popescu 2017)."""
    s, e = two_sum(a[0], b[0])
    t, f = two_sum(a[1], b[1])
    x, y = fast_two_sum(s, e + t)
    return fast_two_sum(x, y + f)


def pair_mul(a: Pair, b: Pair, factor: Any) -> Pair:
    """Return a b within a few u^2 relative."""
    p, e = two_product(a[0], b[0], factor)
    return fast_two_sum(p, e + (a[0] * b[1] + a[1] * b[0]))


def pair_div(a: Pair, b: Pair, factor: Any) -> Pair:
    """Return a / b within a few u^2 relative: long division, three digits."""
    zero = b[0] * 0
    q1 = a[0] / b[0]
    r = pair_add(a, _minus(pair_mul((q1, zero), b, factor)))
    q2 = r[0] / b[0]
    r = pair_add(r, _minus(pair_mul((q2, zero), b, factor)))
    return pair_add(pair_add((q1, zero), (q2, zero)), (r[0] / b[0], zero))


def pair_sqrt(a: Pair, factor: Any, root: Callable[[Any], Any]) -> Pair:
    """Return the square root of a within a few u^2 relative (Karp and Markstein)."""
    s = root(a[0])
    r = pair_add(a, _minus(two_product(s, s, factor)))
    return fast_two_sum(s, np.where(s > 0, r[0] / (s + s), s * 0))


def _minus(a: Pair) -> Pair:
    return -a[0], a[1] * 0 - a[1]  # a zero stays a positive zero, as CasADi has it


def _pair_select(condition: Any, yes: Pair, no: Pair) -> Pair:
    return np.where(condition, yes[0], no[0]), np.where(condition, yes[1], no[1])


def extended(dtype: type) -> Table:
    """Return the arithmetic of pairs of ``dtype``, vectorised over samples."""
    factor = dtype(splitter(MANTISSA[dtype]))
    base = working(dtype)

    def number(q: Fraction) -> Pair:
        high = rounded(q, dtype)
        return high, rounded(q - Fraction(float(high)), dtype)

    def angle(a: Pair, value: str, slope: str, sign: int) -> Pair:
        return fast_two_sum(base[value](a[0]), dtype(sign) * base[slope](a[0]) * a[1])

    return {
        "number": number,
        "add": pair_add,
        "sub": lambda a, b: pair_add(a, _minus(b)),
        "neg": _minus,
        "low": lambda a: (a[1], a[1] * 0),
        "mul": lambda a, b: pair_mul(a, b, factor),
        "div": lambda a, b: pair_div(a, b, factor),
        "sqrt": lambda a: pair_sqrt(a, factor, np.sqrt),
        "sin": lambda a: angle(a, "sin", "cos", 1),
        "cos": lambda a: angle(a, "cos", "sin", -1),
        "power_of_two": lambda a: (power_of_two(a[0], dtype), a[0] * 0),
        "abs": lambda a: _pair_select(a[0] < 0, _minus(a), a),
        "less": lambda a, b: (a[0] < b[0]) | ((a[0] == b[0]) & (a[1] < b[1])),
        "at_most": lambda a, b: (a[0] < b[0]) | ((a[0] == b[0]) & (a[1] <= b[1])),
        "both": np.logical_and,
        "either": np.logical_or,
        "select": _pair_select,
        "pi": lambda: number(PI),
    }


def paired(values: NDArray[Any]) -> list[Pair]:
    """Return inputs as pairs: exact floats with nothing behind them."""
    return [(value, value * 0) for value in values]
