"""Equations as one would write them by hand: common factors outside, sines of sums, few signs.

Each sum is tried as it stands, with its common factor outside, multiplied out, and with sines and
cosines of sums; what takes the fewest operations is kept. Long sums are not multiplied out.
"""

from collections import Counter
from collections.abc import Iterator
from functools import lru_cache

from sympy import Add, Expr, Mul, Pow, cos, default_sort_key, expand, factor_terms, sin
from sympy.simplify.fu import TR6, TR10i

from derive.lecture.turning import reduced

KEPT = 10_000
"""Parts of equations of which it is remembered what became of them."""
LONGEST = 45
"""Operations of a sum that is multiplied out: sums that a reader takes in, in milliseconds."""


def neatened(value: Expr) -> Expr:
    """Return an expression that is equal and no longer.

    >>> from sympy import symbols
    >>> a, b, c, m, l = symbols("a b c m l")
    >>> neatened(sin(a)*cos(b) + cos(a)*sin(b)), neatened((-l - c/2)*(-m*l - m*c/2))
    (sin(a + b), m*(c/2 + l)**2)
    >>> neatened(-(-a - b)/2), neatened(m*sin(a)**2 + m*cos(a)**2)
    ((a + b)/2, m)
    """
    best, shorter = value, _tidied_once(value)
    while _length(shorter) < _length(best):
        best, shorter = shorter, _tidied_once(shorter)
    return best


@lru_cache(KEPT)
def _tidied_once(value: Expr) -> Expr:
    """Return the shortest form of an expression whose parts are brought to theirs."""
    if value.is_Atom:
        return value
    inner = _signed(value.func(*map(_tidied_once, value.args)))
    if not (inner.is_Add or inner.is_Mul):
        return inner
    return min(dict.fromkeys((inner, *map(_signed, dict.fromkeys(_forms(inner))))), key=_length)


def _forms(value: Expr) -> Iterator[Expr]:
    outside = factor_terms(value, sign=False)
    yield outside
    if _length(value)[0] > LONGEST or not value.has(Add):
        return
    whole = expand(value)
    every = [value, whole]
    if value.has(sin, cos):
        every += [TR10i(whole), reduced(value), expand(TR6(whole))]
    for one in dict.fromkeys(every):
        yield from (one, _gathered(one))


def _gathered(value: Expr) -> Expr:
    """Return a sum with what most of its terms have in common taken out, and so on."""
    if not value.is_Add:
        return value
    terms = [frozenset(f for f in Mul.make_args(t) if not f.is_number) for t in value.args]
    count = Counter(factor for term in terms for factor in term)
    common = max(count, key=lambda f: (count[f], default_sort_key(f)), default=None)
    if common is None or count[common] < 2:  # numbers alone, as cos(3/10) + 1
        return value
    inside = [t / common for t, own in zip(value.args, terms, strict=True) if common in own]
    rest = [t for t, own in zip(value.args, terms, strict=True) if common not in own]
    return common * _gathered(Add(*inside)) + _gathered(Add(*rest))


@lru_cache(KEPT)
def _signed(value: Expr) -> Expr:
    """Return products with the signs of their sums brought before them."""
    if value.is_Add:
        return Add(*map(_signed, value.args))
    if not value.is_Mul:
        return value
    for factor in value.args:
        base, power = factor.as_base_exp()
        less = _minuses(base) * 2 - len(Add.make_args(base))
        odd = value.could_extract_minus_sign() and power.is_odd
        if power.is_Integer and base.is_Add and (less > 0 or (less == 0 and odd)):
            value = (value / factor) * (-base) ** power * (-1) ** power
    return value


def _minuses(value: Expr) -> int:
    """Return how many terms of a sum have a minus."""
    return len([t for t in Add.make_args(value) if t.as_coeff_Mul()[0].is_negative])


@lru_cache(KEPT)
def _length(value: Expr) -> tuple[int, int]:
    """Return how long an expression is to a reader: its operations, then its leading signs."""
    sums = [f.base if isinstance(f, Pow) else f for f in Mul.make_args(value)]
    most = [f for f in sums if f.is_Add and _minuses(f) * 2 > len(f.args)]
    return int(value.count_ops()), len(most)
