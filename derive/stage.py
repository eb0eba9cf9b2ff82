"""A scene's functions as programs: what depends on parameters only is computed once, in set-up.

All functions of a scene share one graph, one set-up and one struct of named constants. Set-up runs
in twice the working precision and rounds each constant once.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from derive.graph import ONE, Graph, Value
from derive.program import Op, Operand, Program, Quantity, Sparsity
from derive.schedule import schedule


@dataclass
class Constants:
    """The constants that a scene's hot functions need, in the order in which they were asked for."""

    graph: Graph
    names: dict[Value, str] = field(default_factory=dict)

    def operand(self, value: Value) -> Operand:
        """Return the number or the name that stands for a parameter-only value."""
        if value[1] == ONE:
            return value[0]
        if value not in self.names:
            self.names[value] = self._fresh(value)
        return self.names[value]

    def _fresh(self, value: Value) -> str:
        coefficient, node = value
        kind, *rest = self.graph.nodes[node]
        taken = set(self.names.values())
        own = rest[0] if kind == "input" else self.graph.names.get(node, "")
        if coefficient == 1 and own.isidentifier() and own not in taken:
            return own
        taken |= self.graph.leaf_names()
        spelled = spelling(self.graph, value)
        if spelled and spelled not in taken:
            return spelled
        return next(name for n in range(1, len(taken) + 2) if (name := f"k{n}") not in taken)


@dataclass(frozen=True)
class Constant:
    """One named constant and the formula it is made by."""

    name: str
    formula: str


_COEFFICIENTS = {Fraction(1): "", Fraction(2): "twice_", Fraction(1, 2): "half_", Fraction(-1): "minus_"}
SPELLED_FACTORS = 4


def spelling(graph: Graph, value: Value) -> str:
    """Return a name that spells a short product, quotient or difference of names, or nothing.

    >>> g = Graph()
    >>> spelling(g, g.mul([g.number(Fraction(1, 2)), g.parameter("C"), g.power(g.parameter("A"), -1)]))
    'half_C_over_A'
    """
    coefficient, node = value
    if coefficient not in _COEFFICIENTS:
        return ""
    kind, *rest = graph.nodes[node]
    name = ""
    if kind == "product" and sum(abs(p) for _, p in rest[0]) <= SPELLED_FACTORS:
        top = [_named(graph, n) for n, p in rest[0] for _ in range(p)]
        bottom = [_named(graph, n) for n, p in rest[0] for _ in range(-p)]
        if all((*top, *bottom)):
            name = "_".join(top or ["one"]) + ("_over_" + "_".join(bottom) if bottom else "")
    elif kind == "sum" and len(rest[0]) == 2 and all(abs(c) == 1 for c, _ in rest[0]):
        (first, a), (second, b) = rest[0]
        if _named(graph, a) and _named(graph, b):
            joint = "_plus_" if first * second > 0 else "_minus_"
            name = _named(graph, a) + joint + _named(graph, b)
    else:
        name = _named(graph, node)
    spelled = _COEFFICIENTS[coefficient] + name if name else ""
    return spelled.replace("twice_one_over", "two_over").replace("half_one_over", "half_over")


def _named(graph: Graph, node: int) -> str:
    kind, *rest = graph.nodes[node]
    own = str(rest[0]) if kind == "input" else graph.names.get(node, "")
    return own if own.isidentifier() else ""


def hot(
    graph: Graph, constants: Constants, values: Sequence[Value]
) -> tuple[tuple[Op, ...], tuple[Operand, ...]]:
    """Return the operations that every call runs, and the operands of the results."""
    prefix = free_prefix("t", graph.leaf_names() | set(constants.names.values()))
    return schedule(graph, values, lambda node: graph.fixed[node], constants.operand, prefix)


def free_prefix(letter: str, taken: set[str]) -> str:
    """Return a prefix that makes no taken name when a number follows it."""
    while any(name.removeprefix(letter).isdigit() for name in taken if name.startswith(letter)):
        letter += letter[0]
    return letter


