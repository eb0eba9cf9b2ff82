"""The products and sums that some outputs need: multisets of factors, multisets of signed terms.

A key stands for one product, sum, call, input or constant; keys are numbered as they are met, so
nothing depends on names.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from derive.lower.graph import UNIT, Graph, Value

Signed = tuple[int, int]  # sign, key


@dataclass
class Table:
    """The products and sums that the outputs need, by key; a key orders as it was first met."""

    graph: Graph
    known: Callable[[int], bool]
    keys: dict[tuple[object, ...], int] = field(default_factory=dict)
    factors: dict[int, list[int]] = field(default_factory=dict)
    addends: dict[int, list[Signed]] = field(default_factory=dict)
    constants: dict[int, Value] = field(default_factory=dict)
    calls: dict[int, tuple[str, list[Signed]]] = field(default_factory=dict)
    leaves: dict[int, str] = field(default_factory=dict)
    inverse: dict[int, int] = field(default_factory=dict)
    entered: dict[Value, Signed] = field(default_factory=dict)

    def key(self, *identity: object) -> tuple[int, bool]:
        """Return the number of an identity and whether it is new."""
        new = identity not in self.keys
        return self.keys.setdefault(identity, len(self.keys)), new


def enter(table: Table, value: Value) -> Signed:
    """Enter a value that is not constant; return its sign and key."""
    if value not in table.entered:
        table.entered[value] = _entered(table, value)
    return table.entered[value]


def _entered(table: Table, value: Value) -> Signed:
    graph = table.graph
    coefficient, node = value
    sign = 1 if coefficient > 0 else -1
    inner = graph.inside(node)
    if inner is not None and abs(coefficient) == 1 and not table.known(node):
        inner_sign, key = enter(table, inner)
        return sign * inner_sign, key
    if abs(coefficient) != 1 and _absorbs(table, node):
        return sign, _scaled_sum(table, abs(coefficient), node)
    powers = graph.nodes[node][1] if graph.nodes[node][0] == "product" else ((node, 1),)
    known = [graph.power((UNIT[0], n), p) for n, p in powers if table.known(n)]
    constant = graph.scaled(graph.mul(known), abs(coefficient))
    sign *= 1 if constant[0] > 0 else -1
    factors: list[int] = []
    if (abs(constant[0]), constant[1]) != UNIT:
        factors.append(_constant(table, (abs(constant[0]), constant[1])))
    for base, power in powers:
        if not table.known(base):
            base_sign, key = _node(table, base)
            sign *= base_sign if power % 2 else 1
            factors += [key if power > 0 else _inverse(table, key)] * abs(power)
    return sign, product(table, factors)


def _absorbs(table: Table, node: int) -> bool:
    """Tell whether a number in front of a sum vanishes into constants of all its terms."""
    kind, *rest = table.graph.nodes[node]
    return kind == "sum" and all(table.known(n) or _has_constant(table, n) for _, n in rest[0])


def _has_constant(table: Table, node: int) -> bool:
    kind, *rest = table.graph.nodes[node]
    return kind == "product" and any(table.known(base) for base, _ in rest[0])


def _scaled_sum(table: Table, factor: Fraction, node: int) -> int:
    key, new = table.key("sum", factor, node)
    if new:
        these = table.graph.nodes[node][1]
        table.addends[key] = _addends(table, [(factor * c, n) for c, n in these])
    return key


def _constant(table: Table, value: Value) -> int:
    key, _ = table.key("constant", value)
    table.constants[key] = value
    return key


def _inverse(table: Table, key: int) -> int:
    inverse, _ = table.key("inverse", key)
    table.inverse[inverse] = key
    return inverse


def product(table: Table, factors: list[int]) -> int:
    if len(factors) == 1 and factors[0] not in table.inverse:
        return factors[0]
    key, _ = table.key("product", *sorted(factors))
    table.factors[key] = sorted(factors)
    return key


def _node(table: Table, node: int) -> Signed:
    kind, *rest = table.graph.nodes[node]
    if kind in ("let", "cut"):
        return enter(table, rest[0])
    if kind == "product":
        return enter(table, (UNIT[0], node))
    key, new = table.key(kind, node)
    if new and kind == "input":
        table.leaves[key] = rest[0]
    elif new and kind == "call":
        table.calls[key] = (rest[0], [_operand(table, value) for value in rest[1]])
    elif new:
        table.addends[key] = _addends(table, rest[0])
    return 1, key


def _addends(table: Table, these: Sequence[Value]) -> list[Signed]:
    constant = table.graph.add([(c, n) for c, n in these if table.known(n)])
    varying = [enter(table, (c, n)) for c, n in these if not table.known(n)]
    return varying + ([_operand(table, constant)] if constant[0] else [])


def _operand(table: Table, value: Value) -> Signed:
    if not table.known(value[1]):
        return enter(table, value)
    sign = -1 if value[0] < 0 else 1
    return sign, _constant(table, (abs(value[0]), value[1]))
