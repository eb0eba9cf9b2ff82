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
    assert says.startswith("the divisor of 'psi_ddot', 'theta_ddot' vanishes at ")
    assert ", theta = 0," in says


def test_where_the_machine_itself_has_a_pole_nothing_is_asked_of_its_functions(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = library(parse_scene(UPRIGHT, "upright"))
    assert poles(made) == []
    monkeypatch.setattr("tests.mechanics.poles.regular", lambda *_: True)
    assert [pole.function for pole in poles(made)] == ["accelerations"]
