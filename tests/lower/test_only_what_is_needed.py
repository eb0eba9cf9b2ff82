"""What vanishes in a scene leaves no trace in its programs."""

from derive.library.library import library
from derive.scene import parse_scene

SCENE = """
title = "A body made to order"
wanted = ["{wanted}"]
[parameters]
A = {{ unit = "kg m^2", range = [1, 2], meaning = "moment" }}
B = {{ unit = "kg m^2", range = [1, 2], meaning = "moment" }}
C = {{ unit = "kg m^2", range = [1, 2], meaning = "moment" }}
D = {{ unit = "kg m^2", range = [-0.1, 0.1], meaning = "product" }}
[body]
{body}
"""


def flops(body: str, wanted: str = "acceleration") -> int:
    text = SCENE.format(body=body, wanted=wanted)
    return library(parse_scene(text, "made"))[wanted].flops()


def general(products: str) -> str:
    return f'kind = "general"\nmoments = ["A", "B", "C"]\nproducts = {products}'


def test_a_body_costs_less_the_more_symmetry_it_has():
    full = flops(general('["D", "D", "D"]'))
    one_plane = flops(general('["D", "0", "0"]'))
    principal = flops('kind = "principal"\nmoments = ["A", "B", "C"]')
    axisymmetric = flops('kind = "axisymmetric"\naxis = "z"\naxial = "C"\ntransverse = "A"')
    spherical = flops('kind = "spherical"\nmoment = "A"')
    assert full > one_plane > principal > axisymmetric > spherical
    assert (principal, axisymmetric, spherical) == (12, 8, 3)


FREE = """
[axes]
fixed_in = "body"
attitude = "quaternion"
[known]
moment = ["0", "0", "0"]
"""


def test_equal_moments_make_a_principal_body_move_as_an_axisymmetric_or_spherical_one():
    """Whatever kind the scene calls it: also a box with a square face."""
    axisymmetric = 'kind = "axisymmetric"\naxis = "{}"\naxial = "C"\ntransverse = "A"'
    by_axis = {"x": '["C", "A", "A"]', "y": '["A", "C", "A"]', "z": '["A", "A", "C"]'}
    for step in ("flow_exact", "step_dmv", "step_split"):
        for axis, moments in by_axis.items():
            own = flops(f'kind = "principal"\nmoments = {moments}{FREE}', step)
            assert own == flops(axisymmetric.format(axis) + FREE, step)
        sphere = flops(f'kind = "principal"\nmoments = ["A", "A", "A"]{FREE}', step)
        assert sphere == flops(f'kind = "spherical"\nmoment = "A"{FREE}', step)
        whole = flops(f'kind = "principal"\nmoments = ["A", "B", "C"]{FREE}', step)
        assert sphere < own < whole / 2


def test_a_box_with_a_square_face_moves_as_an_axisymmetric_body():
    box = 'shape = "box"\nmass = 2\nlengths = {}' + FREE
    square, oblong = (flops(box.format(f"[1, {n}, 3]"), "flow_exact") for n in (1, 2))
    assert square < oblong / 5


def test_zero_products_make_a_general_body_a_principal_one():
    assert flops(general('["0", "0", "0"]')) == 12


def test_a_sphere_has_no_gyroscopic_moment():
    text = SCENE.format(body='kind = "spherical"\nmoment = "A"', wanted="acceleration")
    program = library(parse_scene(text, "made"))["acceleration"]
    assert [q.name for q in program.inputs] == ["constants", "moment"]


def test_a_steady_rate_has_no_derivative_in_the_signature():
    text = """
title = "Rotor on a ship that turns steadily"
wanted = ["moment"]
[parameters]
A = { unit = "kg m^2", range = [1, 2], meaning = "transverse" }
C = { unit = "kg m^2", range = [1, 2], meaning = "axial" }
[speeds]
W = { unit = "rad/s", range = [-1, 1], meaning = "turn rate", rate = 0 }
p = { unit = "rad/s", range = [1, 9], meaning = "spin", rate = 0 }
[axes]
angular_velocity = ["0", "0", "W"]
[body]
kind = "axisymmetric"
axis = "x"
axial = "C"
transverse = "A"
spin = "p"
"""
    made = library(parse_scene(text, "ship"))
    program = made["moment"]
    assert [q.name for q in program.inputs] == ["constants", "W", "p"]
    assert [*made.constants] == ["C"]
    assert program.flops() == 2


def test_a_body_of_numbers_needs_no_set_up():
    text = """
title = "A body of numbers"
wanted = ["acceleration", "kinetic_energy"]
[body]
kind = "general"
moments = ["1", "1.5", "1.75"]
products = ["0.125", "0", "0.1"]
"""
    made = library(parse_scene(text, "numbers"))
    assert made.constants == {}
    assert made["acceleration"].flops() <= 40
    assert [q.name for q in made["acceleration"].inputs] == ["omega", "moment"]
