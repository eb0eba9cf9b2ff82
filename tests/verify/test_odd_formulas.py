"""Formulas that few write and the grammar allows: worked with, or refused in a sentence."""

from random import Random

import pytest

from derive.check.admission import hostile
from derive.emit.gallery.card import card
from derive.library.library import Library, library
from derive.program.precision import F64
from derive.scene import SceneError, parse_scene
from derive.verify.prove import prove
from derive.verify.sample import samples


def made(moment: str, wanted: str = "acceleration") -> Library:
    text = f"""
wanted = ["{wanted}"]
[parameters]
A  = {{ unit = "kg m^2", range = [1, 2] }}
al = {{ unit = "rad", range = [0.1, 0.5] }}
[body]
kind = "spherical"
moment = "{moment}"
[results]
gain = "A*tan(1)*omega_dot_x/cos(1)"
"""
    return library(parse_scene(text if wanted == "gain" else text.partition("[results]")[0], "odd"))


@pytest.mark.parametrize("moment", ["A*tan(1)", "A/cos(1)", "A*sin(1)/cos(1)", "A*cos(1)^2"])
def test_an_angle_of_one_has_a_cosine(moment: str) -> None:
    library = made(moment)
    prove(library)
    assert [q.name for q in library["acceleration"].outputs] == ["omega_dot"]


@pytest.mark.parametrize("moment", ["A*tan(al)", "A*tan(pi/4)"])
def test_bodies_are_judged_by_whatever_a_formula_may_hold(moment: str) -> None:
    assert len(samples(made(moment).mechanism, F64, 4, 0).each) >= 4


@pytest.mark.parametrize("moment", ["A*sqrt(1-al/al)+A", "A+sqrt(A^2-A^2)"])
def test_an_inertia_with_a_root_of_nothing_is_named(moment: str) -> None:
    with pytest.raises(SceneError, match=r"body: the square root of .* is that of 0"):
        card(made(moment))


def test_a_set_up_without_parameters_is_tried_once() -> None:
    text = """
wanted = ["acceleration"]
[inputs]
T = { unit = "N m", range = [-1, 1] }
[known]
moment = ["sin(0.3)*T", "T", "0"]
[body]
kind = "spherical"
moment = 1
"""
    setup = library(parse_scene(text, "no_parameters")).setup
    assert hostile(setup, F64, 9, Random(1)) == [{}]
