"""Every operator of the lecture can be written, and what is written says what the tree says."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator

import pytest
from sympy import Rational, cos, exp, pi, sin, sqrt, symbols, tan

from derive.emit.notation import (
    equation_mathml,
    equation_text,
    expression_text,
    mathml,
    name_mathml,
)
from derive.emit.notation import tree as notation_tree
from derive.emit.notation.mathml import row
from derive.emit.notation.symbolic import symbolic_layout
from derive.emit.notation.text import plain
from derive.emit.notation.tree import NotationError
from derive.emit.page.equation import _apart
from derive.lecture.chapters import LECTURE
from derive.lecture.step import Step
from derive.lecture.sums import others
from derive.lecture.vectors import (
    COMPONENTS,
    IDENTITY,
    Expression,
    axial,
    component,
    cosine,
    cross,
    cross_tensor,
    dot,
    inertia,
    number,
    outer,
    quantity,
    reciprocal,
    scalar,
    sine,
    tensor,
    total,
    trace,
    transpose,
    turn,
    unit,
    vector,
    zero,
)

a, b, c = vector("a"), vector("b"), vector("c")
m, q = scalar("m"), scalar("q_w")
R = tensor("R")
WRITTEN = {
    "a x (b x c)": cross(a, cross(b, c)),
    "(a x b) x c": cross(cross(a, b), c),
    "m a . b": m * dot(a, b),
    "2 a x b": 2 * cross(a, b),
    "q_w (a x b)": q * cross(a, b),
    "(a . b) c": dot(a, b) * c,
    "a (b . c)": a * dot(b, c),
    "a - (b - c)": a - (b - c),
    "a - b - c": a - b - c,
    "-(a + b)": -(a + b),
    "-a x b": -cross(a, b),
    "m (a + b)": m * (a + b),
    "(m + q_w) a": (m + q) * a,
    "-1/2 a . b": number(Rational(-1, 2)) * dot(a, b),
    "m^2": m * m,
    "R I R^T": R @ (inertia("I") @ transpose(R)),
    "(R I)^T": transpose(R @ inertia("I")),
    "omega x ((m 1) omega)": cross(vector("omega"), (m * IDENTITY) @ vector("omega")),
    "a b^T": outer(a, b),
    "[a + b]x": cross_tensor(a + b),
    "tr(R)": trace(R),
    "axial(R)": axial(R),
    "turn(a, m)": turn(a, m),
    "sin(m) + cos(q_w)": sine(m) + cosine(q),
    "(1/m) a": reciprocal(m) * a,
    "1/(m q_w)": reciprocal(m * q),
    "rho_i_x": component(vector("rho_i"), "x"),
    "(a x b)_x": component(cross(a, b), "x"),
    "I_xy": quantity(inertia("I"), "xy"),
    "e_x": unit("x"),
    "0": zero(3),
    "sum(dm_i rho_i)": total(scalar("dm_i") * vector("rho_i")),
    "sum_wheels(h_w)": total(vector("h_w"), "wheels"),
    "r_i x sum_others(P_ij)": cross(vector("r_i"), others(vector("P_ij"))),
}


@pytest.mark.parametrize(("text", "expression"), WRITTEN.items(), ids=WRITTEN)
def test_a_tree_is_written_with_the_parentheses_it_needs_and_no_more(
    text: str, expression: Expression
) -> None:
    assert expression_text(expression) == text


def test_different_trees_of_the_table_are_written_differently() -> None:
    assert len(set(WRITTEN.values())) == len(WRITTEN)
    assert len({mathml(e) for e in WRITTEN.values()}) == len(WRITTEN)


def operators(expression: Expression) -> Iterator[str]:
    """Yield every operator of a tree."""
    yield expression.operator
    for operand in expression.operands:
        yield from operators(operand)


def test_every_operator_of_the_algebra_is_in_the_table() -> None:
    tried = {operator for e in WRITTEN.values() for operator in operators(e)}
    assert set(COMPONENTS) <= tried
    spoken = {o for s in LECTURE.steps for pair in s.claims for e in pair for o in operators(e)}
    assert spoken <= tried | {"symbol", "inertia", "zero", "identity", "unit", "sum", "others"}


def test_an_unknown_operator_is_refused_by_name() -> None:
    strange = Expression("wedge", (a, b), (3,))
    for write in (expression_text, mathml):
        with pytest.raises(NotationError, match="not 'wedge'"):
            write(a + strange)
    x, y = symbols("x y")
    with pytest.raises(NotationError, match=r"not 'exp\(x\)'"):
        expression_text(y + exp(x))
    with pytest.raises(NotationError, match=r"not 'y\*\*x'"):
        expression_text(x * y**x)


def test_a_forgotten_operator_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(notation_tree._OPERATORS, "cross")
    with pytest.raises(NotationError, match="not 'cross'"):
        equation_text(LECTURE["general_form"])


def test_every_step_of_the_lecture_is_ascii_in_comments_and_well_formed_on_pages() -> None:
    for step in LECTURE.steps:
        assert equation_text(step).isascii()
        ET.fromstring(f"<div>{equation_mathml(step)}</div>")  # noqa: S314 (made here)
        assert equation_mathml(step).count('<div class="line">') == len(step.claims)


def test_the_general_form_reads_as_the_lecturer_writes_it() -> None:
    assert (
        equation_text(LECTURE["general_form"])
        == "M = I_dot omega + I omega_dot + Omega x (I omega)"
    )


def test_a_long_equation_counts_the_claims_it_leaves_out() -> None:
    step = Step("many", "", "deduce", (scalar("left_side"),) * 20, (scalar("right_side"),) * 20)
    assert equation_text(step).endswith("; and 13 more")


def test_rates_seen_from_n_carry_the_n() -> None:
    assert "<mprescripts/>" in mathml(vector("l_N_dot"))
    assert "<mprescripts/>" not in mathml(vector("l_dot"))


def test_scene_expressions_use_the_users_names_in_an_order_of_their_own() -> None:
    x, y, t = symbols("s0 s1 s2")
    names = {x: "I_xx", y: "omega_x", t: "theta"}
    expression = -x * y / 2 + sin(t) ** 2 / (2 * x) + sqrt(y) - 3 * y * (x - y) ** 2 + pi * tan(t)
    assert plain(symbolic_layout(expression, names)) == (
        "sqrt(omega_x) + pi tan(theta) - 1/2 I_xx omega_x "
        "- 3 (I_xx - omega_x)^2 omega_x + sin(theta)^2/(2 I_xx)"
    )
    assert "<mi>ω</mi><mi>x</mi>" in row(symbolic_layout(y * cos(t), names))


def test_names_are_drawn_as_a_book_draws_them() -> None:
    drawn = {name: name_mathml(name, "scalar") for name in ("roller_omega_x", "blade_mass", "w3")}
    assert "<msub><mi>ω</mi>" in drawn["roller_omega_x"]
    assert re.findall(r"<m[in]>(\w+)", drawn["roller_omega_x"]) == ["ω", "roller", "x"]
    assert "<mi>blade mass</mi>" in drawn["blade_mass"]
    assert "<msub><mi>w</mi><mn>3</mn></msub>" in drawn["w3"]


def test_no_two_quantities_of_a_scene_look_alike() -> None:
    a, b, c = symbols("a b c")
    shown = _apart({a: "roller_omega_x", b: "omega_roller_x", c: "omega_x"})
    assert shown == {a: "roller_omega_x", b: "omega roller x", c: "omega_x"}
    assert len({name_mathml(name, "scalar") for name in shown.values()}) == 3


def test_numbers_in_names_order_sums_and_products_as_numbers() -> None:
    each = symbols("k1:12")
    assert plain(symbolic_layout(sum(each), {})) == " + ".join(map(str, each))
    assert plain(symbolic_layout(each[9] * each[8], {})) == "k9 k10"


def test_a_factor_of_minus_signs_only_is_written_with_plus_signs() -> None:
    I, m, a = symbols("I m a")  # noqa: E741
    for power, found in ((1, "(I + m) a"), (-1, "-a/(I + m)"), (2, "(I + m)^2 a")):
        sign = -1 if power == 1 else 1
        assert plain(symbolic_layout(sign * a * (-I - m) ** power, {})) == found
    assert plain(symbolic_layout(-I - m, {})) == "-I - m"
