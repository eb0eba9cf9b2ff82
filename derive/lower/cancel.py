"""Sums without terms that cancel identically: what is nothing in any state is not computed.

Products of named sums hide terms that take each other away: along its own axis e a wheel's spin s
has e . (omega x s e) = 0, which component by component is two large terms less each other. What
rounding leaves of these may be far more than all that remains. So sums are multiplied out on the
side, addend by addend; addends that hold such terms are put together again without them.
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce
from math import prod

from derive.lower.expand import Monomial, factored, multiplied_out
from derive.lower.graph import UNIT, Graph, Value

ByMonomial = dict[Monomial, Fraction]

MOST_TERMS, MOST_PRODUCTS = 400, 2000  # looked into; beyond, a node stands for itself


def what_is_left(graph: Graph, forms: Iterable[Sequence[Value]]) -> list[tuple[Value, ...]]:
    """Return forms without products that cancel identically; the same values if none do.

    >>> g = Graph()
    >>> x, y, z = (g.variable(name) for name in "xyz")
    >>> inner = g.let("a", g.add([x, y]))
    >>> lost = g.add([g.mul([z, inner]), g.scaled(g.mul([z, y]), Fraction(-1))])
    >>> what_is_left(g, [[lost]]) == [(g.mul([x, z]),)]
    True
    """
    found = Cancelling(MultipliedOut(graph))
    return [found.all(form) for form in forms]


@dataclass
class MultipliedOut:
    """What the nodes of a graph are when multiplied out.

    They are so in leaves, calls, cuts, denominators and sums too long to be looked into.
    """

    graph: Graph
    found: dict[int, ByMonomial] = field(default_factory=dict)

    def of(self, node: int) -> ByMonomial:
        """Return the terms of a node."""
        if node not in self.found:
            made = self._multiplied_out(node)
            whole: ByMonomial = {((node, 1),): UNIT[0]}
            self.found[node] = whole if made is None or len(made) > MOST_TERMS else made
        return self.found[node]

    def _multiplied_out(self, node: int) -> ByMonomial | None:
        """Return the terms of a node, None if it has none or too many."""
        kind, *rest = self.graph.nodes[node]
        match kind:
            case "one":
                return {(): UNIT[0]}
            case "let":
                return added([(rest[0][0], self.of(rest[0][1]))])
            case "sum":
                return added((c, self.of(n)) for c, n in rest[0])
            case "product":
                factors = [f for base, power in rest[0] for f in self._factors(base, power)]
                few = prod(map(len, factors)) <= MOST_PRODUCTS
                return reduce(_product, factors) if few else None
        return None

    def _factors(self, base: int, power: int) -> list[ByMonomial]:
        if power < 0:
            return [{((base, power),): UNIT[0]}]
        return [self.of(base)] * power


@dataclass
class Cancelling:
    """The nodes of a graph without the products that cancel in their sums."""

    terms: MultipliedOut
    made: dict[int, Value] = field(default_factory=dict)

    def all(self, values: Iterable[Value]) -> tuple[Value, ...]:
        """Return values without terms that cancel."""
        graph = self.terms.graph
        return tuple(graph.scaled(self._without(node), c) for c, node in values)

    def _without(self, node: int) -> Value:
        if node not in self.made:
            fixed = self.terms.graph.fixed[node]
            self.made[node] = (UNIT[0], node) if fixed else self._found(node)
        return self.made[node]

    def _found(self, node: int) -> Value:
        graph = self.terms.graph
        parts = {n: self._without(n) for n in graph.below(node)}
        same = all(part == (UNIT[0], n) for n, part in parts.items())
        coefficient, made = (UNIT[0], node) if same else _remade(graph, node, parts)
        if graph.nodes[made][0] != "sum":
            return coefficient, made
        addends = graph.nodes[made][1]
        concerned = self._concerned(addends)
        if not concerned:
            return coefficient, made
        kept = [addend for addend in addends if addend not in concerned]
        return graph.scaled(graph.add([*kept, self._together(concerned)]), coefficient)

    def _concerned(self, addends: Sequence[Value]) -> list[Value]:
        """Return the addends that hold terms which cancel with those of others."""
        each = [(addend, self.terms.of(addend[1])) for addend in addends]
        uses = Counter(m for _, own in each for m in own)
        if max(uses.values()) == 1:
            return []
        gone = self._gone(summed((c, own) for (c, _), own in each))
        return [addend for addend, own in each if not gone.isdisjoint(own)]

    def _gone(self, totals: ByMonomial) -> set[Monomial]:
        """Return what cancels whatever the parameters, so that no multiple of it is left."""
        left = {self._varying(m) for m, total in totals.items() if total}
        nothing = (m for m, total in totals.items() if not total)
        return {m for m in nothing if self._varying(m) not in left}

    def _varying(self, monomial: Monomial) -> Monomial:
        fixed = self.terms.graph.fixed
        return tuple((n, p) for n, p in monomial if not fixed[n])

    def _together(self, addends: Sequence[Value]) -> Value:
        graph = self.terms.graph
        (each,) = multiplied_out(graph, [graph.add(addends)], frozenset())
        return factored(graph, {m: c for m, c in each.items() if self.terms.of(c[1])})


def _product(left: ByMonomial, right: ByMonomial) -> ByMonomial:
    made: ByMonomial = {}
    for first, a in left.items():
        for second, b in right.items():
            powers = dict(first)
            for n, p in second:
                powers[n] = powers.get(n, 0) + p
            monomial = tuple(sorted((n, p) for n, p in powers.items() if p))
            made[monomial] = made[monomial] + a * b if monomial in made else a * b
    return {m: k for m, k in made.items() if k}


def summed(scaled: Iterable[tuple[Fraction, ByMonomial]]) -> ByMonomial:
    """Return a sum of sums of terms, each times a number, with the terms that cancel."""
    total: ByMonomial = {}
    for c, own in scaled:
        for m, k in own.items():
            total[m] = total[m] + c * k if m in total else c * k
    return total


def added(scaled: Iterable[tuple[Fraction, ByMonomial]]) -> ByMonomial:
    """Return a sum of sums of terms, each times a number."""
    return {m: k for m, k in summed(scaled).items() if k}


def _remade(graph: Graph, node: int, parts: Mapping[int, Value]) -> Value:
    kind, *rest = graph.nodes[node]
    match kind:
        case "sum":
            return graph.add([graph.scaled(parts[n], c) for c, n in rest[0]])
        case "product":
            return graph.mul([graph.power(parts[n], p) for n, p in rest[0]])
        case "let":
            family = graph.families.get(node, "")
            return graph.let(graph.names[node], graph.scaled(parts[rest[0][1]], rest[0][0]), family)
        case "cut":
            return graph.cut(graph.names[node], graph.scaled(parts[rest[0][1]], rest[0][0]))
    return graph.call(rest[0], *(graph.scaled(parts[n], c) for c, n in rest[1]))
