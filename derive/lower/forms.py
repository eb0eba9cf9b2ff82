"""The forms a function may take, and the choice among them by what they cost.

A group of outputs can be computed as it was arranged, or multiplied out over the variables with
coefficients made in set-up, with or without common factors taken outside. With its Jacobian at
hand, a group that is homogeneous in its inputs follows from that by Euler's theorem,
y = sum over quantities z of (dy/dz) z / degree. Fewest operations win, then the first form.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import accumulate, product
from math import prod

from derive.lower.cancel import what_is_left
from derive.lower.derivative import slopes_by
from derive.lower.expand import (
    Expanded,
    Family,
    TooManyTermsError,
    collected_by_factors,
    degree,
    factored,
    families,
    multiplied_out,
)
from derive.lower.graph import Graph, Value
from derive.lower.homogeneous import degrees_that_sum
from derive.lower.schedule import unoriented
from derive.program.arithmetic import FLOPS
from derive.program.program import Op

MANY_TERMS = 60  # beyond this, multiplying out has never been the cheaper form
MOST_ON_THE_WAY = 10 * MANY_TERMS  # of a part: so many do not cancel to a few
MANY_CHOICES = 30
FINALISTS = 4  # of values and of Jacobians, each judged alone, that are then judged together
WAYS: tuple[Callable[[Graph, Expanded], Value], ...] = (factored, collected_by_factors)


@dataclass(frozen=True)
class Dependents:
    """Outputs that belong together, and the inputs, by quantity, of their derivatives."""

    values: tuple[Value, ...]
    inputs: tuple[tuple[Value, ...], ...]


def cost(graph: Graph, outputs: Sequence[Value]) -> tuple[int, int]:
    """Return the number of + - * /, then of all operations and loads, that ``outputs`` take."""
    values = tuple(outputs)
    if values not in graph.costs:
        ops = unoriented(graph, values, lambda node: graph.fixed[node])
        graph.costs[values] = sum(op.operator in FLOPS for op in ops), len(ops) + _loads(ops)
    return graph.costs[values]


def _loads(ops: Sequence[Op]) -> int:
    """Return how many operands must be loaded on their own.

    An operation takes one operand from memory as it goes; what several operations read is loaded
    once and stays.
    """
    made = {op.result for op in ops}
    uses = Counter(o for op in ops for o in op.operands if o not in made)
    alone = [sum(uses[o] == 1 for o in op.operands if o not in made) for op in ops]
    return sum(n > 1 for n in uses.values()) + sum(n > 1 for n in alone)


def without_what_cancels(graph: Graph, forms: Sequence[Sequence[Value]]) -> list[tuple[Value, ...]]:
    """Return forms without products that cancel identically, unless that is dearer."""
    found = zip(what_is_left(graph, forms), map(tuple, forms), strict=True)
    return [min(pair, key=lambda form: cost(graph, form)) for pair in found]


def value_forms(graph: Graph, group: Dependents) -> list[tuple[Value, ...]]:
    """Return the ways to compute the values of ``group``, the arranged one first."""
    forms = [group.values]
    kept = dict.fromkeys(f for value in group.values for f in families(graph, value))
    for stop in (frozenset[Family](), *(frozenset([name]) for name in kept)):
        expanded = _expanded(graph, group, stop)
        if expanded is not None:
            forms += [tuple(way(graph, t) for t in expanded) for way in WAYS]
    return list(dict.fromkeys(forms))


def _expanded(graph: Graph, group: Dependents, kept: frozenset[Family]) -> list[Expanded] | None:
    try:
        expanded = multiplied_out(graph, group.values, kept, MOST_ON_THE_WAY)
    except TooManyTermsError:
        return None
    return None if any(len(t) > MANY_TERMS for t in expanded) else expanded


def best_values(graph: Graph, groups: Sequence[Dependents]) -> list[Value]:
    """Return the cheapest values of all groups together."""
    forms = [value_forms(graph, group) for group in groups]
    if prod(len(each) for each in forms) > MANY_CHOICES:
        forms = [[min(each, key=lambda form: cost(graph, form))] for each in forms]
    best = min(_choices(forms), key=lambda values: cost(graph, values))
    return list(*without_what_cancels(graph, [best]))


def _choices(forms: Sequence[Sequence[tuple[Value, ...]]]) -> Iterable[list[Value]]:
    return ([v for form in choice for v in form] for choice in product(*forms))


def jacobian(graph: Graph, values: Iterable[Value], leaves: Sequence[Value]) -> list[list[Value]]:
    """Return the rows of partial derivatives of ``values`` by ``leaves``."""
    each = [slopes_by(graph, leaf) for leaf in leaves]
    return [[slope(value) for slope in each] for value in values]


def best_with_jacobian(
    graph: Graph, group: Dependents, shared: Sequence[Value]
) -> tuple[list[Value], list[list[Value]]]:
    """Return the cheapest values and Jacobian rows of ``group``.

    Derivatives by parameters have no say in the choice: there are many, mostly made in set-up.

    shared : values that are computed anyway, which both may use
    """
    leaves = [leaf for quantity in group.inputs for leaf in quantity]
    varying = tuple(q for q in group.inputs if not all(graph.fixed[node] for _, node in q))
    values, rows = _best_by_varying(graph, Dependents(group.values, varying), shared)
    if len(varying) == len(group.inputs):
        return values, rows
    own = [leaf for quantity in varying for leaf in quantity]
    fixed = [leaf for leaf in leaves if leaf not in own]
    (more,) = without_what_cancels(graph, [_flat(jacobian(graph, values, fixed))])
    both = zip(rows, _in_rows(more, len(fixed)), strict=True)
    by_leaf = [dict(zip((*own, *fixed), (*a, *b), strict=True)) for a, b in both]
    return values, [[row[leaf] for leaf in leaves] for row in by_leaf]


def _best_by_varying(
    graph: Graph, group: Dependents, shared: Sequence[Value]
) -> tuple[list[Value], list[list[Value]]]:
    leaves = [leaf for quantity in group.inputs for leaf in quantity]
    forms = value_forms(graph, group)
    entries = _cheapest(graph, [_flat(jacobian(graph, form, leaves)) for form in forms])
    jacobians = [_in_rows(e, len(leaves)) for e in without_what_cancels(graph, entries)]
    forms = without_what_cancels(graph, _cheapest(graph, forms))
    choices: list[tuple[tuple[int, int], tuple[Value, ...], list[list[Value]]]] = []
    for rows in jacobians:
        homogeneous = by_euler(graph, group, rows)
        either = [*forms, *([homogeneous] if homogeneous else [])]
        choices += [(cost(graph, [*shared, *form, *_flat(rows)]), form, rows) for form in either]
    _, best, rows = min(choices, key=lambda choice: choice[0])
    return list(best), rows


def _cheapest(graph: Graph, forms: Sequence[Sequence[Value]]) -> Sequence[Sequence[Value]]:
    return sorted(forms, key=lambda form: cost(graph, form))[:FINALISTS]


def _in_rows(entries: Sequence[Value], size: int) -> list[list[Value]]:
    return [list(entries[k : k + size]) for k in range(0, len(entries), size or 1)]


def _flat(rows: Sequence[Sequence[Value]]) -> list[Value]:
    return [entry for row in rows for entry in row]


def by_euler(
    graph: Graph, group: Dependents, rows: Sequence[Sequence[Value]]
) -> tuple[Value, ...] | None:
    """Return the values of ``group`` from its Jacobian, None if Euler's theorem does not apply."""
    expanded = _expanded(graph, group, frozenset())
    if expanded is None:
        return None
    own = [frozenset(leaf[1] for leaf in quantity) for quantity in group.inputs]
    degrees = degrees_that_sum(
        [degree(graph, m, nodes) for nodes in own] for terms in expanded for m in terms
    )
    if degrees is None:
        return None
    starts = list(accumulate(map(len, group.inputs), initial=0))
    return tuple(_contracted(graph, group, row, starts, degrees) for row in rows)


def _contracted(
    graph: Graph,
    group: Dependents,
    row: Sequence[Value],
    starts: Sequence[int],
    degrees: dict[int, int],
) -> Value:
    leaves = Counter(k for q, k in degrees.items() for _ in group.inputs[q])
    parts: dict[int, list[Value]] = {}
    for q, k in degrees.items():
        outside = k if len(group.values) < leaves[k] else 1
        for i, leaf in enumerate(group.inputs[q]):
            scaled = graph.cut("scaled", graph.mul([graph.number(Fraction(outside, k)), leaf]))
            entry = graph.let("entry", row[starts[q] + i])
            parts.setdefault(outside, []).append(graph.mul([entry, scaled]))
    sums = {k: graph.add(own) for k, own in parts.items()}
    whole = {k: own if k == 1 else graph.let("whole", own) for k, own in sums.items()}
    return graph.add([graph.mul([graph.number(Fraction(1, k)), own]) for k, own in whole.items()])
