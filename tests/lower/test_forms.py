"""The cheapest of many forms is found without a look at every choice of them."""

from derive.lower.forms import Dependents, best_values, by_euler, jacobian, value_forms
from derive.lower.graph import Graph


def test_forty_blocks_of_two_forms_each_take_the_cheapest_of_each():
    """Together they have 2^40 choices, of which no list can be made."""
    graph = Graph()
    blocks = []
    for n in range(40):
        x, y, z = (graph.variable(f"{name}{n}") for name in "xyz")
        blocks.append(Dependents((graph.add([graph.mul([x, y]), graph.mul([x, z])]),), ()))
    assert {len(value_forms(graph, block)) for block in blocks} == {2}
    found = best_values(graph, blocks)
    assert [graph.nodes[node][0] for _, node in found] == ["product"] * 40


def test_what_varies_in_a_call_or_below_the_line_too_is_not_homogeneous():
    graph = Graph()
    x, y = graph.variable("x"), graph.variable("y")
    square = graph.power(graph.add([graph.power(x, 2), graph.power(y, 2)]), -1)
    for factor, follows in ((y, True), (graph.call("cos", x), False), (square, False)):
        value = graph.mul([x, factor])
        group = Dependents((value,), ((x,),))
        found = by_euler(graph, group, jacobian(graph, [value], [x]))
        assert (found is not None) == follows
