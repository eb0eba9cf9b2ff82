"""What follows by constraints in small motion is chosen where the scene names nothing."""

from pathlib import Path

import numpy as np
import pytest
from flint import arb

from derive.check.particles import clouds
from derive.library.library import Library, library
from derive.mechanics import follows
from derive.mechanics.mechanism import mechanism
from derive.program.precision import F64
from derive.scene import SceneError, parse_scene
from derive.verify.measure import results
from derive.verify.sample import samples

SCENES = Path(__file__).parent / "scenes"
FOUR = (SCENES / "four_bar_closed.toml").read_text(encoding="utf-8")
BICYCLE = (SCENES / "bicycle.toml").read_text(encoding="utf-8")
SMALL = FOUR.replace('"accelerations", "energy", "d_x"', '"linearised"')
CRANK = """
wanted = ["linearised"]
parameters.r = { unit = "m", range = [0.5, 1] }
parameters.m = { unit = "kg", range = [1, 2] }
parameters.g = { unit = "m/s^2", value = 9.81 }
coordinates.x = { unit = "m", range = [-2, 2] }
coordinates.y = { unit = "m", range = [-2, 2] }
parameters.turn = { unit = "rad", range = [RANGE] }
frames.bead.origin = ["x", "y", "0"]
bodies.bead = { frame = "bead", shape = "point", mass = "m" }
loads.weight = { gravity = ["-g*sin(turn)", "g*cos(turn)", "0"] }
loads.plane = { on = "bead", force = ["0", "0", "?N"] }
constraints.ring = { zero = "x^2 + y^2 - r^2" }
linearised = { x = "-r*sin(turn)", y = "r*cos(turn)" }
"""


def following(own: Library) -> list[str]:
    scene = own.scene
    return [m.name for m in (*scene.coordinates, *scene.speeds) if m.dependent]


@pytest.mark.long
def test_four_bars_are_small_in_one_angle_as_a_pendulum() -> None:
    own = library(parse_scene(SMALL, "four_bars"))
    assert following(own) == ["q_2", "q_3"]
    assert any("'q_2', 'q_3' follow by the constraints" in says for says in own.mechanism.said)
    at = {"m": arb(1.5), "l": arb(0.75), "g": arb("9.8")}
    found = results(own, own["linearised"], at)
    squared = float(found["stiffness_matrix_1_1"] / found["mass_matrix_1_1"])
    assert squared == pytest.approx(6 / 5 * 9.8 / 0.75, rel=1e-14)
    each = samples(own.mechanism, F64, 1, 0).each
    assert [v.outcome for v in clouds(own, each)] == ["holds"]


@pytest.mark.long
def test_the_bicycle_is_small_in_lean_and_steer_whoever_chooses() -> None:
    lines = [one for one in BICYCLE.splitlines() if not one.startswith("dependent")]
    own = mechanism(parse_scene("\n".join(lines), "bicycle"))
    assert [m.name for m in (*own.scene.coordinates, *own.scene.speeds) if m.dependent] == [
        "psi", "theta", "W_F"
    ]  # fmt: skip


@pytest.mark.parametrize(("range_", "name"), [("-0.3, 0.3", "y"), ("1.3, 1.8", "x")])
def test_what_keeps_its_pivot_follows(range_: str, name: str) -> None:
    own = library(parse_scene(CRANK.replace("RANGE", range_), "ring"))
    assert following(own) == [name]
    at = {"r": arb(0.75), "m": arb(1.5), "turn": arb(float(range_.split(",")[0]))}
    found = results(own, own["linearised"], at)
    squared = float(found["stiffness_matrix_1_1"] / found["mass_matrix_1_1"])
    assert squared == pytest.approx(9.81 / 0.75, rel=1e-12)


def test_where_every_choice_fails_the_sentence_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(follows, "_about", lambda *_: np.zeros((1, 7)))
    with pytest.raises(SceneError, match=r"no choice .* does in all of the given motions; for 'x'"):
        library(parse_scene(CRANK.replace("RANGE", "-0.3, 0.3"), "ring"))
