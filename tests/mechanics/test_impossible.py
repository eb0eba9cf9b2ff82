"""A machine's bodies must be possible: no negative moment; what no masses can have is a warning."""

import pytest

from derive.library.library import library
from derive.scene import Scene, SceneError, parse_scene

SCENE = """
wanted = ["accelerations"]

[parameters]
J = {{ unit = "kg m^2", range = [1, 2], meaning = "a moment" }}

[coordinates]
theta = {{ unit = "rad", range = [-1, 1], meaning = "tilt" }}

[frames.stem]
turned = ["x theta"]

[bodies.rotor]
frame = "stem"
mass  = 2
{body}

[loads]
pull    = {{ gravity_gradient = "3", towards = {towards} }}
bearing = {{ on = "rotor", force = "?b", couple = ["0", "?c_y", "?c_z"] }}
"""
UP = '["0", "0", "1"]'


def scene(body: str, towards: str = UP) -> Scene:
    return parse_scene(SCENE.format(body=body, towards=towards), "rotor")


@pytest.mark.parametrize(
    ("body", "says"),
    [
        (
            'kind = "principal"\nmoments = ["J", -2, "J"]',
            "moments 1.5, -2, 1.5 with products 0, 0, 0 at J = 1.5",
        ),
        ('kind = "general"\nmoments = [1, 1, 1]\nproducts = [2, 0, 0]', "with products 2, 0, 0"),
        ('kind = "axisymmetric"\naxis = "z"\naxial = -1', "moments unknown, unknown, -1"),
    ],
)
def test_an_inertia_that_is_not_positive_definite_is_refused(body: str, says: str) -> None:
    with pytest.raises(SceneError, match="inertia must be positive definite, not ") as refusal:
        scene(body)
    assert says in str(refusal.value)


@pytest.mark.parametrize("moments", ['["J", "J", 0]', "[1, 1, 2]"])
def test_a_rod_and_a_disc_are_bodies_without_a_warning(moments: str) -> None:
    made = scene(f'kind = "principal"\nmoments = {moments}')
    assert not [w for w in made.warnings if "triangle" in w]
    assert library(made).functions


def test_a_broken_triangle_inequality_warns_with_the_corner_and_does_not_stop() -> None:
    made = scene('kind = "principal"\nmoments = [1, 0.5, "J"]')
    assert made.warnings == ("body 'rotor' inertia breaks the triangle inequality at J = 2",)
    assert library(made).functions


@pytest.mark.parametrize(
    ("towards", "says"),
    [
        ('["0", "0", "2"]', "must be a unit vector, not of length 2"),
        ("[0, 0, 0]", "is zero; it must be a unit vector"),
    ],
)
def test_a_direction_of_another_length_than_one_is_refused(towards: str, says: str) -> None:
    with pytest.raises(SceneError, match=f"load 'pull'.towards {says}"):
        scene('kind = "principal"\nmoments = [1, 1, "J"]', towards)


def test_a_direction_may_turn_with_a_coordinate() -> None:
    assert scene('kind = "principal"\nmoments = [1, 1, 1]', '["0", "sin(theta)", "cos(theta)"]')
