"""The gallery has a card for every scene, with a drawing made from the scene and nothing else."""

import re

import pytest

from derive.emit.drawing.drawing import HEIGHT, WIDTH, drawing
from derive.emit.gallery.card import Card, card, gallery
from derive.library.library import library
from derive.scene import catalogue, load, parse_scene
from derive.scene.machine import LEFT_OVER
from tests.made import library_of, scene_of, thinned


def figures_of_card(found: Card) -> str:
    """Return what a card says of the first answer, without the marks of its letters."""
    return re.sub("<[^>]*>", "", found.answer.figures)


@pytest.mark.parametrize("name", thinned(catalogue(), 4))
def test_a_scene_has_a_card_with_all_its_parts(name: str) -> None:
    found = card(library_of(name))
    assert found.title
    points = re.findall(r"[ML](-?[0-9.]+),(-?[0-9.]+)", found.drawing)
    assert points
    assert all(0 <= float(x) <= WIDTH and 0 <= float(y) <= HEIGHT for x, y in points)
    assert f'href="{name}/{name}.html"' in gallery([found])


def test_a_closed_form_is_shown_where_it_is_short() -> None:
    found = card(library_of("edge_runner_flat"))
    assert any("<mfrac>" in equation for equation in found.answer.equations)
    assert figures_of_card(found).startswith("N = ")


@pytest.mark.parametrize("formula", ['"2*pi"', '{ formula = "W", unit = "rpm" }', '"sin(w)"'])
def test_an_answer_whose_constants_need_no_parameter_is_shown(formula: str) -> None:
    text = load("edge_runner_flat").text
    text = f'wanted = ["turn"]\n{text[text.index("[parameters]") :]}\nturn = {formula}'
    text = text.replace("[parameters]", '[parameters]\nw = { unit = "1", value = 0.3 }')
    assert figures_of_card(card(library(parse_scene(text, "edge")))).startswith("turn = ")


def test_formulas_of_attitudes_have_axes_and_no_body() -> None:
    found = card(library_of("attitude"))
    assert 'class="axis"' in found.drawing
    assert not re.findall('class="(solid|inertia)', found.drawing)
    assert 'class="inertia"' in card(library_of("heavy_top")).drawing


def test_attitudes_are_turned_by_quaternions_of_length_one() -> None:
    parts = re.findall(r"= (-?[0-9.]+)", card(library_of("attitude")).answer.figures)
    assert sum(float(part) ** 2 for part in parts) == pytest.approx(1, abs=2e-3)


@pytest.mark.parametrize("name", [n for n in catalogue() if scene_of(n).wanted[0] == "steady"])
def test_what_is_left_of_a_balance_is_not_shown_as_an_answer(name: str) -> None:
    assert card(library_of(name)).answer.figures.endswith(LEFT_OVER)


def test_a_drawing_moves_with_the_scene() -> None:
    scene = load("rod_wire_vertical_shaft")
    steeper = parse_scene(scene.text.replace("[0.8, 1.2]", "[0.2, 0.3]"), scene.name)
    assert drawing(scene) != drawing(steeper)


def glance(text: str) -> str:
    """Return what a card's answer shows, in plain characters."""
    answer = card(library(parse_scene(text, "own"))).answer
    parts = (*answer.equations, answer.figures)
    return " ".join(re.sub(r"<[^>]+>|&#8203;", "", part) for part in parts)


@pytest.mark.long
def test_all_short_answers_of_a_machine_are_shown_and_none_that_is_given() -> None:
    text = load("cart_pendulum").text.replace(', "step_rk4"', "")
    own = glance(text.replace('wanted = ["state_rate",', 'wanted = ["energy",').replace(
        '"state_rate_jacobian", ', "").replace(', "energy", "rail"', ', "rail"'))  # fmt: skip
    assert all(f"{name}=" in own.replace(" ", "") for name in ("T", "V", "energy"))
    rates = glance(text)
    assert "Δ" in rates
    assert "rad/s²" in rates
    assert " m/s," not in rates
