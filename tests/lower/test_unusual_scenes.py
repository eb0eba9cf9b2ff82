"""Scenes beyond the catalogue are arranged and proved too: any frames, any tensor, any point."""

import pytest

from derive.library.library import library
from derive.scene import parse_scene
from derive.verify.prove import prove

pytestmark = pytest.mark.long

HEAD = """
title = "Unusual"
wanted = [{wanted}]
[parameters]
A = {{ unit = "kg m^2", range = [1.0, 1.2], meaning = "moment" }}
B = {{ unit = "kg m^2", range = [1.3, 1.5], meaning = "moment" }}
C = {{ unit = "kg m^2", range = [1.6, 1.8], meaning = "moment" }}
D = {{ unit = "kg m^2", range = [-0.1, 0.1], meaning = "product" }}
m = {{ unit = "kg", range = [1, 2], meaning = "mass" }}
h = {{ unit = "m", range = [0.1, 0.2], meaning = "height" }}
"""
ANGLES = """
[coordinates]
psi = { unit = "rad", range = [-3, 3], meaning = "first" }
theta = { unit = "rad", range = [0.2, 1.3], meaning = "second" }
phi = { unit = "rad", range = [-3, 3], meaning = "third" }
"""
PRESCRIBED = """
[coordinates.psi]
unit = "rad"
range = [-3, 3]
meaning = "first"
motion = "prescribed"
rate = { range = [-1, 1] }
acceleration = { range = [-1, 1] }
"""
GENERAL = '\n[body]\nkind = "general"\nmoments = ["A", "B", "C"]\nproducts = ["D", "0", "D"]\n'
AXIAL = '\n[body]\nkind = "axisymmetric"\naxis = "z"\naxial = "C"\ntransverse = "A"\n'
FIXED = '\n[point]\nkind = "fixed"\n'
FORWARD = '"state_rate", "state_rate_jacobian", "moment", "kinetic_energy", "angular_momentum_rate"'
WHEEL = """
[[wheels]]
name = "1"
axis = ["3/5", "4/5", "0"]
axial = "0.1"
speed_range = [-100, 100]
torque_range = [-1, 1]
"""

SCENES = {
    "body axes by three turns": (
        FORWARD,
        ANGLES
        + '[axes]\nturned = ["z psi", "x theta", "z phi"]\nfixed_in = "body"\n'
        + GENERAL
        + FIXED,
    ),
    "axes by one turn, the body by two": (
        FORWARD.replace('"state_rate_jacobian", ', ""),
        ANGLES + '[axes]\nturned = ["z psi"]\n' + AXIAL + 'turned = ["x theta", "z phi"]\n' + FIXED,
    ),
    "a tensor that varies in axes that do not spin": (
        FORWARD,
        ANGLES
        + '[axes]\nturned = ["z psi", "x theta"]\n'
        + GENERAL
        + 'turned = ["z phi"]\n'
        + FIXED,
    ),
    "a moving point": (
        '"acceleration", "acceleration_jacobian", "moment"',
        GENERAL + 'mass = "m"\ncentre = ["0", "h", "h"]\n'
        '[point]\nkind = "moving"\nacceleration = { range = [-5, 5] }\n',
    ),
    "position with Euler angles": (
        '"state_rate", "state_rate_jacobian", "kinetic_energy"',
        ANGLES
        + '[axes]\nturned = ["z psi", "y theta", "x phi"]\nfixed_in = "body"\n'
        + GENERAL
        + 'mass = "m"\n[position]\nposition = { range = [-9, 9] }\n'
        + "velocity = { range = [-5, 5] }\n",
    ),
    "prescribed turns": (
        '"moment", "moment_jacobian", "kinetic_energy", "angular_momentum_rate"',
        PRESCRIBED + '[axes]\nturned = ["z psi"]\nfixed_in = "body"\n' + GENERAL + FIXED,
    ),
    "a wheel on a slanting axis": (
        FORWARD,
        '[axes]\nattitude = "quaternion"\n' + GENERAL + WHEEL,
    ),
    "a sphere with a quaternion": (
        FORWARD,
        '[axes]\nattitude = "quaternion"\n[body]\nkind = "spherical"\nmoment = "A"\n',
    ),
}


def text_of(name):
    """Return the file of a scene."""
    wanted, body = SCENES[name]
    return HEAD.format(wanted=wanted) + body


@pytest.mark.parametrize("name", SCENES)
def test_an_unusual_scene_is_proved(name):
    made = library(parse_scene(text_of(name), "unusual"))
    prove(made)
    assert len(made.functions) == len(made.scene.wanted)
