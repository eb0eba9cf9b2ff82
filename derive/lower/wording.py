"""Parameter-only values in words: a name for a struct's field, a formula for its comment."""

import re
from fractions import Fraction

from derive.lower.graph import ONE, Graph, Value

_COEFFICIENTS = {
    Fraction(1): "",
    Fraction(2): "twice_",
    Fraction(1, 2): "half_",
    Fraction(-1): "minus_",
}
SPELLED_FACTORS = 4
LONGEST = 80
"""Characters of a formula that is read with pleasure."""
INVERSE = re.compile("J_([xyz]{2}|[123]{2})'*")
"""Entries of the inverse of what multiplies unknowns, constants themselves wherever they stand."""


def spelling(graph: Graph, value: Value) -> str:
    """Return a name that spells a short product, quotient or difference of names, or nothing.

    >>> g = Graph()
    >>> half = g.number(Fraction(1, 2))
    >>> spelling(g, g.mul([half, g.parameter("C"), g.power(g.parameter("A"), -1)]))
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


def formula(graph: Graph, value: Value) -> str:
    """Return ``value`` as text in parameters and named values.

    >>> g = Graph()
    >>> formula(g, g.mul([g.number(2), g.parameter("m"), g.power(g.parameter("r"), 2)]))
    '2*m*r^2'
    >>> formula(g, g.mul([g.number(-1), g.add([g.parameter("m"), g.parameter("r")])]))
    '-(m + r)'
    """
    coefficient, node = value
    sign = "-" if coefficient < 0 else ""
    factor = "" if abs(coefficient) == 1 else str(abs(coefficient))
    if node == ONE:
        return str(coefficient)
    body = _node_text(graph, node)
    if not sign + factor and graph.nodes[node][0] in ("let", "cut") and body[0] == "(":
        return body[1:-1]
    if sign + factor and graph.nodes[node][0] == "sum":
        body = f"({body})"
    return sign + (f"{factor}*{body}" if factor else body)


def meaning(graph: Graph, value: Value) -> str:
    """Return what a constant is: its formula, or of what it is made where that is long.

    >>> g = Graph()
    >>> meaning(g, g.let("pivot", g.power(g.mul([g.parameter("m"), g.parameter("r")]), -1)))
    '1/(m*r)'
    """
    inverse = INVERSE.fullmatch(graph.names.get(value[1], "")) if value[0] == 1 else None
    if inverse:
        return f"entry {inverse[1]} of the inverse of the matrix that multiplies the unknowns"
    if _names_in(graph, value) <= LONGEST and len(text := formula(graph, value)) <= LONGEST:
        return text
    inputs = [graph.nodes[n][1] for n in graph.within([value]) if graph.nodes[n][0] == "input"]
    return f"a constant made of {', '.join(map(str, inputs))}"


def _names_in(graph: Graph, value: Value) -> int:
    """Return how many names and numbers the formula of a value is made of, which it may repeat."""
    found: dict[int, int] = {}
    for node in graph.within([value]):
        inverse = INVERSE.fullmatch(graph.names.get(node, ""))
        found[node] = 1 if inverse else max(sum(found[n] for n in graph.below(node)), 1)
    return found[value[1]]


def _node_text(graph: Graph, node: int) -> str:
    kind, *rest = graph.nodes[node]
    if kind == "input":
        return str(rest[0])
    if kind in ("let", "cut"):
        name = graph.names.get(node, "")
        return name if INVERSE.fullmatch(name) else _within(formula(graph, rest[0]))
    if kind == "call":
        inner = ", ".join(formula(graph, v) for v in rest[1])
        return f"{rest[0]}({inner})" if inner else str(rest[0])
    if kind == "sum":
        text = " + ".join(formula(graph, v) for v in rest[0])
        return text.replace("+ -", "- ")
    top = [_power_text(graph, n, p) for n, p in rest[0] if p > 0]
    bottom = [_power_text(graph, n, -p) for n, p in rest[0] if p < 0]
    above = "*".join(top) or "1"
    if not bottom:
        return above
    return f"{above}/{bottom[0]}" if len(bottom) == 1 else f"{above}/({'*'.join(bottom)})"


def _within(text: str) -> str:
    """Return a formula as it stands within another."""
    return text if re.fullmatch(r"\w+(\([^()]*\))?", text) else f"({text})"


def _power_text(graph: Graph, node: int, power: int) -> str:
    body = _node_text(graph, node)
    if graph.nodes[node][0] in ("sum", "product"):
        body = f"({body})"
    return body if power == 1 else f"{body}^{power}"
