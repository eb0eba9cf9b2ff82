"""The forms a function may take, and the choice among them by what they cost.

A block of outputs can be computed as it was arranged, or multiplied out over the variables with
coefficients made in set-up, with or without common factors taken outside. With its Jacobian at
hand, a block that is homogeneous in its inputs follows from that by Euler's theorem,
y = sum over blocks z of (dy/dz) z / degree. Fewest operations win; a tie goes to the first form.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, product

from derive.derivative import derivative
from derive.expand import Terms, collected, degree, factored, terms
from derive.graph import ONE, Graph, Value
from derive.program import FLOPS, Op
from derive.schedule import schedule

MANY_TERMS = 60  # beyond this, multiplying out has never been the cheaper form
MANY_CHOICES = 100


@dataclass(frozen=True)
class Block:
    """Outputs that belong together, and the input leaves they are differentiated by, by quantity."""

    values: tuple[Value, ...]
    inputs: tuple[tuple[Value, ...], ...]


def cost(graph: Graph, outputs: Sequence[Value]) -> tuple[int, int]:
    """Return the number of + - * /, then of all operations, that ``outputs`` take."""
    ops = operations(graph, outputs)
    return sum(op.operator in FLOPS for op in ops), len(ops)


def operations(graph: Graph, outputs: Sequence[Value]) -> tuple[Op, ...]:
    """Return the hot operations of ``outputs``, constants left as they come."""
    def constant(value: Value) -> Fraction | str:
        return value[0] if value[1] == ONE else f"constant{value}"

    return schedule(graph, outputs, lambda node: graph.fixed[node], constant, "t")[0]


def value_forms(graph: Graph, block: Block) -> list[tuple[Value, ...]]:
    """Return the ways to compute the values of ``block``, the arranged one first."""
    expanded = _expanded(graph, block)
    if expanded is None:
        return [block.values]
    ways: list[Callable[[Graph, Terms], Value]] = [factored, collected]
    forms = [block.values, *(tuple(way(graph, t) for t in expanded) for way in ways)]
    return list(dict.fromkeys(forms))


def _expanded(graph: Graph, block: Block) -> list[Terms] | None:
    expanded = [terms(graph, value) for value in block.values]
    return None if any(len(t) > MANY_TERMS for t in expanded) else expanded


def best_values(graph: Graph, blocks: Sequence[Block]) -> list[Value]:
    """Return the cheapest values of all blocks together."""
    forms = [value_forms(graph, block) for block in blocks]
    if len(list(_choices(forms))) > MANY_CHOICES:
        forms = [[min(each, key=lambda form: cost(graph, form))] for each in forms]
    best = min(_choices(forms), key=lambda values: cost(graph, values))
    return list(best)


def _choices(forms: Sequence[Sequence[tuple[Value, ...]]]) -> Iterable[list[Value]]:
    return ([v for form in choice for v in form] for choice in product(*forms))


def jacobian(graph: Graph, values: Iterable[Value], leaves: Sequence[Value]) -> list[list[Value]]:
    """Return the rows of partial derivatives of ``values`` by ``leaves``."""
    return [[derivative(graph, value, leaf) for leaf in leaves] for value in values]


def best_with_jacobian(graph: Graph, block: Block, shared: Sequence[Value]) -> tuple[list[Value], list[list[Value]]]:
    """Return the cheapest values and Jacobian rows of ``block``.

    shared : values that are computed anyway, which both may use
    """
    leaves = [leaf for quantity in block.inputs for leaf in quantity]
    forms = value_forms(graph, block)
    jacobians = [jacobian(graph, form, leaves) for form in forms]
    choices = []
    for rows in jacobians:
        homogeneous = by_euler(graph, block, rows)
        for values in [*forms, *([homogeneous] if homogeneous else [])]:
            flat = [entry for row in rows for entry in row]
            choices.append((cost(graph, [*shared, *values, *flat]), list(values), rows))
    _, values, rows = min(choices, key=lambda choice: choice[0])
    return values, rows


def by_euler(graph: Graph, block: Block, rows: Sequence[Sequence[Value]]) -> tuple[Value, ...] | None:
    """Return the values of ``block`` from its Jacobian by Euler's theorem, None if it does not apply."""
    expanded = _expanded(graph, block)
    degrees = None if expanded is None else _degrees(block, [m for t in expanded for m in t])
    if degrees is None:
        return None
    starts, place = [], 0
    for quantity in block.inputs:
        starts.append(place)
        place += len(quantity)
    return tuple(_contracted(graph, block, row, starts, degrees) for row in rows)


def _contracted(
    graph: Graph, block: Block, row: Sequence[Value], starts: Sequence[int], degrees: dict[int, int]
) -> Value:
    parts = []
    for q, k in degrees.items():
        for i, leaf in enumerate(block.inputs[q]):
            scaled = graph.cut("scaled", graph.mul([graph.number(Fraction(1, k)), leaf]))
            entry = graph.let("entry", row[starts[q] + i])
            parts.append(graph.mul([entry, scaled]))
    return graph.add(parts)


def _degrees(block: Block, monomials: Sequence[tuple[tuple[int, int], ...]]) -> dict[int, int] | None:
    """Return input quantities with degrees k such that every monomial has sum(degree / k) = 1."""
    nodes = [frozenset(leaf[1] for leaf in quantity) for quantity in block.inputs]
    found = [[degree(m, own) for own in nodes] for m in monomials]
    for size in range(1, len(nodes) + 1):
        for chosen in combinations(range(len(nodes)), size):
            for powers in product((1, 2), repeat=size):
                if all(_adds_up([row[q] for q in chosen], powers) for row in found):
                    return dict(zip(chosen, powers, strict=True))
    return None


def _adds_up(degrees: Sequence[int | None], powers: Sequence[int]) -> bool:
    if any(d is None for d in degrees):
        return False
    return sum(Fraction(d or 0, k) for d, k in zip(degrees, powers, strict=True)) == 1
