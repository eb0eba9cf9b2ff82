"""A step by power series as a program: loops over orders, everything computed before it is stored.

A Taylor step of order 20 without arrays would be ten thousand lines. What a value v is called:
``v`` at order 0, ``v_k`` its term of order k, ``v_terms`` all its terms. Terms carry their power
of the step: term k is the k-th derivative times h^k / k!.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce

from derive.program.indexed import (
    Arrays,
    Assign,
    Element,
    Even,
    Index,
    IndexedOperand,
    Loop,
    Term,
    Whole,
)
from derive.program.program import Line, Op, Operand, Program, Quantity

# What is known by these names at order k: k, 1/k and h/(k + 1).
ORDER, INVERSE, SHARE = "order_k", "one_over_k", "step_over_k_plus_1"
# And in ``close``: by how much terms fall where the last is u: u^(1/order); the number that makes
# the last term 1 that one aims at; the smallest normal number.
REACH, OVER_AIM, TINY = "reach", "over_aim", "tiny"
SAFETY = Fraction(9, 10)  # of a step whose last term is u
# Terms fall by this at least: over a longer step the radius of convergence changes too much to be
# known beforehand. It matters in float only, where order 16 would lose three digits.
SLOWEST = Fraction(1, 4)

FactorPairs = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Convolution:
    """``result`` = sum of left_j right_(k-j) over ``plus`` less the same over ``minus``, 0 < j < k.

    The ends j = 0 and j = k are not in it: so it needs nothing of order k, and all of them run in
    one loop. In ``TaylorStep.squares`` left is right, and equal products are worked out once.
    """

    result: str
    plus: FactorPairs
    minus: FactorPairs


@dataclass(frozen=True)
class TaylorStep:
    """One step of ``order`` terms.

    start : operations at order 0          products, squares : the sums over j at order k
    each : operations at order k           kept : values whose terms are kept
    rates : for each state that varies, its rate at order 0 and at order k
    close : operations after the sum; they read ``x_sum`` (all terms but 0), ``x_last``,
            ``x_before`` (the last two) and ``x_first`` of the states
    """

    name: str
    says: str
    inputs: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    order: int
    start: tuple[Op, ...]
    products: tuple[Convolution, ...]
    squares: tuple[Convolution, ...]
    each: tuple[Op, ...]
    kept: tuple[str, ...]
    rates: Mapping[str, tuple[Operand, Operand]]
    close: tuple[Op, ...]
    results: tuple[Operand, ...]

    def kept_only(self) -> list[str]:
        """Return the values whose terms are kept beside the states'."""
        return [name for name in self.kept if name not in self.rates]


def precision_values(order: int, bits: int) -> dict[str, Fraction]:
    """Return the numbers in ``close`` that rest on the precision."""
    reach = min(Fraction(2.0 ** (-bits / order)).limit_denominator(1000), SLOWEST)
    tiny = Fraction(1, 2**126 if bits == 24 else 2**1022)
    return {REACH: reach, OVER_AIM: 1 / (SAFETY * reach) ** order, TINY: tiny}


def in_loops(step: TaylorStep) -> Program:
    """Return the step as a program."""
    last, names = step.order, list(step.rates)
    by_bits = {bits: precision_values(last, bits) for bits in (24, 53)}
    lines: list[Line] = [
        *(Arrays(((f"{x}_terms", (last + 1,)),)) for x in names),
        *(Arrays(((f"{name}_terms", (last,)),)) for name in step.kept_only()),
        *step.start,
        *(Assign(f"{x}_terms[1]", _times("time_step", r)) for x, (r, _) in step.rates.items()),
        Loop(K, Index(plus=1), Index(plus=last), tuple(_order(step))),
        *(Assign(f"{x}_sum", f"{x}_terms[{last}]", makes="variable") for x in names),
        Loop(
            K,
            Index(plus=last - 1),
            Index(),
            tuple(Assign(f"{x}_sum", _term(x, K), "add") for x in names),
            step=-1,
        ),
        *_ends(step),
        *step.close,
    ]
    return Program(
        step.name,
        step.says,
        step.inputs,
        step.outputs,
        tuple(lines),
        step.results,
        numbers={n: {bits: q[n] for bits, q in by_bits.items()} for n in by_bits[24]},
    )


K = "k"


def _term(name: str, counter: str, plus: int = 0) -> Element:
    return Element(f"{name}_terms", (Index(counter, plus),))


def _times(a: IndexedOperand, b: IndexedOperand) -> Term:
    return Term("mul", (a, b))


def _order(step: TaylorStep) -> Iterator[Line]:
    """Yield the body of the loop over k: terms of order k, those of the states of order k + 1."""
    given: dict[str, IndexedOperand] = {
        SHARE: Term("div", ("time_step", Whole(Index(K, 1)))),
        ORDER: Whole(Index(K)),
        INVERSE: Term("div", (Fraction(1), Whole(Index(K)))),
        **{f"{x}_k": _term(x, K) for x in step.rates},
    }
    rates = {x: rate for x, (_, rate) in step.rates.items()}
    moved = {SHARE for rate in rates.values() if rate != 0}
    read = {*moved, *rates.values()}.union(*(op.operands for op in step.each))
    yield from (Assign(n, v, makes="constant") for n, v in given.items() if n in read)
    yield from _sums(step)
    yield from step.each
    yield from (Assign(_term(name, K), f"{name}_k") for name in step.kept_only())
    for x, rate in rates.items():
        yield Assign(_term(x, K, 1), _times(SHARE, rate) if rate != 0 else Fraction(0))


def _sums(step: TaylorStep) -> Iterator[Line]:
    every = (*step.products, *step.squares)
    yield from (Assign(c.result, Fraction(0), makes="variable") for c in every)
    for sums, meets in ((step.products, False), (step.squares, True)):
        if sums:
            body = tuple(_added(c, "j", "m") for c in sums)
            yield Loop("j", Index(plus=1), Index(K), body, mirror="m", meets=meets)
    if step.squares:
        yield from (Assign(c.result, c.result, "add") for c in step.squares)
        yield Even(K, "m", tuple(_added(c, "m", "m") for c in step.squares))


def _added(c: Convolution, j: str, m: str) -> Assign:
    """Return the statement that adds the products of terms j and m: their sum is made first."""
    plus, minus = (
        [_times(_term(left, j), _term(right, m)) for left, right in pairs]
        for pairs in (c.plus, c.minus)
    )
    if not plus:
        return Assign(c.result, reduce(lambda a, b: Term("add", (a, b)), minus), "sub")
    total = reduce(lambda a, b: Term("add", (a, b)), plus)
    return Assign(c.result, reduce(lambda a, b: Term("sub", (a, b)), minus, total), "add")


def _ends(step: TaylorStep) -> Iterator[Line]:
    """Yield the names that the end of a step gives to single terms."""
    read = {operand for op in step.close for operand in op.operands}
    ends = {"first": 1, "before": step.order - 1, "last": step.order}
    for x in step.rates:
        for end, k in ends.items():
            if f"{x}_{end}" in read:
                yield Assign(f"{x}_{end}", f"{x}_terms[{k}]", makes="constant")
