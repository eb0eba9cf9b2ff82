"""What cancels identically is not computed: a wheel's spin along its own axis, say."""

from fractions import Fraction
from random import Random

from derive.lower.cancel import what_is_left
from derive.lower.graph import ZERO, Graph


def test_a_spin_has_no_moment_along_its_own_axis_whatever_stands_beside_it():
    dice = Random("axes")
    for _ in range(20):
        graph = Graph()
        w = [graph.variable(f"w_{k}") for k in "xyz"]
        spin, moment = graph.variable("s"), graph.parameter("K")
        e = [Fraction(dice.randint(-9, 9), 10) or Fraction(1) for _ in range(3)]
        own = [graph.let("l", graph.add([w[k], graph.scaled(spin, e[k])])) for k in range(3)]
        rows = [
            graph.let("row", graph.mul([moment, graph.add([
                graph.mul([w[i], own[j]]), graph.scaled(graph.mul([w[j], own[i]]), Fraction(-1))
            ])]))
            for i, j in ((1, 2), (2, 0), (0, 1))
        ]  # fmt: skip
        along = graph.add([graph.scaled(row, c) for row, c in zip(rows, e, strict=True)])
        assert along != ZERO
        assert what_is_left(graph, [[along]]) == [(ZERO,)]


def test_what_has_nothing_that_cancels_stays_what_it_was_and_makes_no_node():
    graph = Graph()
    x, y, z = (graph.variable(name) for name in "xyz")
    whole = graph.mul([x, graph.add([y, graph.let("a", graph.add([x, z]))])])
    less = graph.mul([graph.add([x, y]), graph.add([x, graph.scaled(y, Fraction(-1))])])
    count = len(graph.nodes)
    assert what_is_left(graph, [[whole, less]]) == [(whole, less)]
    assert len(graph.nodes) == count
