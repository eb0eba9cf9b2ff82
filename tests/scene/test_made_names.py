"""No scalar of a scene has the name of what a wanted function gives by itself."""

import pytest

from derive.scene import SceneError, parse_scene
from derive.scene.results import FUNCTIONS

SCENE = """
wanted = [{wanted}]
[inputs]
{name} = {{ unit = "N/m", range = [1, 2] }}
[coordinates]
phi = {{ unit = "rad", range = [-1, 1] }}
[speeds]
w = {{ unit = "rad/s", range = [-1, 1], components = ["x", "y", "z"] }}
[frames.arm]
turned = ["y phi"]
[frames.hull]
angular_velocity = ["w_x", "w_y", "w_z"]
attitude = "quaternion"
[bodies]
bob = {{ frame = "arm", shape = "point", mass = 1, centre = ["0", "0", "-1"] }}
ball = {{ frame = "hull", shape = "sphere", mass = 1, radius = 1 }}
[loads]
pin = {{ on = "bob", force = "?pin", couple = ["?cx", "0", "?cz"] }}
cord = {{ on = "bob", at = ["0", "0", "-1"], to = ["2", "0", "0"], spring = "{name}" }}
"""
TAKEN = {
    '"state_rate"': ("phi_rate", "phi_dot_rate", "w_rate", "w_x_rate", "attitude_hull_w_rate"),
    '"step_rk4"': ("phi_next", "phi_dot_next", "w_next", "w_y_next", "attitude_hull_next"),
    '"linearised"': ("mass_matrix_1_1", "stiffness_matrix_2_1"),
    '"accelerations"': ("attitude_hull", "attitude_hull_z"),
}


RESULT = """
[results]
{name} = {{ formula = "2*phi", unit = "deg" }}
"""


def parsed(name: str, wanted: str, more: str = "") -> str:
    return parse_scene(SCENE.format(name=name, wanted=wanted) + more, "odd").name


@pytest.mark.parametrize("name", FUNCTIONS)
def test_what_the_code_calls_an_answer_is_declared_by_nobody(name: str) -> None:
    with pytest.raises(SceneError, match=f"'{name}' has a name that is taken: "):
        parsed(name, '"accelerations"')


@pytest.mark.parametrize(("name", "wanted"), [(n, w) for w, names in TAKEN.items() for n in names])
def test_what_a_function_gives_by_itself_is_declared_by_nobody_else(name: str, wanted: str) -> None:
    with pytest.raises(SceneError, match=f"'{name}' is declared twice: input '{name}' and "):
        parsed(name, wanted)


def test_a_result_has_no_name_of_a_rate_beside_it() -> None:
    more = RESULT.format(name="phi_rate")
    with pytest.raises(SceneError, match="'phi_rate' is declared twice: the result"):
        parsed("k", '"state_rate", "phi_rate"', more)


@pytest.mark.parametrize("both", ["pin, pin_x", "w_y_dot, w_dot", "accelerations, w_z_dot"])
def test_no_function_gives_an_unknown_in_a_vector_and_alone(both: str) -> None:
    with pytest.raises(SceneError, match=r"wanted 'both' gives '.*' twice: by '.*' and alone"):
        parsed("k", f'"both: {both}"')


def test_what_no_wanted_function_gives_may_be_a_name() -> None:
    for name in ("phi_rate", "w_next", "mass_matrix_1_1", "steady_1"):
        assert parsed(name, '"accelerations"') == "odd"
