"""pi is a number in every formula of a scene: in bodies, rates, axes, moments and places."""

import pytest

from derive.check import proof
from derive.library.library import library
from derive.scene import parse_scene

ONE_BODY = """
wanted = ["moment", "kinetic_energy", "angular_momentum"]
[parameters]
a = { unit = "kg m^2", range = [1, 2] }
w = { unit = "rad/s", range = [1, 2] }
[coordinates]
g = { unit = "rad", range = [-3, 3], motion = "prescribed", rate = "pi*w" }
[axes]
angular_velocity = ["0", "w/pi", "w*sin(pi/3)"]
[body]
kind = "principal"
moments = ["a", "2*a", "a*pi/2"]
turned = ["x g"]
"""
CYLINDER = """
wanted = ["acceleration", "kinetic_energy"]
[parameters]
h = { unit = "m", range = [0.1, 0.2] }
r = { unit = "m", range = [0.1, 0.2] }
d = { unit = "kg/m^3", range = [1000, 2000] }
[body]
shape = "cylinder"
axis = "z"
radius = "r"
length = "h"
mass = "pi*r^2*h*d"
"""
MACHINE = """
wanted = ["accelerations", "energy"]
[parameters]
r = { unit = "m", range = [0.1, 0.2] }
d = { unit = "kg/m^2", range = [1, 2] }
f = { unit = "m/s^2", range = [1, 2] }
[coordinates]
t = { unit = "rad", range = [-1, 1] }
[frames.arm]
turned = ["z t + pi/6"]
[bodies.bob]
frame = "arm"
shape = "disc"
axis = "z"
radius = "r"
mass = "pi*r^2*d"
centre = ["r*pi", "0", "0"]
[loads.weight]
gravity = ["0", "-pi*f", "0"]
[loads.pin]
on = "bob"
force = "?pin"
couple = ["?c", "?e", "0"]
"""


@pytest.mark.parametrize("text", [ONE_BODY, CYLINDER, MACHINE])
def test_a_scene_with_pi_is_proved(text: str) -> None:
    assert proof(library(parse_scene(text, "circle"))).outcome == "holds"
