"""Roots of squares that are taken as what is squared: said wherever equations stand or are used."""

import json

import pytest
from flint import arb
from sympy import Symbol

from derive.emit.c.source import c_files
from derive.emit.equations import equations
from derive.emit.manifest import manifest
from derive.emit.page.scene import scene_page
from derive.library.library import Library, library
from derive.lower.arrange.tidy import primitive
from derive.mechanics.problem import Problem
from derive.scene import SceneError, parse_scene
from derive.verify.measure import results

BEAD = """
wanted = ["state_rate", "energy"]
[parameters]
k = {{ unit = "N/m", range = [10, 50] }}
l = {{ unit = "m", range = [0.1, 0.2], meaning = "offset" }}
[coordinates]
x = {{ unit = "m", range = [{low}, 0.5] }}
[frames]
bead = {{ origin = ["{place}", "0", "0"] }}
[bodies]
bead = {{ frame = "bead", shape = "point", mass = 1 }}
[loads]
spring = {{ on = "bead", spring = "k", length = 0.2, at = [0, 0, 0] }}
rail = {{ on = "bead", force = [0, "?y", "?z"], couple = "?guide" }}
"""
TAKEN = "Taken: the length of spring is x, while x > 0 as in the declared range."

LINE = "Taken: the length of spring is {}, which is above 0 in the declared ranges."


def bead(low: float, place: str = "x") -> Library:
    return library(parse_scene(BEAD.format(low=low, place=place), "bead"))


def test_a_length_taken_without_its_sign_is_said_in_the_header_json_page_and_equations() -> None:
    made = bead(0.1)
    headers = [text for name, text in c_files(made, []).items() if name.endswith(".h")]
    for text in (*headers, equations(made, "text")):
        assert TAKEN in " ".join(text.replace("\n *", " ").split())
    assert json.loads(manifest(made, []))["taken"] == [TAKEN]
    assert scene_page(made, []).count("the length of spring is") == 2


@pytest.mark.parametrize(
    ("low", "place", "says"),
    [
        (-0.1, "x + l", (LINE.format("l + x"),)),
        (0.1, "sqrt(x^2)", (TAKEN, "Taken: sqrt(x^2) is x, while x > 0 as in the declared range.")),
        (0.1, "x - 5*l", (LINE.format("5*l - x"),)),
    ],
)  # fmt: skip
def test_signs_are_said_where_they_are_taken_and_nowhere_else(low, place, says) -> None:
    assert bead(low, place).mechanism.signs == says


def test_a_spring_along_one_line_pushes_whichever_side_its_other_end_is_on() -> None:
    made = bead(0.1, "x - 5*l")
    at = {"k": 20, "l": arb(0.125), "x": arb(0.25), "x_dot": 0}
    found = results(made, made["state_rate"], {n: arb(x) for n, x in at.items()})
    assert float(found["x_dot_rate"]) == 20 * ((0.625 - 0.25) - 0.2)  # drawn to 5 l, mass 1


def test_a_spring_whose_ends_pass_each_other_is_refused() -> None:
    rule = "a spring along one line has a length with a sign: its ends must not pass each other"
    with pytest.raises(SceneError, match=rule):
        bead(0.1, "x - l")


def test_a_spring_is_told_with_its_ends_and_its_length_at_rest() -> None:
    assert (
        "Load spring: a spring of stiffness k and length 1/5 at rest, from (0, 0, 0) of bead to"
        " (0, 0, 0) of inertial, on bead."
    ) in bead(0.1).mechanism.said


@pytest.mark.parametrize("above", [True, None])
def test_only_what_cannot_be_zero_is_divided_out_of_a_balance(above) -> None:
    s, u, y = Symbol("s", positive=above), Symbol("u"), Symbol("y")
    problem = Problem("a", "", (), {}, {}, (s * u - s * y,), (u,), (), ())
    rest, slopes = primitive(problem, problem.parts[0], frozenset({s}))
    assert (rest, slopes[u]) == ((-y, 1) if above else (-s * y, s))


def test_the_header_of_an_energy_says_which_potential_it_holds_and_no_other_does() -> None:
    (text,) = (t for name, t in c_files(bead(0.1), []).items() if name.endswith("f64.h"))
    said = " ".join(text.replace("\n *", " ").split())
    says = "Energy: The potential energy is the sum of k (d - d_0)^2/2 of each spring"
    assert said.count(says) == 1
    assert said.index(says) > said.index("* Energy. ")
