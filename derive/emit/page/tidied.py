"""Equations as one would write them by hand: common factors outside, sines of sums, few signs.

Each sum is tried as it stands, with its common factor outside, multiplied out, and with sines and
cosines of sums; what takes the fewest operations is kept. Long sums are not multiplied out.
"""

from collections import Counter
from collections.abc import Iterator
from functools import lru_cache
from itertools import combinations

from sympy import Add, Expr, Mul, Pow, cos, default_sort_key, factor_terms, sin
from sympy.simplify.fu import TR6, TR10i

from derive.lecture.polynomial import without_brackets
from derive.lecture.turning import reduced

BaseAndPower = tuple[Expr, Expr]  # a factor's base, and its exponent
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
    whole = without_brackets(value)
    every = [value, whole]
    if any(map(_adds_angles, whole.atoms(Add))):
        every.append(TR10i(whole))
    squared = {e.base.func for e in whole.atoms(Pow) if e.exp.is_Integer and e.exp > 1}
    if sin in squared:
        every.append(reduced(whole))
    if cos in squared:
        every.append(without_brackets(TR6(whole)))
    for one in dict.fromkeys(every):
        yield from (one, _gathered(one))


def _adds_angles(value: Expr) -> bool:
    """Tell whether two terms of a sum differ by sines and cosines of the same angles alone.

    Looking for sums of angles takes long where there are none.
    """
    alike: dict[frozenset[BaseAndPower], list[dict[Expr, Expr]]] = {}
    for term in value.args:
        powers = [f.as_base_exp() for f in Mul.make_args(term) if not f.is_number]
        waves = {base: power for base, power in powers if isinstance(base, (sin, cos))}
        alike.setdefault(frozenset(p for p in powers if p[0] not in waves), []).append(waves)
    return any(_meet(a, b) for each in alike.values() for a, b in combinations(each, 2))


def _meet(first: dict[Expr, Expr], second: dict[Expr, Expr]) -> bool:
    """Tell whether what two products of sines and cosines do not share is of the same angles."""
    left = [
        {f.args[0] for f, power in own.items() if power != other.get(f)}
        for own, other in ((first, second), (second, first))
    ]
    return bool(left[0]) and left[0] == left[1]


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
