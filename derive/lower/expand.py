"""Expressions multiplied out, and put together again with common factors taken outside.

Multiplied out over the variables, every coefficient is made of parameters only, so it is computed
once in set-up; differences such as I_yy - I_zz then lose nothing to cancellation.
"""

from collections import Counter
from collections.abc import Callable, Iterable
from fractions import Fraction
from functools import partial, reduce
from math import inf

from derive.lower.graph import ONE, UNIT, Graph, Value

Monomial = tuple[tuple[int, int], ...]
Expanded = dict[Monomial, Value]
Visit = Callable[[int], Expanded]
Family = str | int


class TooManyTermsError(ValueError):
    """A value, or a part of it, that has more terms multiplied out than are asked for."""


def multiplied_out(
    graph: Graph, values: Iterable[Value], kept: frozenset[Family], most: float = inf
) -> list[Expanded]:
    """Return for each value the coefficient, made of parameters, of every monomial in variables.

    Calls, cuts and denominators that vary count as variables of their own, and so do the lets
    whose family is ``kept``; what these stand for is multiplied out in itself.
    Raises TooManyTermsError where a part has more than ``most`` terms.
    """
    memory: dict[int, Expanded] = {}

    def visit(node: int) -> Expanded:
        if node not in memory:
            if graph.nodes[node][0] == "let" and family(graph, node) in kept:
                memory[node] = _kept(graph, node, visit)
            else:
                memory[node] = _terms(graph, node, visit)
            if len(memory[node]) > most:
                raise TooManyTermsError
        return memory[node]

    return [_scaled(graph, visit(node), coefficient) for coefficient, node in values]


def family(graph: Graph, node: int) -> Family:
    """Return what a let shares with the other components of its vector; alone, its own number."""
    return graph.families.get(node, node)


def families(graph: Graph, value: Value) -> list[Family]:
    """Return the families of the lets that ``value`` varies by, innermost first."""
    varying = (n for n in graph.within([value]) if not graph.fixed[n])
    return list(dict.fromkeys(family(graph, n) for n in varying if graph.nodes[n][0] == "let"))


def _kept(graph: Graph, node: int, visit: Visit) -> Expanded:
    factor, inner = graph.nodes[node][1]
    inside = factored(graph, _scaled(graph, visit(inner), factor))
    coefficient, named = graph.let(graph.names[node], inside, graph.families.get(node, ""))
    return {((named, 1),): (coefficient, ONE)} if coefficient else {}


def _terms(graph: Graph, node: int, visit: Visit) -> Expanded:
    if graph.fixed[node]:
        return {(): (UNIT[0], node)}
    kind, *rest = graph.nodes[node]
    match kind:
        case "let":
            coefficient, inner = rest[0]
            return _scaled(graph, visit(inner), coefficient)
        case "sum":
            return _added(graph, [_scaled(graph, visit(n), c) for c, n in rest[0]])
        case "product":
            each = (_powered(graph, base, power, visit) for base, power in rest[0])
            return reduce(partial(_multiplied, graph), each)
    return {((node, 1),): UNIT}


def _powered(graph: Graph, base: int, power: int, visit: Visit) -> Expanded:
    if power < 0:
        if graph.fixed[base]:
            return {(): graph.power((UNIT[0], base), power)}
        return {((base, power),): UNIT}
    return reduce(partial(_multiplied, graph), [visit(base)] * power)


def _scaled(graph: Graph, these: Expanded, factor: Fraction) -> Expanded:
    return {monomial: graph.scaled(c, factor) for monomial, c in these.items()}


def _added(graph: Graph, several: list[Expanded]) -> Expanded:
    gathered: dict[Monomial, list[Value]] = {}
    for these in several:
        for monomial, coefficient in these.items():
            gathered.setdefault(monomial, []).append(coefficient)
    added = {monomial: graph.add(values) for monomial, values in gathered.items()}
    return {monomial: c for monomial, c in added.items() if c[0]}


def _multiplied(graph: Graph, left: Expanded, right: Expanded) -> Expanded:
    products: list[Expanded] = []
    for first, a in left.items():
        for second, b in right.items():
            powers = dict(first)
            for node, power in second:
                powers[node] = powers.get(node, 0) + power
            monomial = tuple(sorted((n, p) for n, p in powers.items() if p))
            products.append({monomial: graph.mul([a, b])})
    return _added(graph, products)


def collected_by_factors(graph: Graph, these: Expanded) -> Value:
    """Return the sum of ``these`` as it stands."""
    return graph.add([_term(graph, monomial, c) for monomial, c in these.items()])


def grouped(graph: Graph, these: Expanded) -> Value:
    """Return the sum of ``these``, terms with the same parameters gathered in front of them."""
    groups: dict[int, list[Value]] = {}
    for monomial, (factor, node) in these.items():
        groups.setdefault(node, []).append(_term(graph, monomial, (factor, ONE)))
    return graph.add(
        [graph.mul([(UNIT[0], node), graph.add(parts)]) for node, parts in groups.items()]
    )


def _term(graph: Graph, monomial: Monomial, coefficient: Value) -> Value:
    return graph.mul([coefficient, *(graph.power((UNIT[0], n), p) for n, p in monomial)])


def factored(graph: Graph, these: Expanded) -> Value:
    """Return the sum of ``these``, the most common factor taken outside again and again."""
    uses = Counter(node for monomial in these for node, power in monomial if power > 0)
    if not uses:
        return grouped(graph, these)
    count = max(uses.values())
    if count < 2:
        return grouped(graph, these)
    common = min(node for node, n in uses.items() if n == count)
    inside = {_without(m, common): c for m, c in these.items() if dict(m).get(common, 0) > 0}
    rest = {m: c for m, c in these.items() if dict(m).get(common, 0) <= 0}
    taken = graph.mul([(UNIT[0], common), factored(graph, inside)])
    return graph.add([taken, factored(graph, rest)]) if rest else taken


def _without(monomial: Monomial, node: int) -> Monomial:
    return tuple((n, p - (n == node)) for n, p in monomial if p - (n == node))


def degree(graph: Graph, monomial: Monomial, nodes: frozenset[int]) -> int | None:
    """Return the degree of ``monomial`` in ``nodes``; None if a factor varies otherwise with one.

    Such a factor is a power below the line, a call, or a sum that counts as a variable of its own.
    """
    others = [node for node, power in monomial if power < 0 or node not in nodes]
    if not nodes.isdisjoint(graph.within((UNIT[0], node) for node in others)):
        return None
    return sum(power for node, power in monomial if node in nodes)
