"""The gallery has a card for every scene, with a drawing made from the scene and nothing else."""

import re

import pytest

from derive.gallery import card, gallery
from derive.gallery.drawing import HEIGHT, WIDTH, drawing
from derive.scene import Machine, catalogue, load, parse_scene
from tests.made import library_of, thinned


@pytest.mark.parametrize("name", thinned(catalogue(), 4))
def test_a_scene_has_a_card_with_all_its_parts(name: str) -> None:
    found = card(library_of(name))
    assert found.title
    points = re.findall(r"(-?[0-9.]+),(-?[0-9.]+)", found.drawing)
    assert points
    assert all(0 <= float(x) <= WIDTH and 0 <= float(y) <= HEIGHT for x, y in points)
    assert f'href="{name}/{name}.html"' in gallery([found])


def test_a_closed_form_is_shown_where_it_is_short() -> None:
    found = card(library_of("edge_runner_flat"))
    assert "<mfrac>" in found.equation
    assert found.answer.startswith("N = ")


def test_a_drawing_moves_with_the_scene() -> None:
    scene = load("rod_wire_vertical_shaft")
    assert isinstance(scene, Machine)
    steeper = parse_scene(scene.text.replace("[0.8, 1.2]", "[0.2, 0.3]"), scene.name)
    assert drawing(scene) != drawing(steeper)
