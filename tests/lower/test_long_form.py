"""Scenes of one body, written with frames, bodies and loads, beside the same body in short form.

The two are read, stated and arranged by roads of their own; what a call costs must not tell them
apart.
"""

import re
from pathlib import Path

import pytest

from derive.library.function import arranged, function, graphed
from derive.mechanics.mechanism import in_terms
from derive.scene import Machine, Scene, load, parse_scene
from derive.scene.wanted import base_of

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


def in_short(name: str) -> Scene | Machine:
    """Return the body's scene, that of the gyrostat without an attitude."""
    text = (CATALOGUE / f"{name}.toml").read_text(encoding="utf-8")
    if name == "gyrostat":
        text = re.sub(r"^(wanted|psi|theta|phi|turned) .*\n|^\[coordinates\]", "", text, flags=re.M)
        text = 'wanted = ["acceleration"]\n' + text
    return parse_scene(text, name)


def operations(scene: Scene | Machine, name: str) -> int:
    """Return how many + - * / a function of a scene takes."""
    terms = graphed(in_terms(scene))
    return function(terms, arranged(terms, base_of(name)), name).flops()


AT_ONCE = ("free_body_principal", "free_body", "rotor_on_turning_axes", "heavy_top")


@pytest.mark.parametrize(
    ("scene", "name"),
    [pytest.param(*row, marks=() if row[0] in AT_ONCE else pytest.mark.long) for row in ROWS],
    ids=str,
)
def test_a_body_in_long_form_takes_no_more_operations_than_in_short(scene: str, name: str) -> None:
    long = operations(load(LONG / f"{scene}.toml"), name)
    assert 0 < long <= operations(in_short(scene), name)
