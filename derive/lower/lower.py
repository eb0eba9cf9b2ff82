"""From SymPy expressions to the graph: the last file that knows SymPy."""

from collections.abc import Iterable, Mapping
from fractions import Fraction

from sympy import Abs, Add, Expr, Mul, Pow, Rational, Symbol, cos, pi, sin, tan

from derive.lower.arrange.arrangement import Arrangement, Definition
from derive.lower.derivative import RULES
from derive.lower.graph import Graph, Value
from derive.scene import SceneError


def lower(graph: Graph, arrangement: Arrangement, leaves: Mapping[Symbol, Value]) -> list[Value]:
    """Return the values of the outputs in ``graph``.

    leaves : the graph's value of every input's symbol
    """
    known = defined(graph, arrangement.definitions, leaves)
    return [value_of(graph, e, known) for e in arrangement.outputs]


def defined(
    graph: Graph, definitions: Iterable[Definition], leaves: Mapping[Symbol, Value]
) -> dict[Symbol, Value]:
    """Return the values of definitions, and of all that they are made of, by symbol."""
    known = dict(leaves)
    for definition in definitions:
        name, value = definition.symbol.name, value_of(graph, definition.value, known)
        let = definition.kind == "let"
        named = graph.let(name, value, definition.family) if let else graph.cut(name, value)
        known[definition.symbol] = named
    return known


def value_of(graph: Graph, e: Expr, known: Mapping[Symbol, Value]) -> Value:
    """Return the graph's value of one expression."""
    match e:
        case Symbol():
            return known[e]
        case Rational():
            return graph.number(Fraction(int(e.p), int(e.q)))
        case Add():
            return graph.add([value_of(graph, a, known) for a in without_cancelling(e)])
        case Mul():
            return graph.mul([value_of(graph, a, known) for a in e.args])
        case Pow(exp=n) if n.is_Integer:
            return graph.power(value_of(graph, e.base, known), int(n))
        case Pow(exp=n) if n.is_Rational and n.q == 2:
            return graph.power(graph.call("sqrt", value_of(graph, e.base, known)), int(n.p))
        case Abs():
            rule = "its ends must not pass each other in the declared ranges"
            raise SceneError(f"a spring along one line has a length with a sign: {rule}")
        case tan():
            angle = value_of(graph, e.args[0], known)
            return graph.mul([graph.call("sin", angle), graph.power(graph.call("cos", angle), -1)])
    return _called(graph, e, known)


def _called(graph: Graph, e: Expr, known: Mapping[Symbol, Value]) -> Value:
    if e == pi:
        return graph.call("pi")
    name = e.func.__name__
    if name not in RULES:
        raise NotImplementedError(f"no operator for {e}")
    return graph.call(name, value_of(graph, e.args[0], known))


def without_cancelling(e: Add) -> list[Expr]:
    """Return the terms of a sum, each 1 - cos x as 2 sin^2(x/2), which loses no digits near 0.

    >>> x, y = Symbol("x"), Symbol("y")
    >>> without_cancelling(y - y * cos(x))
    [2*y*sin(x/2)**2]
    """
    terms = list(e.args)
    for term in e.args:
        for cosine in (f for f in Mul.make_args(term) if f.func is cos):
            other = -term / cosine
            if term in terms and other in terms:
                terms.remove(term)
                terms.remove(other)
                terms.append(2 * other * sin(cosine.args[0] / 2) ** 2)
    return terms
