"""Bodies in one frame are one: what holds them there need not be declared, and changes nothing.

Beside it what else is said of a body that shares its frame: a wheel without mass, where the first
of two blades lies, and a gravity gradient by the centre that it comes from.
"""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from derive import load
from derive.check import proof
from derive.library.library import library
from derive.scene import SceneError, parse_scene
from tests.scene.fuzzed import texts

TEXT = (Path(__file__).parent / "scenes" / "one_frame.toml").read_text(encoding="utf-8")
DECLARED = TEXT + 'weld = { on = "panels", against = "hull", force = "?weld", couple = "?turn" }\n'
FREE = """
wanted = ["accelerations"]
parameters = { m = { unit = "kg", range = [1, 2] }, l = { unit = "m", range = [1, 2] } }
coordinates.q = { unit = "rad", range = [-1, 1] }
frames.arm.turned = ["x q"]
bodies.rod = { frame = "arm", shape = "rod", axis = "z", mass = "m", length = "l" }
bodies.bob = { frame = "arm", shape = "point", mass = "2*m", centre = [0, 0, "-l/2"] }
loads.weight.gravity = [0, 0, -9.81]
loads.pin = { on = "rod", force = "?pin", couple = [0, "?b", "?c"] }
"""
VALUES: dict[str, Any] = {"A": 1.5, "m": 3.5, "l": 0.9, "J": 0.015, "R": 7e6, "u": 0.25, "s": 4.0,
          "w": [0.1, 0.2, -0.3], "attitude_hull": [0.8, 0.6, 0, 0]}  # fmt: skip


def programs(text: str) -> list[Any]:
    made = library(parse_scene(text, "sat"))
    return [(p.name, p.results, p.ops, p.numbers) for p in (made.setup, *made.printed())]


@pytest.mark.long
def test_a_weld_need_not_be_declared() -> None:
    assert programs(TEXT) == programs(DECLARED)
    scene = parse_scene(TEXT, "sat")
    assert "Body panels is fixed to hull, both in hull." in scene.told
    assert scene.warnings == ()
    assert not any("weld" in says.lower() for says in scene.told)


def test_a_pendulum_of_two_bodies_swings_as_its_moments_say() -> None:
    (found,) = (
        load(tomllib.loads(FREE), "rod")
        .solve({"m": 1.5, "l": 1.2, "q": 0.0, "q_dot": 0.3})
        .all("q_ddot")
    )
    assert found == 0
    swing = load(tomllib.loads(FREE), "rod").solve({"m": 1.5, "l": 1.2, "q": 0.5, "q_dot": 0.3})[
        "q_ddot"
    ]
    assert swing == pytest.approx(-9.81 * 0.479425538604203 / (1.2 * (1 / 12 + 1 / 2)), rel=1e-12)


@pytest.mark.long
def test_what_bodies_in_one_frame_answer_is_proved() -> None:
    assert proof(library(parse_scene(TEXT, "sat"))).outcome == "holds"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('pin = { on = "rod"', 'pin = { on = "bob"'),  # whichever is held, the other is fixed to it
        ("bodies.bob = {", "bodies.bob = { turned = ['z 0.3'],"),
    ],
)
def test_what_is_held_holds_the_other(old: str, new: str) -> None:
    text = FREE.replace(old, new).replace("'", '"')
    assert proof(library(parse_scene(text, "rod"))).outcome == "holds"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("bodies.bob = {", 'bodies.bob = { turned = ["z q"],'),  # it turns in its frame
        ('bodies.bob = { frame = "arm"', 'bodies.bob = { frame = "inertial"'),
    ],
)
def test_a_body_that_is_not_fixed_in_a_held_frame_is_not_welded(old: str, new: str) -> None:
    with pytest.raises(SceneError, match="holds no unknown: declare a load"):
        library(parse_scene(FREE.replace(old, new), "rod"))


