"""The products and sums that some outputs need: multisets of factors, multisets of signed terms.

A key stands for one product, sum, call, input or constant; keys are numbered as they are met, so
nothing depends on names.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from derive.lower.graph import UNIT, Graph, Value

SignedKey = tuple[int, int]  # sign, key


@dataclass
class Numbering:
    """The products and sums that the outputs need, by key; a key orders as it was first met."""

    graph: Graph
    fixed: Callable[[int], bool]
    keys: dict[tuple[object, ...], int] = field(default_factory=dict)
    factors: dict[int, list[int]] = field(default_factory=dict)
    addends: dict[int, list[SignedKey]] = field(default_factory=dict)
    constants: dict[int, Value] = field(default_factory=dict)
    calls: dict[int, tuple[str, list[SignedKey]]] = field(default_factory=dict)
    leaves: dict[int, str] = field(default_factory=dict)
    inverse: dict[int, int] = field(default_factory=dict)
    entered: dict[Value, SignedKey] = field(default_factory=dict)

    def key(self, *identity: object) -> tuple[int, bool]:
        """Return the number of an identity and whether it is new."""
        new = identity not in self.keys
        return self.keys.setdefault(identity, len(self.keys)), new


def enter(numbering: Numbering, value: Value) -> SignedKey:
    """Enter a value that is not constant; return its sign and key."""
    if value not in numbering.entered:
        numbering.entered[value] = _entered(numbering, value)
    return numbering.entered[value]


def _entered(numbering: Numbering, value: Value) -> SignedKey:
    graph = numbering.graph
    coefficient, node = value
    sign = 1 if coefficient > 0 else -1
    inner = graph.inside(node)
    if inner is not None and abs(coefficient) == 1 and not numbering.fixed(node):
        inner_sign, key = enter(numbering, inner)
        return sign * inner_sign, key
    if abs(coefficient) != 1 and _absorbs(numbering, node):
        return sign, _scaled_sum(numbering, abs(coefficient), node)
    powers = graph.nodes[node][1] if graph.nodes[node][0] == "product" else ((node, 1),)
    fixed = [graph.power((UNIT[0], n), p) for n, p in powers if numbering.fixed(n)]
    constant = graph.scaled(graph.mul(fixed), abs(coefficient))
    sign *= 1 if constant[0] > 0 else -1
    factors: list[int] = []
    if (abs(constant[0]), constant[1]) != UNIT:
        factors.append(_constant(numbering, (abs(constant[0]), constant[1])))
    for base, power in powers:
        if not numbering.fixed(base):
            base_sign, key = _node(numbering, base)
            sign *= base_sign if power % 2 else 1
            factors += [key if power > 0 else _inverse(numbering, key)] * abs(power)
    return sign, product_key(numbering, factors)


def _absorbs(numbering: Numbering, node: int) -> bool:
    """Tell whether a number in front of a sum vanishes into constants of all its terms."""
    kind, *rest = numbering.graph.nodes[node]
    return kind == "sum" and all(
        numbering.fixed(n) or _has_constant(numbering, n) for _, n in rest[0]
    )


def _has_constant(numbering: Numbering, node: int) -> bool:
    kind, *rest = numbering.graph.nodes[node]
    return kind == "product" and any(numbering.fixed(base) for base, _ in rest[0])


def _scaled_sum(numbering: Numbering, factor: Fraction, node: int) -> int:
    key, new = numbering.key("sum", factor, node)
    if new:
        these = numbering.graph.nodes[node][1]
        numbering.addends[key] = _addends(numbering, [(factor * c, n) for c, n in these])
    return key


def _constant(numbering: Numbering, value: Value) -> int:
    key, _ = numbering.key("constant", value)
    numbering.constants[key] = value
    return key


def _inverse(numbering: Numbering, key: int) -> int:
    inverse, _ = numbering.key("inverse", key)
    numbering.inverse[inverse] = key
    return inverse


def product_key(numbering: Numbering, factors: list[int]) -> int:
    if len(factors) == 1 and factors[0] not in numbering.inverse:
        return factors[0]
    key, _ = numbering.key("product", *sorted(factors))
    numbering.factors[key] = sorted(factors)
    return key


def _node(numbering: Numbering, node: int) -> SignedKey:
    kind, *rest = numbering.graph.nodes[node]
    if kind in ("let", "cut"):
        return enter(numbering, rest[0])
    if kind == "product":
        return enter(numbering, (UNIT[0], node))
    key, new = numbering.key(kind, node)
    if new and kind == "input":
        numbering.leaves[key] = rest[0]
    elif new and kind == "call":
        numbering.calls[key] = (rest[0], [_operand(numbering, value) for value in rest[1]])
    elif new:
        numbering.addends[key] = _addends(numbering, rest[0])
    return 1, key


def _addends(numbering: Numbering, these: Sequence[Value]) -> list[SignedKey]:
    constant = numbering.graph.add([(c, n) for c, n in these if numbering.fixed(n)])
    varying = [enter(numbering, (c, n)) for c, n in these if not numbering.fixed(n)]
    return varying + ([_operand(numbering, constant)] if constant[0] else [])


def _operand(numbering: Numbering, value: Value) -> SignedKey:
    if not numbering.fixed(value[1]):
        return enter(numbering, value)
    sign = -1 if value[0] < 0 else 1
    return sign, _constant(numbering, (abs(value[0]), value[1]))
