"""Values that rest on others twice, level upon level, are looked at once each."""

from fractions import Fraction

from derive.lower.graph import Graph, Value
from derive.lower.setup import exact_number
from derive.lower.wording import meaning

LEVELS = 1200  # each twice as long, written out, as the one below


def tower(graph: Graph, value: Value) -> Value:
    for level in range(LEVELS):
        inverse = graph.cut("inverse", graph.power(value, -1))
        value = graph.cut(f"m_{level}", graph.add([value, graph.mul([inverse, value, value])]))
    return value


def test_what_a_constant_is_made_of_is_told_without_writing_it_out() -> None:
    graph = Graph()
    text = meaning(graph, tower(graph, graph.add([graph.parameter("m"), graph.parameter("M")])))
    assert text == "a constant made of m, M"


def test_a_number_is_found_whatever_it_repeats() -> None:
    graph = Graph()
    three = graph.call("abs", graph.number(Fraction(-3)))
    assert exact_number(graph, tower(graph, three)) == 3 * 2**LEVELS


def test_what_rests_on_a_parameter_is_no_number() -> None:
    graph = Graph()
    assert exact_number(graph, tower(graph, graph.parameter("m"))) is None
