"""Steady motions: the balance that lasts is found; a residual must hold its unknown."""

import re
from math import cos, isclose, sin
from pathlib import Path

import pytest

from derive import load
from derive.library.library import library
from derive.mechanics.mechanism import Mechanism, mechanism
from derive.scene import SceneError, parse_scene
from derive.scene.machine import LEFT_OVER
from derive.solve.answers import AnswerRow
from derive.solve.instrument import opened
from derive.solve.motions import roots

HOOP = Path(__file__).parent / "scenes" / "hoop_steady.toml"
PENDULUM = """
wanted = ["steady"]
parameters.m = { unit = "kg", range = [1, 2] }
parameters.l = { unit = "m", range = [0.3, 0.5] }
coordinates.q = { unit = "rad", range = [-1, 1], rate = { range = [-2, 2] } }
frames.arm.turned = ["x q"]
bodies.bob = { frame = "arm", shape = "point", mass = "m", centre = ["0", "0", "-l"] }
loads.weight.gravity = ["0", "0", "-9.81"]
loads.pin = { on = "bob", force = "?pin", couple = ["0", "?cy", "?cz"] }
steady.unknown = "@"
"""
GIVEN = {"m": 0.015, "r": 0.013, "g": 9.81, "theta": 0.8, "s": 47.0}


def test_a_hoop_leans_steadily_as_its_moments_about_the_ground_demand() -> None:
    (root,) = roots(opened(str(HOOP)), GIVEN)
    W, r, g, theta = root["W"], GIVEN["r"], GIVEN["g"], GIVEN["theta"]
    n = GIVEN["s"] + W * cos(theta)  # omega along the axis; C = m r^2, A = C / 2
    turning = r * W * sin(theta) * (2 * n - W * cos(theta) / 2)
    assert isclose(turning, -g * cos(theta), rel_tol=1e-9)


def test_a_residual_that_does_not_hold_its_unknown_is_refused(tmp_path: Path) -> None:
    text = HOOP.read_text(encoding="utf-8") + "vanishes = 'g*sin(theta)'\n"
    other = tmp_path / "hoop.toml"
    other.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError, match="must depend on W, but it does not"):
        roots(opened(str(other)), GIVEN)


@pytest.mark.parametrize(
    ("unknown", "inputs"), [("q", {"q"}), ("m", {"m", "q"})], ids=["an angle", "a parameter"]
)
def test_what_is_sought_and_angles_stay_in_what_only_they_multiply(
    unknown: str, inputs: set[str]
) -> None:
    known = mechanism(parse_scene(PENDULUM.replace("@", unknown), "pendulum"))
    assert isinstance(known, Mechanism)
    assert {*known.depends_on("steady")} == inputs


@pytest.mark.parametrize(
    ("unknown", "says"),
    [
        ('"q_dot"', "the steady residual must depend on q_dot, but it does not"),
        ('"pi"', "steady.unknown must be one of m, l, q, q_dot, not 'pi'"),
        ('["q", "q"]', "steady.unknown has 'q' twice"),
        ("[]", "steady.unknown is an empty list"),
    ],
)
def test_an_unknown_that_cannot_be_found_is_refused(unknown: str, says: str) -> None:
    with pytest.raises(SceneError, match=re.escape(says)):
        library(parse_scene(PENDULUM.replace('"@"', unknown), "pendulum"))


def test_a_root_at_zero_is_found_once_and_no_scale_of_the_residual_makes_another(
    tmp_path: Path,
) -> None:
    for scale in ("1", "r^9"):  # a residual near 1e-17 has no other roots
        text = HOOP.read_text(encoding="utf-8")
        text += f"vanishes = '{scale}*W*(W - s)'\n"
        other = tmp_path / "hoop.toml"
        other.write_text(text, encoding="utf-8")
        found = [root["W"] for root in roots(opened(str(other)), GIVEN)]
        assert found == [pytest.approx(0, abs=1e-9), pytest.approx(47)]


def test_what_is_left_of_a_balance_is_said_to_be_no_answer() -> None:
    rows = _solved(str(HOOP), GIVEN | {"W": 5.0})
    assert [row.name for row in rows if row.of == "steady"] == [f"steady, {LEFT_OVER}"]


def test_what_vanishes_and_what_is_found_have_their_units(tmp_path: Path) -> None:
    text = HOOP.read_text(encoding="utf-8").replace('unknown = "W"', 'unknown = "theta"')
    other = tmp_path / "hoop.toml"
    other.write_text(text + "vanishes = 'theta_ddot*m*r^2'\n", encoding="utf-8")
    given = {n: x for n, x in GIVEN.items() if n != "theta"} | {"W": -20.0, "theta_dot": 0.0}
    found = _solved(str(other), given)
    assert {row.unit for row in found if row.of.startswith("steady")} == {"rad"}
    left = _solved(str(other), given | {"theta": 0.8})
    assert [row.unit for row in left if row.of == "steady"] == ["N m"]


def _solved(scene: str, values: dict[str, float]) -> tuple[AnswerRow, ...]:
    return load(scene).solve(values).rows


@pytest.mark.long
def test_small_motion_off_the_root_of_a_steady_motion_is_warned_about() -> None:
    governor = opened(str(HOOP.with_name("governor.toml")))
    given = {"m": 0.75, "M": 7.5, "l": 0.25, "g": 9.81, "theta0": 0.6}
    (root,) = (r for r in roots(governor, given | {"theta": 0.6, "theta_dot": 0.0}) if r["W"] > 0)
    steady = float(f"{root['W']:.12g}")  # as `derive solve` prints it
    assert governor.doubts(given | {"W": steady}) == ()
    assert governor.doubts({n: x for n, x in given.items() if n != "g"} | {"W": 1.0}) == ()
    (doubt,) = governor.doubts(given | {"W": 1.001 * steady})
    assert "no equilibrium: the acceleration of 'theta' is" in doubt
    assert doubt.endswith("at the values that are set")
