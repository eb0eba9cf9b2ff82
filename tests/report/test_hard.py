"""What is said to make a sample hard is what was put into the scene to make it so."""

import pytest

from derive.library.library import library
from derive.report.hard import EASY, HardCase, cases_of
from derive.report.states import fastest
from derive.report.wishes import in_other_form
from derive.scene import parse_scene
from tests.made import library_of

BODY = """
wanted = ["moment"]
body = {{ kind = "principal", moments = ["A", "B", "C"] }}
known = {{ angular_acceleration = [0, 0, 0], angular_velocity = {{ range = [1, 2] }} }}
[parameters]
A = {{ unit = "kg m^2", range = [2, 2.001], meaning = "moment about x" }}
B = {{ unit = "kg m^2", range = [2, 2.001], meaning = "moment about y" }}
C = {{ unit = "kg m^2", range = [{0}], meaning = "moment about z" }}
"""


def test_nothing_hard_is_said_of_a_function_without_cancellation() -> None:
    text = BODY.format("3, 3.5").replace('"moment"', '"kinetic_energy"', 1)
    made = library(parse_scene(text, "plain"))
    found, *_ = cases_of(made, made.functions[0], in_other_form(made.scene))
    assert found.error < EASY
    assert (found.why, found.advice) == ("", "")


POLE = """
title = "A rate through an angle whose cosine vanishes at an end of its range"
wanted = ["state_rate"]
axes = { turned = ["z psi", "y theta", "x phi"], fixed_in = "body" }
body = { kind = "spherical", moment = 2 }
[coordinates]
psi = { unit = "rad", range = [-1, 1], meaning = "angle" }
theta = { unit = "rad", range = [0, 1.57079], meaning = "angle" }
phi = { unit = "rad", range = [-1, 1], meaning = "angle" }
"""


@pytest.mark.long
def test_a_pole_is_told_by_the_angle_that_it_stands_at() -> None:
    made = library(parse_scene(POLE, "pole"))
    found, *_ = cases_of(made, made.functions[0], in_other_form(made.scene))
    assert found.error > EASY
    assert "theta" in found.why
    assert abs(found.values["theta"] - 1.57079) < 1e-3
    assert "form" in found.advice
    assert found.accurate is not None
    assert found.accurate < found.error / 4


TWO = """
wanted = ["moment"]
body = {{ kind = "principal", moments = ["A", "{0}", "C"] }}
known = {{ angular_velocity = ["P", "P", "0"] }}
[parameters]
A = {{ unit = "kg m^2", range = [2, 2.000001], meaning = "moment about x" }}
{1} = {{ unit = "kg m^2", range = {2}, meaning = "of the moment about y" }}
C = {{ unit = "kg m^2", range = [3, 3.5], meaning = "moment about z" }}
P = {{ unit = "rad/s", range = [1, 2], meaning = "turn about x and about y" }}
"""


def of_two(*words: str) -> HardCase:
    """Return the hardest case of the moment of a body with these for its moment about y."""
    own = library(parse_scene(TWO.format(*words), "two"))
    return cases_of(own, own.functions[0], None)[0]


def test_moments_a_part_in_a_million_apart_are_told_as_nearly_equal() -> None:
    alike = of_two("B", "B", "[2.000002, 2.000003]")
    assert "nearly equal moments: two principal moments differ by" in alike.why
    assert alike.rounding > 1e5  # u of A and of B are as much beside B - A
    assert "rounding the given numbers" in alike.advice
    assert of_two("B", "B", "[2.5, 2.9]").why == ""


def test_a_difference_of_moments_that_is_given_makes_nothing_hard() -> None:
    given = of_two("A + D", "D", "[1e-6, 2e-6]")
    assert (given.why, given.rounding < EASY) == ("", True)


MERGING = """
title = "Angles of gimbals that nearly merge, and a rate that is divided by what they leave"
wanted = ["state_rate"]
axes = { turned = ["z psi", "y theta", "x phi"], fixed_in = "body" }
body = { kind = "principal", moments = [2, 3, 4] }
[coordinates]
psi = { unit = "rad", range = [-1, 1], meaning = "angle" }
theta = { unit = "rad", range = [-1.57, 1.57], meaning = "angle" }
phi = { unit = "rad", range = [-1, 1], meaning = "angle" }
"""


@pytest.mark.long
def test_a_body_in_gimbals_that_merge_is_told_its_pole_and_has_a_sensible_rate() -> None:
    made = library(parse_scene(MERGING, "gimbals"))
    cases = cases_of(made, made.functions[0], in_other_form(made.scene))
    (found,) = (case for case in cases if case.output == "coordinate_rates")
    assert "near a pole at theta = " in found.why
    assert abs(found.values["theta"]) > 1.5
    speed = 10 * 3**0.5  # of three components within 10 rad/s, where nothing is said of them
    assert 1 < fastest(made) < 2 * speed


def test_a_rate_is_that_of_what_swings_slowly_about_a_fast_turn() -> None:
    earth = library_of("chandler_rigid_earth")
    wobble = 7.3e-5 * (0.804 - 0.801) / 0.801  # rate (C - A) / A, from the middle of its ranges
    assert 0.8 * wobble < fastest(earth) < 1.25 * wobble
