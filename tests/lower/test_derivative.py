"""Derivatives obey the limit they are defined by: checked by exact interpolation, not by rules."""

from fractions import Fraction

import pytest
from hypothesis import given

from derive.lower.derivative import RULES, slopes_by
from derive.lower.graph import ZERO, Graph, Value
from tests.lower.test_graph import built, expressions, graph_with_leaves, plain, points, value_at

pytestmark = pytest.mark.long


def derivative(g: Graph, value: Value, leaf: Value) -> Value:
    return slopes_by(g, leaf)(value)


def slope(tree, point, name: str) -> Fraction:
    """Return the derivative of a polynomial of degree at most 12 from its values alone."""
    nodes = [Fraction(k) for k in range(-7, 8)]
    total = Fraction(0)
    for k in nodes:
        others = [m for m in nodes if m != k]
        weight = Fraction(0)
        for skip in others:
            part = Fraction(1, 1)
            for m in others:
                part *= (-m if m != skip else 1) * Fraction(1) / (k - m)
            weight += part
        total += weight * plain(tree, point | {name: point[name] + k})
    return total


@given(expressions, points)
def test_a_derivative_is_the_slope(tree, point):
    g, leaves = graph_with_leaves()
    value = built(g, leaves, tree)
    found = value_at(g, [derivative(g, value, leaves["x"])], point)
    assert found == [slope(tree, point, "x")]


@given(expressions, points)
def test_a_derivative_by_a_parameter_is_the_slope(tree, point):
    g, leaves = graph_with_leaves()
    value = built(g, leaves, tree)
    found = value_at(g, [derivative(g, value, leaves["p"])], point)
    assert found == [slope(tree, point, "p")]


def test_a_parameter_does_not_change_with_what_varies():
    g, leaves = graph_with_leaves()
    assert derivative(g, leaves["p"], leaves["x"]) == ZERO


def test_what_is_made_of_parameters_only_has_a_derivative_made_of_parameters_only():
    g, leaves = graph_with_leaves()
    by_parameter = derivative(g, g.power(leaves["p"], -3), leaves["p"])
    assert by_parameter == (Fraction(-3), g.power(leaves["p"], -4)[1])
    assert g.fixed[by_parameter[1]]


def test_a_scale_does_not_change_with_what_it_is_the_scale_of():
    g, leaves = graph_with_leaves()
    assert derivative(g, g.call("power_of_two", leaves["p"]), leaves["p"]) == ZERO


def test_the_second_derivative_of_the_sine_is_minus_the_sine():
    g = Graph()
    x = g.variable("x")
    s = g.call("sin", x)
    twice = derivative(g, derivative(g, s, x), x)
    assert twice == (Fraction(-1), s[1])


def test_a_quotient_and_a_root_are_differentiated():
    g = Graph()
    x = g.variable("x")
    assert derivative(g, g.power(x, -1), x) == (Fraction(-1), g.power(x, -2)[1])
    assert derivative(g, g.call("sqrt", x), x)[0] == Fraction(1, 2)


def test_every_smooth_function_has_a_rule():
    assert set(RULES) == {"sin", "cos", "sqrt", "power_of_two"}