@pytest.mark.long
def test_no_scene_that_needed_none_has_a_weld() -> None:
    for name, text in texts().items():
        try:
            scene = parse_scene(text, f"x_{name}")
        except SceneError:
            continue
        welds = [one.name for one in scene.loads if one.name.startswith("weld of")]
        assert welds == (["weld of panels"] if name == "one_frame" else [])


def test_the_first_of_two_blades_lies_where_it_is_said_to() -> None:
    def inertia(blades: str) -> list[str]:
        scene = parse_scene(TEXT.replace('axis = "z", first = "y"', blades), "sat")
        return [str(f) for f in scene.body("panels").inertia[:3]]

    assert inertia('axis = "z", first = "y"')[1] == "0"
    assert inertia('axis = "z"') == inertia('axis = "z", first = "x"')
    assert inertia('axis = "z"')[0] == "0"
    assert inertia('axis = "y"') == inertia('axis = "y", first = "z"')
    one = parse_scene(TEXT.replace("number = 2", "number = 1"), "sat").body("panels")
    assert [str(f) for f in one.centre] == ["0", "1/2*l", "0"]
    parts = [part.turned for part in parse_scene(TEXT, "sat").body("panels").parts]
    assert [float(t) for t in parts] == [0.25, 0.75]


@pytest.mark.long
def test_a_field_may_be_told_by_its_centre_by_an_orbit_or_by_a_formula() -> None:
    centre = '{ mu = "mu", distance = "R" }'
    assert programs(TEXT) == programs(TEXT.replace(centre, '"3*(mu/R^3)"'))
    orbit = TEXT.replace(centre, '{ orbital_rate = "n" }')
    orbit = orbit.replace("[parameters]", '[parameters]\nn = { unit = "rad/s", range = [1, 2] }')
    (load_,) = [one for one in parse_scene(orbit, "sat").loads if one.name == "field"]
    assert str(load_.strength) == "3*n^2"  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [  # of the field, then of blades and masses
        ("distance = ", "radius = ", "load 'field'.gravity_gradient has an unknown key 'radius'"),
        (', distance = "R"', "", "load 'field'.gravity_gradient needs mu and distance, or orbital"),
        ('"R" }', '"R", orbital_rate = 1 }', "needs mu and distance, or orbital_rate alone"),
        ('{ mu = "mu", distance = "R" }', "{ }", "needs mu and distance, or orbital_rate alone"),
        ('distance = "R"', 'distance = "mu"', "distance = 'mu' is in m^3/s^2, not"),
        ('distance = "R"', "distance = 0", "gradient: 3*mu/distance^3 divides by zero"),
        ('{ mu = "mu", distance = "R" }', '"mu/R^2"', "gradient = 'mu/R^2' is in m/s^2, not"),
        ('first = "y"', 'first = "z"', "panels'.first must be across the axis, not 'z' itself"),
        ('first = "y"', 'first = "w"', "body 'panels'.first must be one of x, y, z, not 'w'"),
        ("mass = 0,", "mass = -1,", "body 'wheel'.mass must be positive, not -1"),
        ("mass = 0.5", "mass = 0", "body 'panels'.mass must be positive, not 0"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_there_is_refused_by_one_sentence(
    old: str, new: str, says: str
) -> None:
    assert old in TEXT
    with pytest.raises(SceneError) as refused:
        parse_scene(TEXT.replace(old, new), "sat")
    assert says in str(refused.value)


def test_a_single_body_has_a_mass() -> None:
    short = 'wanted = ["moment"]\nbody = { kind = "spherical", moment = 1, mass = 0 }\n'
    with pytest.raises(SceneError, match=r"body\.mass must be positive, not 0"):
        parse_scene(short, "ball")


@pytest.mark.long
def test_a_wheel_without_mass_turns_the_hull_back() -> None:
    found = load(tomllib.loads(TEXT), "sat").solve(VALUES)
    assert found.unanswered == {}
    carried = 0.015 * (found["s_dot"] + found["w_x_dot"])
    assert carried == pytest.approx(0.25, rel=1e-4)  # but for the field, some 1e-6 N m
