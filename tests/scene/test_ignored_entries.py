"""No number and no formula of a scene file is ignored: a change changes the code or is refused."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from sympy import eye

from derive.mechanics import bodies, loads
from derive.scene import CATALOGUE, parse_scene
from tests.made import thinned
from tests.scene import mutated
from tests.scene.fuzzed import LONG_FORM
from tests.scene.mutated import ignored, unread

ROOT = Path(__file__).parents[2]
TRIALS = ROOT / "tests" / "data" / "trials"
BODIES = ("free_body_principal", "heavy_top", "propeller_3_blade", "skewed_disc")
FILES = (
    *(CATALOGUE / f"{name}.toml" for name in BODIES),
    *(TRIALS / f"{name}.toml" for name in ("force_by_attitude", "force_by_parameters")),
)  # each of their entries makes a scene anew: those of larger machines would take an hour
EVERY = {path.stem: path.read_text(encoding="utf-8") for path in FILES}
TEXTS = {
    path.stem: path.read_text(encoding="utf-8")
    for folder in (CATALOGUE, TRIALS)
    for path in sorted(folder.glob("*.toml"))
    if not path.stem.startswith("meaning_")
}  # those are refused, whatever else is changed
TEXTS |= {f"long_{path.stem}": path.read_text(encoding="utf-8") for path in LONG_FORM}
BLOCKS = [
    text
    for page in ("scenes", "motion")
    for text in re.findall(
        r"^```toml\n(.*?)^```$", (ROOT / "docs" / f"{page}.md").read_text(), re.M | re.S
    )
    if not text.startswith("# scene 'example'")
]
OMEGA_BY_FORMULAS = """
wanted     = ["moment"]
parameters = { W = { unit = "rad/s", range = [1, 2] } }
body       = { kind = "principal", moments = [1, 2, 2.5] }
known      = { angular_velocity = ["W", "0", "0.5*W"] }
"""
OMEGA_DOT_BY_FORMULAS = """
wanted     = ["moment"]
parameters = { a = { unit = "rad/s^2", range = [1, 2] } }
body       = { kind = "principal", moments = [1, 2, 2.5] }
known      = { angular_acceleration = ["a", "0", "0.5*a"] }
"""
AXES_THAT_TURN_WITH_THE_BODY = """
wanted = ["moment"]
speeds = { W = { unit = "rad/s", range = [1, 2], rate = 0 } }
axes   = { fixed_in = "body", angular_velocity = ["W", "0.25*W", "0.5*W"] }
body   = { kind = "principal", moments = [1, 2, 2.5] }
"""
TURNED_WITH_THE_BODY = """
wanted      = ["angular_momentum"]
coordinates = { psi = { @, rate = { range = [1, 2] } }, tilt = { @, rate = { range = [1, 2] } } }
axes        = { fixed_in = "body", turned = ["z psi", "x tilt"] }
body        = { kind = "principal", moments = [1, 2, 2.5] }
""".replace("@", 'unit = "rad", range = [0.5, 1], motion = "prescribed", acceleration = 0')
POINT_BY_INPUTS = """
wanted     = ["acceleration"]
inputs     = { u = { unit = "m/s^2", range = [-1, 1] }, M = { unit = "N m", range = [-1, 1] } }
body       = { kind = "principal", moments = [1, 2, 2.5], mass = 3, centre = [0, "0.5", "0.25"] }
point      = { kind = "moving", acceleration = ["u", "0", "0.5*u"] }
known      = { moment = ["M", "0", "0.5*M"] }
"""
FORCE = """
wanted     = ["state_rate"]
parameters = { F = { unit = "N", range = [1, 2] } }
axes       = { attitude = "quaternion" }
body       = { kind = "spherical", moment = 1, mass = 2 }
position   = { position = { range = [-1, 1] }, velocity = { range = [-1, 1] } }
known      = { force = ["F", "0", "0.5*F"], moment = [0, 0.5, 0] }
"""
UNTURNED = """
wanted     = ["acceleration"]
body       = { kind = "spherical", moment = 2 }
known      = { moment = [0, "0", 0] }
"""
TURNED = UNTURNED.replace('[0, "0", 0]', '[0, "1/8", 0]')
SHORT = {
    "omega_by_formulas": OMEGA_BY_FORMULAS,
    "omega_dot_by_formulas": OMEGA_DOT_BY_FORMULAS,
    "axes_that_turn_with_the_body": AXES_THAT_TURN_WITH_THE_BODY,
    "turned_with_the_body": TURNED_WITH_THE_BODY,
    "point_by_inputs": POINT_BY_INPUTS,
    "force": FORCE,
    "top_by_speeds": TEXTS["long_heavy_top"],
    "propeller_3_blade": EVERY["propeller_3_blade"],
}


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(SHORT, 4))
def test_nothing_in_a_short_scene_is_ignored(name: str) -> None:
    assert ignored(SHORT[name], name) == []


@pytest.mark.long
@pytest.mark.whole
def test_a_force_that_is_left_out_is_noticed(monkeypatch: Any) -> None:
    before = loads._force
    monkeypatch.setattr(
        loads, "_force", lambda *of: (replace(w, force=0 * w.force) for w in before(*of))
    )
    assert {"known.force.0", "known.force.1", "known.force.2"} <= set(ignored(FORCE))


@pytest.mark.long
def test_an_inertia_on_which_no_moment_acts_does_not_matter() -> None:
    assert ignored(UNTURNED) == []


@pytest.mark.long
def test_an_inertia_that_is_left_out_is_noticed(monkeypatch: Any) -> None:
    monkeypatch.setattr(bodies, "inertia_tensor", lambda *_: eye(3))
    assert "body.moment" in ignored(TURNED)


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(sorted(TEXTS), 20))
def test_nothing_in_a_scene_is_left_unread(name: str) -> None:
    assert unread(TEXTS[name], name) == []


def test_an_entry_that_is_left_unread_is_noticed(monkeypatch: Any) -> None:
    def deaf(text: str, name: str) -> Any:
        return replace(parse_scene(text, name), loads=(), inverse=None)

    assert unread(FORCE) == []
    monkeypatch.setattr(mutated, "parse_scene", deaf)
    assert {"known.force.0", "known.force.2", "known.moment.1"} <= set(unread(FORCE))


@pytest.mark.long
@pytest.mark.whole
@pytest.mark.parametrize("name", EVERY)
def test_nothing_in_a_scene_that_is_quickly_made_is_ignored(name: str) -> None:
    assert ignored(EVERY[name], name) == []


@pytest.mark.long
@pytest.mark.whole
@pytest.mark.parametrize("text", BLOCKS)
def test_nothing_in_an_example_of_the_pages_is_ignored(text: str) -> None:
    assert ignored(text) == []
