"""Values are equal when they are equal, whatever order they were built in."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from derive.lower.expand import (
    TooManyTermsError,
    collected_by_factors,
    factored,
    grouped,
    multiplied_out,
)
from derive.lower.graph import ONE, ZERO, Graph, Value
from derive.lower.schedule import schedule
from derive.program.arithmetic import EXACT
from derive.program.program import Program, Quantity
from derive.program.run import run

NAMES = ("p", "x", "y", "z")


def graph_with_leaves() -> tuple[Graph, dict[str, Value]]:
    g = Graph()
    leaves = {"p": g.parameter("p")} | {name: g.variable(name) for name in "xyz"}
    return g, leaves


def value_at(g: Graph, values: list[Value], point: dict[str, Fraction]) -> list[Fraction]:
    """Return ``values`` at a point, by way of scheduled operations in exact fractions."""
    ops, results = schedule(g, values, lambda node: node == ONE, lambda v: v[0], "t")
    scalars = tuple(Quantity(n, (n,), (), "", "", None, None, "") for n in NAMES)
    program = Program("f", "", scalars, (), ops, results)
    return run(program, EXACT, [point[n] for n in NAMES])


expressions = st.recursive(
    st.sampled_from(NAMES) | st.integers(-3, 3),
    lambda inner: st.tuples(
        st.sampled_from(["add", "mul"]), st.lists(inner, min_size=2, max_size=3)
    ),
    max_leaves=12,
)
points = st.fixed_dictionaries(
    {n: st.fractions(min_value=-4, max_value=4, max_denominator=7) for n in NAMES}
)


def built(g: Graph, leaves: dict[str, Value], tree) -> Value:
    if isinstance(tree, str):
        return leaves[tree]
    if isinstance(tree, int):
        return g.number(tree)
    operands = [built(g, leaves, part) for part in tree[1]]
    return g.add(operands) if tree[0] == "add" else g.mul(operands)


def plain(tree, point: dict[str, Fraction]) -> Fraction:
    if isinstance(tree, str):
        return point[tree]
    if isinstance(tree, int):
        return Fraction(tree)
    total = Fraction(tree[0] == "mul")
    for part in tree[1]:
        total = total + plain(part, point) if tree[0] == "add" else total * plain(part, point)
    return total


@given(st.lists(expressions, min_size=1, max_size=4), points)
def test_scheduled_operations_compute_what_was_built(trees, point):
    g, leaves = graph_with_leaves()
    values = [built(g, leaves, tree) for tree in trees]
    assert value_at(g, values, point) == [plain(tree, point) for tree in trees]


@pytest.mark.long
@given(expressions, points)
def test_multiplying_out_changes_no_value(tree, point):
    g, leaves = graph_with_leaves()
    expanded = multiplied_out(g, [built(g, leaves, tree)], frozenset())[0]
    forms = [way(g, expanded) for way in (collected_by_factors, grouped, factored)]
    assert value_at(g, forms, point) == [plain(tree, point)] * 3


def test_a_sum_is_one_node_in_any_order():
    g, leaves = graph_with_leaves()
    x, y = leaves["x"], leaves["y"]
    assert g.add([x, y]) == g.add([y, x])
    assert g.add([x, (Fraction(-1), y[1])])[1] == g.add([y, (Fraction(-1), x[1])])[1]


def test_what_cancels_leaves_nothing():
    g, leaves = graph_with_leaves()
    x = leaves["x"]
    assert g.add([x, (Fraction(-1), x[1])]) == ZERO
    assert g.mul([x, g.power(x, -1)]) == g.number(1)


def test_the_square_of_a_root_is_what_is_under_it():
    g, leaves = graph_with_leaves()
    root = g.call("sqrt", leaves["x"])
    assert g.mul([root, root]) == leaves["x"]
    assert g.power(root, -3) == g.mul([g.power(leaves["x"], -2), root])


def test_a_let_is_looked_through_and_a_cut_is_not():
    g, leaves = graph_with_leaves()
    x, y = leaves["x"], leaves["y"]
    total = g.add([x, y])
    through = multiplied_out(g, [g.mul([x, g.let("a", total)])], frozenset())[0]
    stopped = multiplied_out(g, [g.mul([x, g.cut("b", total)])], frozenset())[0]
    assert (len(through), len(stopped)) == (2, 1)


def test_multiplying_out_ends_where_a_part_has_more_terms_than_asked_for():
    g, leaves = graph_with_leaves()
    square = g.power(g.let("a", g.add([leaves["x"], leaves["y"]])), 2)
    assert len(multiplied_out(g, [square], frozenset(), 3)[0]) == 3
    with pytest.raises(TooManyTermsError):
        multiplied_out(g, [square], frozenset(), 2)


def test_a_pair_that_several_sums_share_is_added_once():
    g, leaves = graph_with_leaves()
    x, y, z = (leaves[n] for n in "xyz")
    ops, _ = schedule(g, [g.add([x, y, z]), g.add([x, y])], lambda n: n == ONE, lambda v: v[0], "t")
    assert [op.operator for op in ops] == ["add", "add"]


def test_a_negative_result_costs_no_negation_where_the_terms_can_be_swapped():
    g, leaves = graph_with_leaves()
    x, y = leaves["x"], leaves["y"]
    ops, _ = schedule(
        g, [g.add([y, (Fraction(-1), x[1])])], lambda n: n == ONE, lambda v: v[0], "t"
    )
    assert [(op.operator, op.operands) for op in ops] == [("sub", ("y", "x"))]
