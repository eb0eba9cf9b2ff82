"""What several products or several sums have in common is computed once.

The pair that occurs in most of them is computed once and put in its place, until no pair occurs
twice; then signs are turned so that few values must be negated. Ties go to what came first.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

from derive.lower.graph import UNIT
from derive.lower.numbering import Numbering, SignedKey, product_key


def halve(numbering: Numbering) -> None:
    """Write 2 x as x + x where x is there anyway, so that sums can share it."""
    for key, addends in numbering.addends.items():
        numbering.addends[key] = [
            term for sign, addend in addends for term in _halves(numbering, sign, addend)
        ]


def _halves(numbering: Numbering, sign: int, addend: int) -> list[SignedKey]:
    factors = numbering.factors.get(addend, [])
    constants = [f for f in factors if f in numbering.constants]
    if len(constants) != 1:
        return [(sign, addend)]
    coefficient, node = numbering.constants[constants[0]]
    rest = [f for f in factors if f not in numbering.constants]
    half = (coefficient / 2, node)
    if half == UNIT:
        return [(sign, product_key(numbering, rest))] * 2
    halved = ("constant", half) in numbering.keys
    wanted = ("product", *sorted([*rest, numbering.keys[("constant", half)]])) if halved else None
    if wanted is None or wanted not in numbering.keys:
        return [(sign, addend)]
    return [(sign, numbering.keys[wanted])] * 2


@dataclass
class PairCounts:
    """How many groups each pair occurs in; only the groups that change are counted again."""

    groups: dict[int, Any]
    within: Callable[[Any], set[Any]]
    own: dict[int, set[Any]] = field(default_factory=dict)
    counts: Counter[Any] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        """Count all groups."""
        for key in self.groups:
            self.changed(key)

    def changed(self, key: int) -> None:
        """Count the pairs of one group again."""
        before, now = self.own.get(key, set()), self.within(self.groups[key])
        self.own[key] = now
        self.counts.update(now - before)
        for pair in before - now:
            self.counts[pair] -= 1

    def most(self) -> Any:
        """Return the pair that occurs in most groups, None if none does twice."""
        most = max(self.counts.values(), default=0)
        return min(pair for pair, n in self.counts.items() if n == most) if most > 1 else None


def share_products(numbering: Numbering) -> None:
    """Compute every pair of factors that several products have in common once."""
    pairs = PairCounts(
        numbering.factors, lambda own: {p for p in combinations(own, 2) if _may_pair(numbering, *p)}
    )
    while (best := pairs.most()) is not None:
        key, _ = numbering.key("product", *best)
        for whole in [k for k, own in pairs.own.items() if best in own and k != key]:
            factors = numbering.factors[whole]
            while not Counter(best) - Counter(factors):
                for factor in best:
                    factors.remove(factor)
                factors.append(key)
                factors.sort()
            pairs.changed(whole)
        numbering.factors[key] = list(best)
        pairs.changed(key)


def _may_pair(numbering: Numbering, a: int, b: int) -> bool:
    return not (a in numbering.inverse and b in numbering.inverse)


def share_sums(numbering: Numbering) -> None:
    """Compute every signed pair of terms that several sums have in common once."""
    pairs = PairCounts(
        numbering.addends, lambda own: {_pair(p, q) for p, q in combinations(own, 2)}
    )
    while (best := pairs.most()) is not None:
        first, second, relative = best
        key, _ = numbering.key("pair", *best)
        for total in [k for k, own in pairs.own.items() if best in own and k != key]:
            _put_pair(numbering.addends[total], best, key)
            pairs.changed(total)
        numbering.addends[key] = [(1, first), (relative, second)]
        pairs.changed(key)


def _pair(p: SignedKey, q: SignedKey) -> tuple[int, int, int]:
    first, second = sorted((p, q), key=lambda term: term[1])
    return first[1], second[1], first[0] * second[0]


def _put_pair(addends: list[SignedKey], pair: tuple[int, int, int], key: int) -> None:
    first, second, relative = pair
    for sign in (1, -1):
        wanted = Counter([(sign, first), (sign * relative, second)])
        while not wanted - Counter(addends):
            for term in wanted.elements():
                addends.remove(term)
            addends.append((sign, key))


def orient(numbering: Numbering, results: Sequence[SignedKey | None]) -> list[SignedKey | None]:
    """Turn the signs of sums and constants so that few values must be negated.

    Returns the results so changed: a sum or constant with the opposite sign costs nothing.
    """
    changed = list(results)
    as_they_are = {key for _, terms in numbering.calls.values() for _, key in terms}
    as_they_are |= set(numbering.inverse.values())
    needed = _negations(numbering, changed)
    for key in [*numbering.addends, *numbering.constants] * 2:
        signed = _signed_by(numbering, key)
        if not signed & as_they_are:
            turned = _turned(numbering, changed, key, signed)
            now = _negations(numbering, turned)
            if now < needed:
                changed, needed = turned, now
            else:
                _turned(numbering, turned, key, signed)
    return changed


def _signed_by(numbering: Numbering, key: int) -> set[int]:
    """Return ``key`` and every product whose sign turns with it."""
    signed = {key}
    while True:
        odd = {
            product_key
            for product_key, factors in numbering.factors.items()
            if sum(factor in signed for factor in factors) % 2
        }
        if odd | {key} == signed:
            return signed
        signed = odd | {key}


def _turned(
    numbering: Numbering, results: Sequence[SignedKey | None], key: int, signed: set[int]
) -> list[SignedKey | None]:
    """Give ``key`` the opposite sign and turn every use of it; return the results so changed."""
    if key in numbering.constants:
        factor, node = numbering.constants[key]
        numbering.constants[key] = (-factor, node)
    else:
        numbering.addends[key] = [(-sign, addend) for sign, addend in numbering.addends[key]]
    for total, addends in numbering.addends.items():
        if any(addend in signed for _, addend in addends):
            numbering.addends[total] = [(-s, k) if k in signed else (s, k) for s, k in addends]
    return [(-r[0], r[1]) if r is not None and r[1] in signed else r for r in results]


def _negations(numbering: Numbering, results: Sequence[SignedKey | None]) -> int:
    """Return how many values must be negated: sums without a plus, and negative results."""
    sums = sum(all(sign < 0 for sign, _ in addends) for addends in numbering.addends.values())
    return sums + len({r for r in results if r is not None and r[0] < 0})
