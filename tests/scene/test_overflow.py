"""A formula whose value no double holds is told apart from one that has no value."""

import pytest

from derive.scene import SceneError, parse_scene

SCENE = """
wanted = ["kinetic_energy"]
parameters.l = { unit = "1", range = [1e30, 2e30] }
parameters.m = { unit = "kg", value = 1 }
formulas = { a = "l^4", b = "m*a^4" }
bodies.rod = { frame = "rod", shape = "rod", axis = "z", mass = "b", length = "1" }
frames.rod.turned = ["x q"]
coordinates.q = { unit = "rad", range = [-1, 1] }
loads.hinge = { on = "rod", force = "?f", couple = ["0", "?c", "?d"] }
"""


def test_a_number_beyond_doubles_is_told_with_its_size() -> None:
    with pytest.raises(
        SceneError, match=r"'b' is 6.57e\+482, beyond what a double holds, at m = 1, l = 1.5e"
    ):
        parse_scene(SCENE, "large")