def setup(
    graph: Graph, constants: Constants, parameters: Sequence[Quantity], positive: Sequence[Value]
) -> Program:
    """Return the program that makes the constants from the parameters."""
    values = [*constants.names, *positive]

    def number(value: Value) -> Fraction:
        return value[0]

    ops, results = schedule(graph, values, lambda node: node == ONE, number, free_prefix("s", graph.leaf_names()))
    count = len(constants.names)
    names = tuple(constants.names.values())
    says = "constants made of parameters only, for the functions of this scene"
    output = Quantity("constants", names, (count,), "", "", None, None, says)
    used = operands_of(ops, results)
    inputs = tuple(p for p in parameters if used & set(p.components))
    return Program(
        "setup", "Make the constants of this scene from its parameters; call it once.",
        inputs, (output,) if count else (), ops, results[:count], positive=results[count:],
    )


def operands_of(ops: Sequence[Op], results: Sequence[Operand]) -> set[str]:
    """Return the names that operations and results refer to."""
    named = {operand for op in ops for operand in op.operands}
    return {operand for operand in named | set(results) if isinstance(operand, str)}


def used_inputs(quantities: Sequence[Quantity], ops: Sequence[Op], results: Sequence[Operand]) -> tuple[Quantity, ...]:
    """Return the quantities of which some component is used: inputs follow from use."""
    used = operands_of(ops, results)
    return tuple(q for q in quantities if used & set(q.components))


def compressed(rows: Sequence[Sequence[Value]], row_names: Sequence[str], column_names: Sequence[str]) -> tuple[Sparsity, list[Value]]:
    """Return the pattern and the nonzeros of a matrix in compressed-column order."""
    colind, row, nonzeros = [0], list[int](), list[Value]()
    for column in range(len(column_names)):
        for place, entries in enumerate(rows):
            if entries[column][0]:
                row.append(place)
                nonzeros.append(entries[column])
        colind.append(len(row))
    return Sparsity(tuple(row_names), tuple(column_names), tuple(colind), tuple(row)), nonzeros


def formula(graph: Graph, value: Value) -> str:
    """Return ``value`` as text in parameters and named values.

    >>> g = Graph()
    >>> formula(g, g.mul([g.number(2), g.parameter("m"), g.power(g.parameter("r"), 2)]))
    '2*m*r^2'
    """
    coefficient, node = value
    sign = "-" if coefficient < 0 else ""
    factor = "" if abs(coefficient) == 1 else str(abs(coefficient))
    if node == ONE:
        return str(coefficient)
    body = _node_text(graph, node)
    if factor and graph.nodes[node][0] == "sum":
        body = f"({body})"
    return sign + (f"{factor}*{body}" if factor else body)


def _node_text(graph: Graph, node: int) -> str:
    if node in graph.names:
        return graph.names[node]
    kind, *rest = graph.nodes[node]
    if kind == "input":
        return str(rest[0])
    if kind == "call":
        return f"{rest[0]}({', '.join(formula(graph, v) for v in rest[1])})"
    if kind == "sum":
        text = " + ".join(formula(graph, v) for v in rest[0])
        return text.replace("+ -", "- ")
    top = [_power_text(graph, n, p) for n, p in rest[0] if p > 0]
    bottom = [_power_text(graph, n, -p) for n, p in rest[0] if p < 0]
    above = "*".join(top) or "1"
    if not bottom:
        return above
    return f"{above}/{bottom[0]}" if len(bottom) == 1 else f"{above}/({'*'.join(bottom)})"


def _power_text(graph: Graph, node: int, power: int) -> str:
    body = _node_text(graph, node)
    if graph.nodes[node][0] in ("sum", "product") and node not in graph.names:
        body = f"({body})"
    return body if power == 1 else f"{body}^{power}"
