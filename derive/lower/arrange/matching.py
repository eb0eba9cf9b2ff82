"""The order in which balances are solved: a maximum matching, then strongly connected blocks."""

from collections.abc import Mapping, Sequence

import networkx as nx

BlockIndices = tuple[tuple[int, ...], tuple[int, ...]]


class UndeterminedError(ArithmeticError):
    """Equations that do not determine their unknowns."""


def blocks(holds: Sequence[frozenset[int]]) -> list[BlockIndices]:
    """Return (equations, unknowns) of each block, earlier ones first.

    holds : the unknowns of each equation

    >>> blocks([frozenset({0, 1}), frozenset({0}), frozenset({1, 2, 3}), frozenset({2, 3})])
    [((1,), (0,)), ((0,), (1,)), ((2, 3), (2, 3))]
    """
    owner = matched(holds)
    graph = nx.DiGraph()
    graph.add_nodes_from(range(len(holds)))
    graph.add_edges_from(
        (owner[k], row) for row, own in enumerate(holds) for k in own if owner[k] != row
    )
    whole = nx.condensation(graph)
    order = nx.lexicographical_topological_sort(whole, key=lambda n: min(whole.nodes[n]["members"]))
    found = []
    for node in order:
        rows = tuple(sorted(whole.nodes[node]["members"]))
        found.append((rows, tuple(sorted(k for k, row in owner.items() if row in rows))))
    return found


def matched(holds: Sequence[frozenset[int]]) -> Mapping[int, int]:
    """Return for each unknown the equation that yields it.

    Raises UndeterminedError if some equation yields none.
    """
    rows, size = range(len(holds)), len(holds)  # numbers: sets of words come in any order
    graph = nx.Graph()
    graph.add_nodes_from(rows)
    graph.add_edges_from((n, size + k) for n, own in enumerate(holds) for k in sorted(own))
    pairs = nx.bipartite.hopcroft_karp_matching(graph, rows)
    if any(n not in pairs for n in rows):
        raise UndeterminedError("an equation fixes no unknown that others leave open")
    return {pairs[n] - size: n for n in rows}
