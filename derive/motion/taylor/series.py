"""A step by power series: data that any arithmetic runs and that prints as C or CasADi loops.

``Program`` has no arrays; a Taylor step of order 20 without them would be ten thousand lines. What
a value v is called: ``v`` at order 0, ``v_k`` its term of order k, ``v_terms`` all its terms.
Terms carry their power of the step: term k is the k-th derivative times h^k / k!.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from derive.program.arithmetic import FLOPS
from derive.program.program import Op, Operand, Program, Quantity

# What is known by these names at order k: k, 1/k and h/(k + 1).
ORDER, INVERSE, SHARE = "order_k", "one_over_k", "step_over_k_plus_1"
# And in ``close``: by how much terms fall where the last is u: u^(1/order); the number that makes
# the last term 1 that one aims at; the smallest normal number.
REACH, OVER_AIM, TINY = "reach", "over_aim", "tiny"
SAFETY = Fraction(9, 10)  # of a step whose last term is u
# Terms fall by this at least: over a longer step the radius of convergence changes too much to be
# known beforehand. It matters in float only, where order 16 would lose three digits.
SLOWEST = Fraction(1, 4)

MOST_BITS = 53  # of a precision that a step is proposed for

Pairs = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Convolution:
    """``result`` = sum of left_j right_(k-j) over ``plus`` less the same over ``minus``, 0 < j < k.

    The ends j = 0 and j = k are not in it: so it needs nothing of order k, and all of them run in
    one loop. In ``Series.squares`` left is right, and equal products are worked out once.
    """

    result: str
    plus: Pairs
    minus: Pairs


@dataclass(frozen=True)
class Series:
    """One step of ``order`` terms.

    start : operations at order 0          products, squares : the sums over j at order k
    each : operations at order k           kept : values whose terms are kept
    rates : for each state that moves, its rate at order 0 and at order k
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

    def closing(self, bits: int) -> tuple[Op, ...]:
        """Return the operations after the sum, with the numbers of a precision in them."""
        numbers = precision_values(self.order, bits)

        def told(operand: Operand) -> Operand:
            return numbers.get(operand, operand) if isinstance(operand, str) else operand

        return tuple(Op(op.result, op.operator, tuple(map(told, op.operands))) for op in self.close)

    @property
    def signature(self) -> Program:
        """Return a program with the same arguments and no operations."""
        return Program(self.name, self.says, self.inputs, self.outputs, (), self.results)

    def kept_only(self) -> list[str]:
        """Return the values whose terms are kept beside the states'."""
        return [name for name in self.kept if name not in self.rates]

    def read_at_k(self) -> set[Operand]:
        """Return what the operations at order k, and the rates, read."""
        rates = {rate for _, rate in self.rates.values()} | {SHARE}
        return rates.union(*(op.operands for op in self.each))

    def count(self) -> dict[str, int]:
        """Return how often each operator is used in a step."""
        found: dict[str, int] = {}
        for operator, times in self._uses():
            found[operator] = found.get(operator, 0) + times
        return {operator: times for operator, times in sorted(found.items()) if times}

    def flops(self) -> int:
        """Return the number of + - * / in a step."""
        return sum(times for operator, times in self._uses() if operator in FLOPS)

    def operands(self) -> set[str]:
        """Return the names that the operations refer to."""
        every = [o for op in (*self.start, *self.each, *self.close) for o in op.operands]
        every += [o for rates in self.rates.values() for o in rates]
        return {o for o in every if isinstance(o, str)}

    def run(self, arithmetic: Mapping[str, Callable[..., Any]], known: dict[str, Any]) -> list[Any]:
        """Return the results in an arithmetic, from the inputs by name."""
        unit = arithmetic["unit_roundoff"]()
        high = unit[0] if isinstance(unit, tuple) else unit  # of a pair
        bits = min(MOST_BITS, round(-math.log2(float(high))))
        given = [known[c] for q in self.inputs for c in q.components]
        return run_series(self, arithmetic, given, bits)

    def _uses(self) -> Iterator[tuple[str, int]]:
        orders = range(1, self.order)
        yield from ((op.operator, 1) for op in (*self.start, *self.close))
        yield from ((op.operator, len(orders)) for op in self.each)
        for sums, passes in (
            (self.products, sum(k - 1 for k in orders)),
            (self.squares, sum(k // 2 for k in orders)),
        ):
            for convolution in sums:
                yield "mul", passes * len((*convolution.plus, *convolution.minus))
                yield "add", passes * len(convolution.plus)
                yield "sub", passes * len(convolution.minus)
        yield "add", len(self.squares) * len(orders)
        yield "div", len(orders) * (1 + (INVERSE in self.read_at_k()))
        yield "mul", len(self.rates) * self.order
        yield "add", len(self.rates) * (self.order - 1)


def precision_values(order: int, bits: int) -> dict[str, Fraction]:
    """Return the numbers in ``close`` that rest on the precision."""
    reach = min(Fraction(2.0 ** (-bits / order)).limit_denominator(1000), SLOWEST)
    tiny = Fraction(1, 2**126 if bits == 24 else 2**1022)
    return {REACH: reach, OVER_AIM: 1 / (SAFETY * reach) ** order, TINY: tiny}


def run_series(
    series: Series, arithmetic: Mapping[str, Callable[..., Any]], values: Sequence[Any], bits: int
) -> list[Any]:
    """Run a step in an arithmetic, operation by operation as the C does.

    ``values`` are the input components in declared order, the length of the step last; ``bits``
    is the precision that the proposed step is for.
    """
    known = _inputs(series, values)
    terms = series_terms(series, arithmetic, values)
    add = arithmetic["add"]
    for x in series.rates:
        own = terms[x]
        total = own[series.order]
        for k in range(series.order - 1, 0, -1):
            total = add(total, own[k])
        names = (f"{x}_sum", f"{x}_last", f"{x}_before", f"{x}_first")
        known.update(zip(names, (total, own[-1], own[-2], own[1]), strict=True))
    return _operate(series.closing(bits), known, arithmetic, series.results)


def series_terms(
    series: Series, arithmetic: Mapping[str, Callable[..., Any]], values: Sequence[Any]
) -> dict[str, list[Any]]:
    """Return the terms of the states and of all that is kept, by name; place k is order k."""
    mul, div, number = (arithmetic[name] for name in ("mul", "div", "number"))
    known = _inputs(series, values)
    step = values[-1]
    rates = [rate for rate, _ in series.rates.values()]
    first = _operate(series.start, known, arithmetic, rates)
    terms = {x: [known[x], mul(step, rate)] for x, rate in zip(series.rates, first, strict=True)}
    terms |= {name: [None] for name in series.kept_only()}
    for k in range(1, series.order):
        now = known | {f"{x}_k": terms[x][k] for x in series.rates}
        now[ORDER], now[SHARE] = number(Fraction(k)), div(step, number(Fraction(k + 1)))
        now[INVERSE] = div(number(Fraction(1)), number(Fraction(k)))
        for sums, convolved in ((series.products, _convolved), (series.squares, _squared)):
            now |= {c.result: convolved(c, terms, k, arithmetic) for c in sums}
        rates = [rate for _, rate in series.rates.values()]
        found = _operate(series.each, now, arithmetic, rates)
        for name in series.kept_only():
            terms[name].append(now[f"{name}_k"])
        for x, rate in zip(series.rates, found, strict=True):
            terms[x].append(mul(now[SHARE], rate))
    return terms


def _inputs(series: Series, values: Sequence[Any]) -> dict[str, Any]:
    names = [name for quantity in series.inputs for name in quantity.components]
    return dict(zip(names, values, strict=True))


def _operate(
    ops: Sequence[Op],
    known: dict[str, Any],
    arithmetic: Mapping[str, Callable[..., Any]],
    wanted: Sequence[Operand],
) -> list[Any]:
    def value(operand: Operand) -> Any:
        return known[operand] if isinstance(operand, str) else arithmetic["number"](operand)

    for op in ops:
        known[op.result] = arithmetic[op.operator](*map(value, op.operands))
    return [value(operand) for operand in wanted]


Terms = Mapping[str, Sequence[Any]]
Table = Mapping[str, Callable[..., Any]]


def _added(total: Any, c: Convolution, terms: Terms, j: int, m: int, table: Table) -> Any:
    """Return ``total`` with the products of terms j and m: as C has it, their sum is made first."""
    products = [
        (sign, table["mul"](terms[left][j], terms[right][m]))
        for sign, pairs in (("add", c.plus), ("sub", c.minus))
        for left, right in pairs
    ]
    (outer, inner), *rest = products
    for sign, product in rest:
        inner = table[sign if outer == "add" else "add"](inner, product)
    return table[outer](total, inner)


def _convolved(c: Convolution, terms: Terms, k: int, table: Table) -> Any:
    total = table["number"](Fraction(0))
    for j in range(1, k):
        total = _added(total, c, terms, j, k - j, table)
    return total


def _squared(c: Convolution, terms: Terms, k: int, table: Table) -> Any:
    total = table["number"](Fraction(0))
    for j in range(1, (k + 1) // 2):
        total = _added(total, c, terms, j, k - j, table)
    total = table["add"](total, total)
    return _added(total, c, terms, k // 2, k // 2, table) if k % 2 == 0 else total
