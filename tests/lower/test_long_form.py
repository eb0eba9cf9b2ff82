"""Scenes of one body, written with frames, bodies and loads, beside the same body in short form.

The two are read into one kind of scene, but name their frames and quantities differently; what a
call costs must not tell them apart.
"""

import re
from pathlib import Path

import pytest

from derive.library.function import arranged, function, graphed
from derive.mechanics.mechanism import mechanism
from derive.scene import Scene, load, parse_scene
from derive.scene.wanted import without_ending

LONG = Path(__file__).parent.parent / "data" / "long_form"
CATALOGUE = Path(__file__).parent.parent.parent / "derive" / "scene" / "catalogue"
ROWS = (
    ("free_body_principal", "acceleration"),
    ("free_body_principal", "acceleration_jacobian"),
    ("free_body", "acceleration"),
    ("free_body", "angular_momentum"),
    ("free_body", "kinetic_energy"),
    ("heavy_top", "state_rate"),
    ("gyrostat", "acceleration"),
    ("rigid_body", "kinetic_energy"),
    ("rigid_body", "state_rate"),
    ("rigid_body", "state_rate_jacobian"),
    ("unsymmetrical_rotor_in_carrier_axes", "moment"),
    ("unsymmetrical_rotor_in_carrier_axes", "moment_jacobian"),
    ("rotor_on_turning_axes", "moment"),
    ("rotor_on_turning_axes", "angular_momentum"),
    ("rotor_on_turning_axes", "kinetic_energy"),
)


def in_short(name: str) -> Scene:
    """Return the body's scene, that of the gyrostat without an attitude."""
    text = (CATALOGUE / f"{name}.toml").read_text(encoding="utf-8")
    if name == "gyrostat":
        text = re.sub(r"^(wanted|psi|theta|phi|turned) .*\n|^\[coordinates\]", "", text, flags=re.M)
        text = 'wanted = ["acceleration"]\n' + text
    return parse_scene(text, name)


def operations(scene: Scene, name: str) -> int:
    """Return how many + - * / a function of a scene takes."""
    terms = graphed(mechanism(scene))
    return function(terms, arranged(terms, without_ending(name)), name).flops()


BODY = {("unsymmetrical_rotor_in_carrier_axes", "moment"): 20}
"""What the short form took where it takes less by now."""
AT_ONCE = ("free_body_principal", "free_body", "rotor_on_turning_axes", "heavy_top")


@pytest.mark.parametrize(
    ("scene", "name"),
    [pytest.param(*row, marks=() if row[0] in AT_ONCE else pytest.mark.long) for row in ROWS],
    ids=str,
)
def test_a_body_in_long_form_takes_no_more_operations_than_in_short(scene: str, name: str) -> None:
    long = operations(load(LONG / f"{scene}.toml"), name)
    assert 0 < long <= BODY.get((scene, name), operations(in_short(scene), name))


WRITTEN_OUT = {
    "free_body_principal": {"acceleration": 12, "acceleration_jacobian": 15, "moment": 12,
                            "angular_momentum": 3, "kinetic_energy": 8},
    "free_body": {"acceleration": 40, "acceleration_jacobian": 81, "moment": 40,
                  "angular_momentum": 15, "kinetic_energy": 14},
    "gyrostat": {"state_rate": 64, "state_rate_jacobian": 167, "kinetic_energy": 28,
                 "angular_momentum": 21},
    "heavy_body": {"state_rate": 39, "state_rate_jacobian": 54, "kinetic_energy": 8},
    "heavy_top": {"state_rate": 9, "state_rate_jacobian": 22, "kinetic_energy": 7,
                  "angular_momentum": 3},
    "rigid_body": {"state_rate": 96, "state_rate_jacobian": 171, "kinetic_energy": 21,
                   "moment": 40},
    "rotor_on_turning_axes": {"moment": 11, "angular_momentum": 4, "kinetic_energy": 8},
    "satellite": {"state_rate": 35, "state_rate_jacobian": 42},
    "tumbling_disc": {"state_rate": 26},
    "unsymmetrical_rotor_in_carrier_axes": {"moment": 19, "moment_jacobian": 40,
                                            "angular_momentum": 7, "kinetic_energy": 9},
}  # fmt: skip
SLOW = ("free_body", "gyrostat", "heavy_body", "rigid_body", "satellite")


@pytest.mark.long
@pytest.mark.parametrize(
    "scene", [pytest.param(n, marks=pytest.mark.long) if n in SLOW else n for n in WRITTEN_OUT]
)
def test_a_body_written_out_takes_as_many_operations_as_before(scene: str) -> None:
    wanted = WRITTEN_OUT[scene]
    assert {n: operations(load(scene), n) for n in wanted} == wanted
