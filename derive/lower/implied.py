"""Jacobians of what a linear system solves, by its factors: A x' = (b - A x)', x held.

No solution is differentiated: what is left of the equations is, a column a leaf, and the factors
that solved them solve these too.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import takewhile

from sympy import Symbol

from derive.lower.arrange.arrangement import Arrangement, Definition, Implied
from derive.lower.cancel import what_is_left
from derive.lower.derivative import slopes_by, slopes_from
from derive.lower.graph import UNIT, ZERO, Graph, Value
from derive.lower.lower import defined, value_of

ByUnknown = Mapping[Symbol, Value]
MINUS = Fraction(-1)


def jacobian_by_factors(
    graph: Graph, way: Arrangement, inputs: Mapping[Symbol, Value], leaves: Sequence[Value]
) -> tuple[list[Value], list[list[Value]]] | None:
    """Return outputs and the rows of their Jacobian, None where that is not known to follow.

    inputs : the graph's value of every input's symbol
    """
    implied = way.implied
    if implied is None:
        return None
    known = defined(graph, way.definitions, inputs)
    if not _apart(graph, way, implied, known):
        return None
    of = _Left(graph, implied, known)
    outputs = [value_of(graph, e, known) for e in way.outputs]
    columns = []
    for leaf in leaves:
        slopes = _solved(graph, implied, known, of.slopes(leaf))
        by = slopes_from(graph, {leaf[1]: UNIT} | {of.nodes[u]: x for u, x in slopes.items()})
        columns.append([by(value) for value in outputs])
    return outputs, [list(row) for row in zip(*columns, strict=True)]


def _apart(graph: Graph, way: Arrangement, of: Implied, known: Mapping[Symbol, Value]) -> bool:
    """Tell whether each unknown is a value of its own, and nothing that is found before it."""
    own = {known[e][1] for e in of.solved.values() if e.is_Symbol}
    symbols = {*of.solved.values()}
    before = takewhile(lambda d: d.symbol not in symbols, way.definitions)
    plain = len(own) == len(of.solved) and all(graph.nodes[n][0] == "cut" for n in own)
    return plain and own.isdisjoint(graph.within(known[d.symbol] for d in before))


@dataclass(frozen=True)
class _OfLink:
    """An angle of a link, or a rate: the slopes of nodes by what it makes absolute."""

    unknown: Symbol
    value: Value
    slopes: Mapping[int, Value]
    parent: int


class _Left:
    """What is left of equations in a graph, and its slopes while unknowns are held."""

    def __init__(self, graph: Graph, implied: Implied, known: Mapping[Symbol, Value]) -> None:
        self.graph = graph
        more = [Definition("cut", s, e) for s, e in implied.definitions.items()]
        known = defined(graph, more, known)
        self.left = {u: value_of(graph, e, known) for u, e in implied.left.items()}
        self.nodes = {u: known[e][1] for u, e in implied.solved.items()}
        self.held = dict.fromkeys(self.nodes.values(), ZERO)
        angles, rates = (
            [
                _OfLink(
                    t.unknown,
                    value_of(graph, t.value, known),
                    {known[s][1]: value_of(graph, e, known) for s, e in t.slopes.items()},
                    t.parent,
                )
                for t in kind
            ]
            for kind in (implied.angles, implied.rates)
        )
        self.held |= {n: ZERO for t in (*angles, *rates) for n in t.slopes}
        self.turning = [*self._turned(angles), *zip(rates, self._outboard(rates), strict=True)]

    def _outboard(self, kind: Sequence[_OfLink]) -> list[ByUnknown]:
        """Return slopes by each link's own angle or rate: by those of all that it carries."""
        each = [self._by(t.slopes) for t in kind]
        for n, t in reversed(list(enumerate(kind))):
            if t.parent >= 0:
                each[t.parent] = self._sum(each[t.parent], each[n], UNIT[0])
        return each

    def _turned(self, kind: Sequence[_OfLink]) -> list[tuple[_OfLink, ByUnknown]]:
        """Return the same of angles; what a link carries is told by what it does not carry.

        If all turned alike, most would stay as it is: so nothing is left that takes itself away.
        """
        graph, below, found = self.graph, self._outboard(kind), list[ByUnknown]()
        for n, t in enumerate(kind):
            carried = _carried(kind, n)
            if t.parent < 0:
                alike: dict[int, Value] = {}
                for node, x in (pair for k in carried for pair in kind[k].slopes.items()):
                    alike[node] = graph.add([alike.get(node, ZERO), x])
                own = self._by(alike)
                own = dict(zip(own, *what_is_left(graph, [[*own.values()]]), strict=True))
            else:
                own = self._sum(found[t.parent], self._by(kind[t.parent].slopes), MINUS)
                for k, other in enumerate(kind):
                    if other.parent == t.parent and k != n:
                        own = self._sum(own, below[k], MINUS)
            within = {kind[k].unknown for k in carried}
            found.append({u: own[u] if u in within else below[n][u] for u in self.left})
        return list(zip(kind, found, strict=True))

    def _sum(self, first: ByUnknown, second: ByUnknown, sign: Fraction) -> ByUnknown:
        graph = self.graph
        pairs = {u: [x, graph.scaled(second[u], sign)] for u, x in first.items()}
        return {u: graph.cut("slope", graph.add(pair)) for u, pair in pairs.items()}

    def _by(self, nodes: Mapping[int, Value]) -> ByUnknown:
        """Return slopes by some nodes, all others held."""
        slope = slopes_from(self.graph, {**self.held, **nodes})
        return {u: self.graph.cut("slope", slope(value)) for u, value in self.left.items()}

    def slopes(self, leaf: Value) -> ByUnknown:
        """Return the slopes of what is left by a leaf."""
        graph = self.graph
        found = self._by({leaf[1]: UNIT} if leaf[1] not in self.held else {})
        for t, own in self.turning:
            by = slopes_by(graph, leaf)(t.value)
            found = {u: graph.add([x, graph.mul([own[u], by])]) for u, x in found.items()}
        return found


def _carried(kind: Sequence[_OfLink], n: int) -> list[int]:
    """Return the places of a link and of all that it carries."""
    found = [n]
    for k, t in enumerate(kind):
        if t.parent in found:
            found.append(k)
    return found


def _solved(
    graph: Graph, implied: Implied, known: Mapping[Symbol, Value], right: ByUnknown
) -> ByUnknown:
    """Return a column put through the factors."""
    by = implied.factors
    b = {u: graph.cut("b", right[u]) for u in by.order}
    for (n, u), e in by.below.items():  # by columns, in their order
        less = graph.mul([value_of(graph, e, known), b[u]])
        b[n] = graph.cut("b", graph.add([b[n], graph.scaled(less, MINUS)]))
    found: dict[Symbol, Value] = {}
    for u in reversed(by.order):
        inverse = value_of(graph, by.inverses[u], known)
        rest = [graph.scaled(graph.mul([value_of(graph, e, known), found[n]]), MINUS)
                for (n, k), e in by.below.items() if k == u]  # fmt: skip
        found[u] = graph.cut("x", graph.add([graph.mul([b[u], inverse]), *rest]))
    return found
