"""Derivatives of graph values: one rule a row, zeros and constants known as they arise."""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

from derive.lower.graph import ONE, UNIT, ZERO, Graph, Value

Differentiation = Callable[[Graph, tuple[Value, ...]], tuple[Value, ...]]


def _minus(value: Value) -> Value:
    return -value[0], value[1]


# The partial derivatives of a call by each of its operands.
RULES: dict[str, Differentiation] = {
    "sin": lambda g, v: (g.call("cos", *v),),
    "cos": lambda g, v: (_minus(g.call("sin", *v)),),
    "sqrt": lambda g, v: (g.mul([g.number(Fraction(1, 2)), g.power(g.call("sqrt", *v), -1)]),),
    "power_of_two": lambda g, v: (ZERO,),  # noqa: ARG005 - it scales, and goes up in steps
}


def slopes_by(graph: Graph, leaf: Value) -> Callable[[Value], Value]:
    """Return what differentiates values by a leaf, a variable or a parameter, each node once.

    >>> g = Graph()
    >>> x = g.variable("x")
    >>> slopes_by(g, x)(g.power(x, 3)) == g.mul([g.number(3), g.power(x, 2)])
    True
    """
    return slopes_from(graph, {leaf[1]: UNIT})


def slopes_from(graph: Graph, known: Mapping[int, Value]) -> Callable[[Value], Value]:
    """Return what differentiates values whose slopes follow from those of some nodes, known."""
    memory = dict(known)
    varies = not any(graph.fixed[node] for node in known)

    def visit(node: int) -> Value:
        if node not in memory:
            constant = varies and graph.fixed[node]
            memory[node] = ZERO if constant else _by_rule(graph, node, visit)
        return memory[node]

    return lambda value: graph.scaled(visit(value[1]), value[0])


def _by_rule(graph: Graph, node: int, visit: Callable[[int], Value]) -> Value:
    kind, *rest = graph.nodes[node]
    match kind:
        case "sum":
            return graph.add([graph.scaled(visit(n), c) for c, n in rest[0]])
        case "product":
            return graph.add(
                [_one_factor(graph, rest[0], place, visit) for place in range(len(rest[0]))]
            )
        case "let" | "cut":
            return graph.scaled(visit(rest[0][1]), rest[0][0])
        case "call":
            partial = RULES[rest[0]](graph, rest[1])
            inner = [graph.scaled(visit(n), c) for c, n in rest[1]]
            return graph.add([graph.mul(pair) for pair in zip(partial, inner, strict=True)])
    return ZERO


def _one_factor(
    graph: Graph, factors: Sequence[tuple[int, int]], place: int, visit: Callable[[int], Value]
) -> Value:
    base, power = factors[place]
    inner = visit(base)
    if not inner[0]:
        return ZERO
    others = [graph.power((Fraction(1), n), p) for k, (n, p) in enumerate(factors) if k != place]
    lowered = graph.power((Fraction(1), base), power - 1) if power != 1 else (Fraction(1), ONE)
    return graph.mul([graph.number(power), lowered, *others, inner])
