"""Set-up's status at hostile parameters, beside what the scene declares, in balls of 400 bits.

The declaration is walked anew here: masses, lengths, and every principal part of every tensor that
set-up is told of. Left open is what pairs of floats cannot tell from singular, and what overflow
and underflow make of numbers near the ends of the floats' range: only 0 must then be right.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import inf, isfinite, nan
from random import Random
from typing import Any

import numpy as np
from flint import arb, arb_mat, ctx

from derive.program.precision import Precision
from derive.program.program import Program
from derive.program.status import CONSTANT, INERTIA, LENGTH, MASS, PARAMETER, RIGHT, SAYS, statuses
from derive.scene import Scene
from derive.scene.formula import Formula, evaluate, symbols
from derive.scene.machine import Tensor
from derive.verify.operators import IN_BALLS

BITS = 400
STATUS = {"mass": MASS, "length": LENGTH, "inertia": INERTIA}
ByPlace = Mapping[tuple[int, int], Any]


@dataclass(frozen=True)
class Told:
    """What set-up is told: values of its parameters, and of the scene's numbers and pi."""

    values: Mapping[str, Any]

    def all_of(self, formula: Formula | None) -> bool:
        """Tell whether a formula can be worked out."""
        return formula is not None and set(symbols(formula)) <= set(self.values)

    def __getitem__(self, formula: Formula) -> Any:
        return evaluate(formula, self.values, IN_BALLS)


@dataclass(frozen=True)
class Extremes:
    """Whether all constants are finite, and products of six parameters could overflow or vanish."""

    finite: bool
    huge: bool
    tiny: bool


def allowed(scene: Scene, values: Mapping[str, float], precision: Precision) -> set[int]:
    """Return each status that the declaration allows: one, or 0 and another where it is close.

    values : of set-up's parameters alone
    """
    if not all(map(isfinite, values.values())):
        return {PARAMETER}
    with ctx.workprec(BITS):
        fixed = {p.name: p.value for p in scene.parameters if p.value is not None}
        numbers = {name: IN_BALLS["number"](x) for name, x in fixed.items()}
        told = Told(numbers | {"pi": arb.pi()} | {n: arb(float(x)) for n, x in values.items()})
        found: set[int] = set()
        for status, margin in sorted(_margins(scene, told, precision), key=lambda m: m[0]):
            if margin <= 0:
                found.add(status)
            if margin < 0:
                return found
        return found | {RIGHT}


def _margins(scene: Scene, told: Told, precision: Precision) -> Iterator[tuple[int, int]]:
    """Yield the status of every rule, with 1 where it is kept, -1 where broken, 0 for close."""
    for demand in scene.demands:
        if isinstance(demand, Tensor):
            yield INERTIA, _judged(_tensor(demand.entries, told), demand.relation, precision)
        elif told.all_of(demand.formula):
            yield from _above(told[demand.formula], STATUS[demand.kind])


def _above(x: Any, status: int) -> Iterator[tuple[int, int]]:
    if x.is_finite():
        yield status, 1 if x > 0 else -1
    else:  # divided by zero: infinities of either sign
        yield status, 0
        yield CONSTANT, -1


def _tensor(inertia: Sequence[Formula | None], told: Told) -> dict[tuple[int, int], Any]:
    places = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    return {
        p: told[f] if p[0] == p[1] else -told[f]
        for p, f in zip(places, inertia, strict=True)
        if f is not None and told.all_of(f)
    }


def _judged(tensor: ByPlace, relation: str, precision: Precision) -> int:
    """Return 1 if a tensor is what it must be as far as it is known, -1 if not, 0 if it is close.

    A definite tensor must be told from others but for what pairs leave; of one that may be singular
    the entries come rounded, and a rod's is to be taken.
    """
    u = arb(2) ** -precision.bits
    least, most = (64 * u * u, -64 * u * u) if relation == "positive" else (0 * u, -8 * u)
    parts = [axes for size in (1, 2, 3) for axes in combinations(range(3), size)]
    found = 1
    for axes in (axes for axes in parts if _joined(tensor, axes)):
        trace = sum((abs(tensor[i, i]) for i in axes), arb(0)) if len(axes) > 1 else 0 * u
        tiny = arb(float(np.finfo(precision.dtype).smallest_normal)) if len(axes) > 1 else 0 * u
        if _minor(tensor, axes, most * trace - tiny) < 0:
            return -1
        lowest = _minor(tensor, axes, least * trace)
        if lowest < 0 or (relation == "positive" and not lowest > 0):
            found = 0 if len(axes) > 1 else -1
    return found


