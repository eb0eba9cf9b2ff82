"""Points that meet on some axes alone: what holds them has no power, whatever these turn with."""

from pathlib import Path

import pytest
from flint import arb

from derive.check.energy import energy_balance
from derive.check.particles import clouds
from derive.library.library import Library, library
from derive.mechanics import meeting
from derive.program.precision import F64
from derive.scene import SceneError, parse_scene
from derive.scene.machine import INERTIAL
from derive.verify.measure import results
from derive.verify.sample import samples

LEVER = """
wanted = ["accelerations"WANTED]
parameters.m = { unit = "kg", range = [1, 2] }
parameters.r = { unit = "m", value = 0.25 }
parameters.d = { unit = "m", value = 1 }
coordinates.a = { unit = "rad", range = [-0.5, 0.5] }
coordinates.b = { unit = "rad", range = [-0.5, 0.5] }
frames.crank.turned = ["z a"]
frames.slot = { origin = ["d", "0", "0"], turned = ["z b"] }
bodies.crank = { frame = "crank", shape = "rod", axis = "x", mass = "m", length = "r", centre = ["r/2", "0", "0"] }
bodies.slot = { frame = "slot", shape = "rod", axis = "x", mass = "m", length = "d", centre = ["-d/2", "0", "0"] }
loads.weight = { gravity = ["0", "-9.81", "0"] }
loads.p = { on = "crank", force = "?p", couple = ["?p_1", "?p_2", "0"] }
loads.q = { on = "slot", force = "?q", couple = ["?q_1", "?q_2", "0"] }
"""  # noqa: E501
PIN = 'constraints.c = { on = "crank", at = ["r", "0", "0"], against = "slot", along = "slot", '
PIN += 'axes = ["y"] }'
OTHER_WAY = 'constraints.c = { on = "slot", against = "crank", to = ["r", "0", "0"], '
OTHER_WAY += 'along = "slot", axes = ["y"] }'
FORMULA = 'constraints.c = { zero = "r*sin(a - b) + d*sin(b)" }'
THIRD = """
coordinates.e = { unit = "rad", range = [-0.5, 0.5] }
frames.plate.turned = ["z e"]
bodies.plate = { frame = "plate", shape = "disc", axis = "z", mass = "m", radius = "r" }
loads.o = { on = "plate", force = "?o", couple = ["?o_1", "?o_2", "0"] }
"""
ON_PLATE = PIN.replace('along = "slot"', 'along = "plate"')
BY_PLATE = 'constraints.c = { zero = "r*sin(a - e) + d*sin(e)" }'
STATES = {"m": 1.5, "a": 0.4, "a_dot": 2.0, "b": 0.3, "b_dot": -1.0, "e": -0.2, "e_dot": 0.5}


def made(text: str, wanted: str = "") -> Library:
    return library(parse_scene(text.replace("WANTED", wanted), "lever"))


def accelerated(text: str) -> list[float]:
    own = made(text)
    names = [c for q in own.vocabulary.given() for c in q.components]
    at = {c: arb(STATES.get(c, 0)) for c in names}
    return [float(x) for x in results(own, own["accelerations"], at).values()]


@pytest.mark.parametrize(
    ("points", "formula"),
    [
        (PIN, FORMULA),
        pytest.param(OTHER_WAY, FORMULA, marks=pytest.mark.long),
        pytest.param(THIRD + ON_PLATE, THIRD + BY_PLATE, marks=pytest.mark.long),
    ],
    ids=["along what it is against", "along what it is on", "along a third"],
)
def test_a_pin_in_a_slot_is_its_formula(points: str, formula: str) -> None:
    assert accelerated(LEVER + points) == pytest.approx(accelerated(LEVER + formula), rel=1e-12)


def verdicts(own: Library) -> set[str]:
    each = samples(own.mechanism, F64, 1, 0).each
    return {v.outcome for v in (*clouds(own, each), *energy_balance(own, each))}


@pytest.mark.long
def test_the_force_of_a_slot_keeps_the_energy_of_a_cloud() -> None:
    assert verdicts(made(LEVER + PIN, ', "energy", "c_y"')) == {"holds"}


@pytest.mark.long
def test_a_slot_whose_axes_turn_with_nothing_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(meeting, "body_turning_with", lambda *_: INERTIAL)
    assert "FAILS" in verdicts(made(LEVER + PIN))


def test_axes_that_turn_with_no_body_are_refused() -> None:
    third = THIRD.partition("bodies")[0]
    with pytest.raises(SceneError, match="constraint 'c': 'plate' turns with no body, which what"):
        made(LEVER + third + ON_PLATE)


@pytest.mark.long
def test_a_load_of_the_scene_that_closes_a_loop_is_solved_as_ours() -> None:
    path = Path(__file__).parents[1] / "data" / "trials" / "four_bar.toml"
    close = ('constraints.close = { load = "d", on = "bar", at = ["l", "0", "0"], '
             'against = "right", to = ["0", "0", "-l"], axes = ["x", "z"] }\n')  # fmt: skip
    own = made(close + path.read_text(encoding="utf-8"))
    assert own["accelerations"].flops() == 96
    assert "absolute angles, what follows put in" in own.ways["accelerations"]
