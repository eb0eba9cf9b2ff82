"""Expressions as a graph in sum-of-products form, in which equal values are one node.

A value is an exact coefficient times a node. Sums and products are kept flat and in canonical
order (the order in which nodes came to be), so what is equal is found equal whatever the symbols
are called. A ``let`` names a value that is worth computing once; a ``cut`` does so for good:
``expand`` looks through a let and stops at a cut.
"""

from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

# A node's kind and what it is made of: one; input and its name; sum and its (coefficient, node)
# terms; product and its (node, power) factors; call, function and values; let or cut and a value.
Node = tuple[Any, ...]
Value = tuple[Fraction, int]

ONE = 0
ZERO: Value = (Fraction(0), ONE)
UNIT: Value = (Fraction(1), ONE)


def _times(a: Fraction, b: Fraction) -> Fraction:
    """Return a product: what a factor of one leaves is not made anew."""
    if b == 1:
        return a
    return b if a == 1 else a * b


class Graph:
    """An arena of nodes; node numbers order the arena and never depend on names.

    ``costs`` keeps what outputs were found to cost: nodes do not change.
    """

    def __init__(self) -> None:
        self.nodes: list[Node] = [("one",)]
        self.fixed: list[bool] = [True]
        self.names: dict[int, str] = {}
        self.families: dict[int, str] = {}
        self.costs: dict[tuple[Value, ...], tuple[int, int]] = {}
        self._number: dict[Node, int] = {("one",): ONE}

    def _node(self, node: Node, parts: Iterable[int]) -> int:
        """Return the number of a node; it is fixed if all its parts are."""
        if node not in self._number:
            self._number[node] = len(self.nodes)
            self.nodes.append(node)
            self.fixed.append(all(self.fixed[part] for part in parts))
        return self._number[node]

    def parameter(self, name: str) -> Value:
        """Return the leaf of a parameter: known before the function is called."""
        return Fraction(1), self._node(("input", name), ())

    def variable(self, name: str) -> Value:
        """Return the leaf of an input that changes from call to call."""
        node = self._node(("input", name), ())
        self.fixed[node] = False
        return Fraction(1), node

    def number(self, value: Fraction | int) -> Value:
        """Return an exact number."""
        return Fraction(value), ONE

    def add(self, values: Iterable[Value]) -> Value:
        """Return the sum of ``values``, flat, like terms collected."""
        terms: dict[int, Fraction] = {}
        for coefficient, node in values:
            inner = self.nodes[node][1] if self.nodes[node][0] == "sum" else ((UNIT[0], node),)
            for factor, term in inner:
                scaled = _times(coefficient, factor)
                terms[term] = terms[term] + scaled if term in terms else scaled
        flat = sorted((node, c) for node, c in terms.items() if c)
        if not flat:
            return ZERO
        if len(flat) == 1:
            return flat[0][1], flat[0][0]
        sign = 1 if flat[0][1] > 0 else -1
        alike = len({abs(c) for _, c in flat}) == 1
        content = sign * (abs(flat[0][1]) if alike else UNIT[0])
        own = flat if content == 1 else [(n, c / content) for n, c in flat]
        return content, self._node(("sum", tuple((c, n) for n, c in own)), [n for n, _ in flat])

    def scaled(self, value: Value, factor: Fraction) -> Value:
        """Return ``value`` times a number."""
        coefficient = _times(value[0], factor)
        return coefficient, value[1] if coefficient else ONE

    def mul(self, values: Iterable[Value]) -> Value:
        """Return the product of ``values``, flat, powers collected."""
        coefficient, powers = UNIT[0], dict[int, int]()
        for factor, node in values:
            coefficient = _times(coefficient, factor)
            inner = self.nodes[node][1] if self.nodes[node][0] == "product" else ((node, 1),)
            for base, power in inner:
                powers[base] = powers.get(base, 0) + power
        squared = [
            n for n, p in powers.items() if abs(p) > 1 and self.nodes[n][:2] == ("call", "sqrt")
        ]
        if squared:
            return self.mul([(coefficient, ONE), *self._without_roots(powers)])
        flat = tuple(sorted((n, p) for n, p in powers.items() if p and n != ONE))
        if not coefficient or not flat:
            return coefficient, ONE
        if len(flat) == 1 and flat[0][1] == 1:
            return coefficient, flat[0][0]
        return coefficient, self._node(("product", flat), [n for n, _ in flat])

    def _without_roots(self, powers: Mapping[int, int]) -> list[Value]:
        """Return factors with every square of a square root replaced by what is under it."""
        factors: list[Value] = []
        for node, power in powers.items():
            pairs, rest = divmod(power, 2)
            if self.nodes[node][:2] == ("call", "sqrt") and abs(power) > 1:
                factors += [self.power(self.nodes[node][2][0], pairs)]
                factors += [(Fraction(1), node)] * rest
            else:
                factors.append(self.power((Fraction(1), node), power))
        return factors

    def power(self, value: Value, exponent: int) -> Value:
        """Return ``value`` to an integer power, negative for a division."""
        if exponent == 1:
            return value
        coefficient, node = value
        inner = self.nodes[node][1] if self.nodes[node][0] == "product" else ((node, 1),)
        raised = [
            self._raised(base, 1 if power * exponent > 0 else -1)
            for base, power in inner
            for _ in range(abs(power * exponent))
        ]
        scale = coefficient if coefficient == 1 else coefficient**exponent
        return self.mul([(scale, ONE), *raised])

    def _raised(self, base: int, sign: int) -> Value:
        if sign > 0 or base == ONE:
            return UNIT[0], base
        return UNIT[0], self._node(("product", ((base, -1),)), [base])

    def call(self, function: str, *values: Value) -> Value:
        """Return ``function`` of ``values``: sin, cos, sqrt or power_of_two."""
        return Fraction(1), self._node(("call", function, values), [node for _, node in values])

    def let(self, name: str, value: Value, family: str = "") -> Value:
        """Name a value that is worth computing once; plain leaves and numbers stay themselves.

        Lets of one ``family`` are components of one vector; without it a let is alone.
        """
        named = self._named("let", name, value)
        if family:
            self.families.setdefault(named[1], family)
        return named

    def cut(self, name: str, value: Value) -> Value:
        """Name a value that must be computed as it stands, even when its users are expanded."""
        return self._named("cut", name, value)

    def _named(self, kind: str, name: str, value: Value) -> Value:
        coefficient, node = value
        if self.nodes[node][0] in ("one", "input", "let", "cut") and abs(coefficient) in (0, 1):
            return value
        if node == ONE:
            return value
        number = self._node((kind, value), [node])
        while ("input", name) in self._number:  # a scene may call what is given as we call a part
            name += "'"
        self.names.setdefault(number, name)
        return Fraction(1), number

    def below(self, node: int) -> list[int]:
        """Return the nodes that ``node`` is made of."""
        kind, *rest = self.nodes[node]
        if kind in ("let", "cut"):
            return [rest[0][1]]
        if kind in ("sum", "call"):
            return [n for _, n in rest[-1]]
        return [n for n, _ in rest[0]] if kind == "product" else []

    def within(self, values: Iterable[Value]) -> list[int]:
        """Return the nodes that ``values`` are made of, parts before what is made of them."""
        found: dict[int, None] = {}
        for _, top in values:
            waiting = [top]
            while waiting:
                parts = [] if waiting[-1] in found else self.below(waiting[-1])
                if missing := [n for n in parts if n not in found]:
                    waiting += reversed(missing)
                else:
                    found[waiting.pop()] = None
        return list(found)

    def leaf_names(self) -> set[str]:
        """Return the names of all inputs."""
        return {node[1] for node in self.nodes if node[0] == "input"}

    def inside(self, node: int) -> Value | None:
        """Return what a let or cut stands for, else None."""
        kind, *rest = self.nodes[node]
        return rest[0] if kind in ("let", "cut") else None
