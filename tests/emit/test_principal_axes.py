"""A page tells the principal axes of a body whose products of inertia do not vanish."""

import re

import numpy as np
import pytest

from derive.emit.page.principal import principal_lines
from derive.scene import Scene, parse_scene
from tests.made import scene_of

TILTED = """
wanted = ["moment"]
parameters.m = { unit = "kg m^2", range = [1, 3] }
[body]
kind = "general"
moments = ["2*m", "3*m", "4*m"]
products = ["0.3*m", "-0.2*m", "0.1*m"]
"""


def tilted(text: str) -> Scene:
    return parse_scene(text, "tilted")


def numbers(text: str) -> list[float]:
    return [float(x) for x in re.findall(r"[-\d.e]+", text.replace("−", "-"))]


def test_the_axes_of_a_page_are_those_of_the_body_at_seven_tenths_of_its_ranges() -> None:
    (line,) = principal_lines(tilted(TILTED))
    assert line.body == "body"
    m = 2.4
    tensor = m * np.array([[2, -0.3, 0.2], [-0.3, 3, -0.1], [0.2, -0.1, 4]])
    moments, axes = np.linalg.eigh(tensor)
    assert numbers(line.moments) == pytest.approx(moments.tolist(), rel=1e-3)  # four digits
    for text, axis in zip(line.directions, axes.T, strict=True):
        assert abs(np.dot(numbers(text), axis)) == pytest.approx(1, abs=2e-3)  # three of those


def test_a_body_without_products_has_no_such_line_and_a_general_one_of_the_catalogue_has() -> None:
    assert (
        list(principal_lines(tilted(TILTED.replace('"0.3*m", "-0.2*m", "0.1*m"', "0, 0, 0")))) == []
    )
    assert list(principal_lines(scene_of("heavy_top"))) == []
    assert len(list(principal_lines(scene_of("free_body")))) == 1
