"""What has a true end counts, however few steps follow it; what is infinite on its way does not."""

from pathlib import Path

import numpy as np
import pytest
from flint import arb, ctx

from derive.library.library import library
from derive.program.precision import F64, PRECISIONS
from derive.report.apart import errors_at_end, true_ends
from derive.report.courses import step_errors
from derive.report.driver import Driver, drivers
from derive.report.fate import ENDS, PASSES, fates
from derive.report.hardest import hardest
from derive.report.march import ended
from derive.report.reference import BITS, GROWS, INFINITE, end_of
from derive.report.sentence import motion_sentence, said_of
from derive.report.states import Begun, begun
from derive.report.wishes import wished
from derive.scene import parse_scene

BODY = """
wanted = ["step_rk4"]
axes = {{ attitude = "quaternion" }}
body = {{ kind = "spherical", moment = "A" }}
known = {{ moment = {0} }}
parameters.A = {{ unit = "kg m^2", range = [1, 2], meaning = "moment" }}
parameters.c = {{ unit = "N m s", range = {1}, meaning = "of the moment" }}
"""
GIMBALS = """
wanted = ["step_rk4"]
axes = {{ turned = ["z psi", "y theta", "x phi"], fixed_in = "body" }}
body = {{ kind = "spherical", moment = "A" }}
parameters.A = {{ unit = "kg m^2", range = [1, 2], meaning = "moment" }}
[coordinates]
psi = {{ unit = "rad", range = [-1, 1], meaning = "angle" }}
theta = {{ unit = "rad", range = [-1.57, 1.57], meaning = "angle" }}
phi = {{ unit = "rad", range = [-1, 1], meaning = "angle" }}
"""
STIFF = BODY.format('["-c*omega_x", "0", "0"]', "[0.1, 1e6]")
SPRING = BODY.format('["-c*attitude_x*attitude_w", "0", "0"]', "[1e4, 1e6]").replace("N m s", "N m")
BLOWS = BODY.format('["A*omega_x^2", "0", "0"]', "[1, 2]")
UNSTABLE = BODY.format('["c*omega_x", "0", "0"]', "[10, 20]")


def of(text: str, folder: Path) -> tuple[Driver, Begun]:
    own = library(parse_scene(text, "body"))
    (driver,) = drivers(own, (F64,), folder)
    return driver, begun(own, "fate", 24)


@pytest.mark.parametrize("text", [STIFF, SPRING])
def test_motions_that_long_steps_cannot_follow_have_an_end(text: str, tmp_path: Path) -> None:
    driver, start = of(text, tmp_path)
    found = fates(driver, start, 1e-3, 10.0)
    assert {*found.each} == {ENDS}


@pytest.mark.long
def test_motions_beside_a_pole_are_told_from_those_that_keep_away(tmp_path: Path) -> None:
    driver, start = of(GIMBALS.format(), tmp_path)
    found = fates(driver, start, 1.0, 10.0)
    assert {*found.each} == {ENDS, PASSES}


def test_what_is_stiff_for_a_part_of_the_ranges_is_hardest_there(tmp_path: Path) -> None:
    driver, _ = of(STIFF, tmp_path)
    found = hardest(driver, "fate", 1e-3, 1e3)
    assert sum(found.aside.values()) <= 0.02 * found.tried  # at the edge of being unstable
    rates = found.hard.columns[found.hard.names.index("c")] / found.hard.columns[0]
    assert found.hard.names[0] == "A"
    assert np.min(rates[:2]) > 7e5


def test_a_motion_is_infinite_where_it_is_by_its_equation(tmp_path: Path) -> None:
    driver, start = of(BLOWS, tmp_path)
    speeds = start.columns[start.names.index("omega_x")]
    found = fates(driver, start, 0.25, 10.0)  # omega_x' = omega_x^2: infinite at 1 / omega_x
    assert found.each == tuple(INFINITE if x * 0.25 > 1 else ENDS for x in speeds)
    assert {*found.each} == {INFINITE, ENDS}


@pytest.mark.long
def test_a_motion_that_grows_and_turns_is_not_said_to_become_infinite(tmp_path: Path) -> None:
    driver, start = of(UNSTABLE, tmp_path)
    assert {*fates(driver, start, 10.0, 10.0).each} <= {GROWS, ENDS}
    assert GROWS in fates(driver, start, 10.0, 10.0).each


def test_the_reference_follows_what_falls_off_at_once() -> None:
    own = library(parse_scene(STIFF, "body"))
    values = {"A": 1.5, "c": 1e6, "omega_x": 6.0, "omega_y": 0.0, "omega_z": 0.0}
    values |= {"attitude_w": 1.0, "attitude_x": 0.0, "attitude_y": 0.0, "attitude_z": 0.0}
    end = end_of(own, values, 0.01, 1000.0)
    with ctx.workprec(BITS):
        half = arb(6) * arb(1.5) / arb(10) ** 6 / 2  # all of the turn that is left to it
        should = {"attitude_w": half.cos(), "attitude_x": half.sin(), "omega_x": arb(0)}
        gaps = [abs(float(sum(map(arb, end.state[c])) - x)) for c, x in should.items()]
    assert max(gaps) < 1e-18


@pytest.mark.long
def test_the_sentence_on_a_stiff_body_holds_where_its_ranges_are_stiff(tmp_path: Path) -> None:
    own = wished(library(parse_scene(STIFF, "body")))
    by = drivers(own.library, PRECISIONS, tmp_path)
    found = step_errors(own, by, 0.005, lambda _: None)
    said = said_of(found)
    chosen = said.choices["f64"]
    assert chosen is not None
    assert sum(found.aside.values()) <= 0.02 * found.tried
    states = own.library.vocabulary.states
    start = begun(own.library, "another", 4)
    start.columns[start.names.index("c")] = (1e6, 5e5, 3e5, 1e6, 1e4, 1.0, 0.1, 7e5)
    ends = [end_of(own.library, start.values(k), found.time, found.fast) for k in range(8)]
    true = true_ends(states, ends)
    double = next(d for d in by if d.precision is F64)
    end = ended(double, chosen.attempt.step, start, found.time, chosen.attempt.count)
    assert max(errors_at_end(states, end, true)) <= said.target
    end = ended(double, "step_rk4", start, found.time, int(found.time * 1e6 / 8))
    assert max(errors_at_end(states, end, true)) == np.inf  # unstable: longer than 2.8 of J / c


@pytest.mark.long
def test_the_sentence_says_which_share_becomes_infinite(tmp_path: Path) -> None:
    own = wished(library(parse_scene(BLOWS, "body")))
    by = drivers(own.library, PRECISIONS, tmp_path)
    found = step_errors(own, by, 1.0, lambda _: None)
    count = found.aside[INFINITE]
    assert 0.2 * found.tried < count < 0.8 * found.tried
    assert f"left aside: of {found.tried} states tried, {count} (" in motion_sentence(found)
