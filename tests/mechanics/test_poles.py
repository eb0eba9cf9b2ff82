"""No function divides by what vanishes in the declared ranges while the equations are regular."""

import re
from pathlib import Path

import pytest

from derive.library.library import Library, library
from derive.lower.arrange.pivots import Pivots
from derive.mechanics import regular
from derive.mechanics.sweep import Weakest
from derive.scene import CATALOGUE, SceneError, catalogue, parse_scene
from tests.mechanics.poles import ALLOWED, poles
from tests.scene.fuzzed import LONG_FORM

ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"^```toml\n(.*?)^```$", re.MULTILINE | re.DOTALL)
EVERY = {
    **{name: (CATALOGUE / f"{name}.toml").read_text() for name in catalogue()},
    **{
        page.stem: page.read_text()
        for folder in (ROOT / "tests/data/trials", ROOT / "tests/mechanics/scenes")
        for page in sorted(folder.glob("*.toml"))
    },
    **{f"long_{page.stem}": page.read_text() for page in LONG_FORM},
    **{
        f"{page.stem}_{n}": text
        for page in sorted((ROOT / "docs").glob("*.md"))
        for n, text in enumerate(BLOCK.findall(page.read_text()))
    },
}


def text(name: str, wanted: str) -> str:
    """Return the text of a cat that wants one function."""
    return "\n".join([f'wanted = ["{wanted}"]', *EVERY[name].splitlines()[2:]])


def made_of(name: str, scene: str) -> Library:
    """Return the programs of a scene that may be none: what is refused has no poles."""
    try:
        return library(parse_scene(scene, name))
    except SceneError as refusal:
        pytest.skip(f"no scene: {refusal}")


@pytest.mark.parametrize("name", ["heavy_top", "scenes_5", "rolling_ball"])
def test_a_function_is_right_wherever_the_equations_are_regular(name: str) -> None:
    assert poles(made_of(name, EVERY[name])) == []


@pytest.mark.long
@pytest.mark.parametrize("name", EVERY)
def test_every_function_is_right_wherever_the_equations_are_regular(name: str) -> None:
    assert poles(made_of(name, EVERY[name])) == []


@pytest.mark.long
@pytest.mark.whole
def test_a_straight_cat_is_no_pole() -> None:
    assert poles(made_of("bent_cat", text("bent_cat", "waist"))) == []


@pytest.mark.long
def test_without_the_search_the_pole_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(regular, "weakest", lambda *_: Weakest(1.0, {}))
    monkeypatch.setattr(Pivots, "vanish", lambda *_: False)
    found = poles(made_of("bent_cat", text("bent_cat", "waist")))
    assert [pole.output for pole in found] == ["waist"]
    assert found[0].error > ALLOWED


UPRIGHT = """
wanted = ["accelerations"]
[parameters]
m = { unit = "kg", range = [1, 2] }
l = { unit = "m", range = [1, 2] }
[coordinates]
psi   = { unit = "rad", range = [-1, 1] }
theta = { unit = "rad", range = [-0.5, 0.5] }
[frames.arm]
turned = ["z psi", "x theta"]
[bodies.bob]
frame  = "arm"
shape  = "point"
mass   = "m"
centre = ["0", "0", "l"]
[loads]
pin = { on = "bob", force = "?pin" }
"""


def test_a_pole_that_the_machine_has_is_named_with_its_place() -> None:
    made = library(parse_scene(UPRIGHT, "upright"))
    says = made.mechanism.pole("accelerations")
    assert says.startswith("the inertia of all that moves with 'psi' vanishes at m = ")
    assert says.endswith(", theta = 0")


@pytest.mark.long
def test_where_the_machine_itself_has_a_pole_nothing_is_asked_of_its_functions(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = library(parse_scene(UPRIGHT, "upright"))
    assert poles(made) == []
    monkeypatch.setattr("tests.mechanics.poles.regular", lambda *_: True)
    assert [pole.function for pole in poles(made)] == ["accelerations"]


WHEEL = """
wanted = ["accelerations"]
[parameters]
A = { unit = "kg m^2", range = [1, 2] }
a = { unit = "rad", range = [0.1, 3] }
[speeds]
w = { unit = "rad/s", range = [-1, 1] }
[inputs]
u = { unit = "N m", range = [-1, 1] }
[frames]
hub.angular_velocity = ["0", "0", "w"]
[bodies]
hub = { frame = "hub", kind = "axisymmetric", axis = "z", axial = "AXIAL", transverse = 0 }
[loads]
motor = { on = "hub", couple = ["?b", "?c", "u"] }
"""
NOTHING = (
    "no balance holds 'w_dot', so it cannot be found: the inertia of all that moves with 'w' is 0, "
    "or nothing beside what else the balances hold"
)


@pytest.mark.parametrize(
    ("axial", "says"),
    [
        *((f, NOTHING) for f in ("A*cos(pi/2)", "0*A", "A*(sin(a)^2 + cos(a)^2 - 1)")),
        ("A*cos(a)", "the inertia of all that moves with 'w' vanishes at A = 1.313, a = 1.571"),
        ("A*(1 - a/2)^2", "the inertia of all that moves with 'w' vanishes at A = 1.031, a = 2"),
    ],
)
def test_an_inertia_of_nothing_is_called_so_with_its_place(axial: str, says: str) -> None:
    with pytest.raises(SceneError) as refusal:
        library(parse_scene(WHEEL.replace("AXIAL", axial), "wheel"))
    assert str(refusal.value) == f"scene 'wheel': {says}"


@pytest.mark.long
def test_a_turn_that_moves_no_mass_is_not_called_regular() -> None:
    leaning = UPRIGHT.replace('["0", "0", "l"]', '["0", "l*sin(0.4)", "l*cos(0.4)"]')
    with pytest.raises(SceneError, match=r"that moves with 'psi' vanishes at .*, theta = 0.4$"):
        library(parse_scene(leaning, "leaning"))


def test_a_load_that_no_balance_holds_at_a_place_is_told_with_it() -> None:
    held = WHEEL.replace("AXIAL", "A").replace("?c", "cos(a)*?c").replace("accelerations", "c")
    with pytest.raises(SceneError, match=r"no balance holds 'c' at a = 1\.571, so it cannot be"):
        library(parse_scene(held, "held"))


@pytest.mark.parametrize("wanted", ["accelerations", "linearised"])
def test_a_motion_that_carries_nothing_is_said_to_have_no_inertia(wanted: str) -> None:
    idle = WHEEL.replace("[inputs]", 'v = { unit = "rad/s", range = [-1, 1] }\n[inputs]')
    idle = idle.replace("accelerations", wanted).replace("AXIAL", "A")
    with pytest.raises(SceneError, match="the inertia of all that moves with 'v' is 0"):
        library(parse_scene(idle, "idle"))


def test_a_divisor_that_holds_what_is_found_is_no_pole_of_the_ranges() -> None:
    found = WHEEL.replace("AXIAL", "A").replace("accelerations", "quick")
    found += '[results]\nquick = "1/w_dot"\n'
    assert library(parse_scene(found, "found")).mechanism.pole("quick") == ""
