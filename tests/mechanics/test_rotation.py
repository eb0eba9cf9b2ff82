"""What turns freely is a frame with all that is fixed in it: its tensor and moment by hand."""

import pytest
from sympy import Matrix, Symbol, eye, sympify

from derive.mechanics.mechanism import mechanism
from derive.mechanics.rotation import FreeRotation
from derive.scene import parse_scene

BODY = """
wanted = ["state_rate"]
[parameters]
m = { unit = "kg", range = [1, 2] }
A = { unit = "kg m^2", range = [1, 2] }
B = { unit = "kg m^2", range = [1, 2] }
C = { unit = "kg m^2", range = [1, 2] }
l = { unit = "m", range = [1, 2] }
g = { unit = "m/s^2", range = [9, 10] }
[speeds]
W = { components = ["x", "y", "z"], unit = "rad/s", range = [-1, 1] }
[inputs]
M = { components = ["x", "y", "z"], unit = "N m", range = [-1, 1] }
[frames.B]
attitude = "quaternion"
angular_velocity = ["W_x", "W_y", "W_z"]
velocity = ["0", "0", "0"]
[bodies.body]
frame = "B"
kind = "principal"
moments = ["A", "B", "C"]
mass = "m"
centre = ["0", "0", "l"]
[loads.drive]
on = "body"
couple = ["M_x", "M_y", "M_z"]
[loads.pivot]
on = "body"
at = ["0", "0", "0"]
force = "?pivot"
"""
WEIGHT = """
[loads.weight]
on = ["body"]
gravity = ["0", "0", "-g"]
"""
BLADE = """
[frames.blade]
parent = "B"
origin = ["l", "0", "0"]
turned = ["x pi/2"]
[bodies.blade]
frame = "blade"
kind = "principal"
moments = ["A", "B", "C"]
mass = "m"
"""
WHEEL = """
[bodies.wheel]
frame = "B"
kind = "axisymmetric"
axis = "z"
axial = "C"
transverse = "A"
mass = "m"
spin = "W_x"
[loads.drive]
"""


def rotation(text: str) -> FreeRotation | None:
    machine = parse_scene(text, "turning")
    known = mechanism(machine)
    found = known.rotation()
    if found is None:
        return None
    names = {s: Symbol(c) for c, s in known.vocabulary.symbols.items()}
    return FreeRotation(
        found.frame, found.attitude, found.omega,
        found.tensor.xreplace(names), found.moment.xreplace(names),
    )  # fmt: skip


def diagonal(*moments: str) -> Matrix:
    return Matrix(3, 3, lambda i, k: sympify(moments[i]) if i == k else 0)


def test_the_tensor_is_about_the_point_at_rest_and_reactions_there_have_no_moment() -> None:
    found = rotation(BODY)
    assert found is not None
    assert found.tensor == diagonal("A + l**2*m", "B + l**2*m", "C")
    assert list(found.moment) == [Symbol(f"M_{a}") for a in "xyz"]
    assert (found.attitude.name, found.omega.name) == ("attitude_B", "W")


def test_a_weight_has_a_moment_of_the_attitude() -> None:
    found = rotation(BODY + WEIGHT)
    assert found is not None
    upright = {Symbol(f"attitude_B_{p}"): int(p == "w") for p in "wxyz"}
    lying = {Symbol(f"attitude_B_{p}"): sympify("sqrt(2)/2") * int(p in "wx") for p in "wxyz"}
    assert list(found.moment.subs(upright)) == [Symbol(f"M_{a}") for a in "xyz"]
    # turned by a right angle about x, the body's z lies along -y, and -g z along its own -y
    tipping = found.moment.subs(lying) - found.moment.subs(upright)
    assert list(tipping) == [sympify("g*l*m"), 0, 0]


def test_a_blade_fixed_in_the_frame_adds_its_tensor_turned_and_moved() -> None:
    found, alone = rotation(BODY + BLADE), rotation(BODY)
    assert found is not None
    assert alone is not None
    blade = diagonal("A", "C + l**2*m", "B + l**2*m")  # turned about x: y and z trade places
    assert (found.tensor - alone.tensor - blade).expand() == 0 * eye(3)


@pytest.mark.parametrize(
    ("why", "old", "new"),
    [
        ("the wheel spins", "[loads.drive]", WHEEL),
        ("the origin moves", 'velocity = ["0", "0", "0"]', 'velocity = ["l*W_x", "0", "0"]'),
        ("omega is no vector of the state", '["W_x", "W_y", "W_z"]', '["W_y", "W_x", "W_z"]'),
        ("the moment is to be found", '"M_z"]', '"?k"]'),
        ("the mass is not known", 'mass = "m"\n', ""),
    ],
)
def test_a_rotation_that_is_not_free_is_none(why: str, old: str, new: str) -> None:
    assert old in BODY, why
    assert rotation(BODY.replace(old, new)) is None, why