def _joined(tensor: ByPlace, axes: Sequence[int]) -> bool:
    """Tell whether a principal part is known and says more than smaller ones."""
    places = [(i, k) for i in axes for k in axes if i <= k]
    if not all(p in tensor for p in places):
        return False
    return sum(bool(tensor[i, k] != 0) for i, k in places if i != k) >= len(axes) - 1


def _minor(tensor: ByPlace, axes: Sequence[int], less: Any) -> Any:
    rows = [[tensor[min(i, k), max(i, k)] - (less if i == k else 0) for k in axes] for i in axes]
    return arb_mat(rows).det()


def hostile(
    setup: Program, precision: Precision, count: int, dice: Random
) -> list[dict[str, float]]:
    """Return parameters that no body may have: zeros, signs, ends of the floats, exchanged ones."""
    names = [c for q in setup.inputs for c in q.components]
    middle = {q.name: float(((q.low or 0) + (q.high or 0)) / 2) for q in setup.inputs}
    found = [dict(middle)]
    if not names:
        return found
    found += [middle | {n: x} for n in names for x in (0.0, -middle[n], nan, inf, -inf)]
    info = np.finfo(precision.dtype)
    ends = (float(info.max), float(info.smallest_normal), float(info.smallest_subnormal))
    while len(found) < count + 5 * len(names) + 1:
        values = dict(middle)
        for name in dice.sample(names, dice.randint(1, min(3, len(names)))):
            values[name] = _odd(values, name, dice, ends)
        found.append({n: float(precision.dtype(x)) for n, x in values.items()})
    return [{n: float(precision.dtype(x)) for n, x in values.items()} for values in found]


def _odd(values: Mapping[str, float], name: str, dice: Random, ends: Sequence[float]) -> float:
    x = values[name]
    other = values[dice.choice(sorted(values))]
    choices = (0.0, -x, x * 100, x / 100, other, -other, x * 1e5, x * 1e-5, *ends, -ends[0])
    return dice.choice((*choices, x * (0.5 + dice.random()), x * (0.5 + dice.random())))


def fault(
    scene: Scene, values: Mapping[str, float], precision: Precision, status: int, ends: Extremes
) -> str:
    """Return what is wrong with a status that set-up returned; "" if nothing is."""
    may = allowed(scene, values, precision)
    refused = set(SAYS) - {RIGHT, PARAMETER}
    if RIGHT in may:
        may = may if ends.finite else (may - {RIGHT}) | {CONSTANT}
        may |= refused if ends.tiny else {CONSTANT} if ends.huge else set()
    elif PARAMETER not in may and (ends.huge or ends.tiny):
        may = refused
    return "" if status in may else f"{status}, not {' or '.join(map(str, sorted(may)))}"


def extremes_of(values: Mapping[str, float], precision: Precision, *, finite: bool) -> Extremes:
    """Return how far parameters lie from the ends of the floats' range."""
    info = np.finfo(precision.dtype)
    low, high = float(info.smallest_normal) ** (1 / 6), float(info.max) ** (1 / 6)
    sizes = [abs(x) for x in values.values() if isfinite(x)]
    return Extremes(finite, any(x > high for x in sizes), any(0 < x < low for x in sizes))


def replayed_statuses(
    setup: Program, each: Sequence[Mapping[str, float]], precision: Precision
) -> list[int]:
    """Return what the program says of each set of parameters."""
    names = [c for q in setup.inputs for c in q.components]
    columns = [np.array([values[n] for values in each]) for n in names]
    return [int(s) for s in statuses(setup, columns, precision.dtype)]
