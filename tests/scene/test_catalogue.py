"""The scenes that ship: all of them load without a doubt, and say what their name says."""

from fractions import Fraction
from typing import Any

import pytest

from derive.mechanics.words import words
from derive.scene import CATALOGUE, SceneError, Turning, catalogue, load, of_the_scene
from derive.scene.formula import ZERO, symbol
from derive.scene.grammar import parse
from derive.scene.names import distinct
from tests.made import SHORT, scene_of, short_of

NAMES = (
    "free_body",
    "free_body_principal",
    "gyrostat",
    "heavy_top",
    "rigid_body",
    "rotor_on_turning_axes",
    "unsymmetrical_rotor_in_carrier_axes",
)


@pytest.mark.parametrize("name", catalogue())
def test_every_scene_of_the_catalogue_loads_without_a_warning(name: str) -> None:
    scene = load(name)
    assert scene.name == name
    assert scene.warnings == ()
    assert scene.text == of_the_scene((CATALOGUE / f"{name}.toml").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", catalogue())
def test_every_scalar_of_the_catalogue_says_what_it_means(name: str) -> None:
    scene = short_of(name) if name in SHORT else load(name)
    scalars: tuple[Any, ...] = (*scene.parameters, *scene.coordinates, *scene.speeds)
    assert load(name).title != name
    assert all(scalar.meaning for scalar in scalars)


def test_the_catalogue_is_sorted_and_holds_the_first_seven() -> None:
    assert catalogue() == tuple(sorted(catalogue()))
    assert set(NAMES) <= set(catalogue())


def wanted(name: str) -> tuple[str, ...]:
    return load(name).wanted


def test_the_free_body_has_a_full_tensor_in_body_axes() -> None:
    scene = short_of("free_body")
    names = ("I_xx", "I_yy", "I_zz", "I_xy", "I_xz", "I_yz")
    assert scene.body.inertia == tuple(symbol(name) for name in names)
    assert scene.axes.fixed_in_body
    assert not scene.axes.quaternion
    assert scene.point.kind == "centre_of_mass"
    assert {"acceleration", "acceleration_jacobian", "angular_momentum_rate"} <= {
        *wanted("free_body")
    }


def test_the_heavy_top_turns_in_axes_that_do_not_spin_with_it() -> None:
    scene = short_of("heavy_top")
    assert scene.axes.turned == (Turning("z", parse("psi")), Turning("x", parse("theta")))
    assert scene.body.turned == (Turning("z", parse("phi")),)
    assert not scene.axes.fixed_in_body
    assert scene.body.inertia[:3] == (symbol("A"), symbol("A"), symbol("C"))
    assert scene.known["moment"].formulas == (parse("m*g*l*sin(theta)"), ZERO, ZERO)


def test_the_gyrostat_has_a_wheel_along_each_axis_and_nine_states() -> None:
    scene = short_of("gyrostat")
    assert [wheel.axis.index(parse("1")) for wheel in scene.wheels] == [0, 1, 2]
    assert [wheel.speed.name for wheel in scene.wheels] == ["s_1", "s_2", "s_3"]
    assert [wheel.torque.name for wheel in scene.wheels] == ["u_1", "u_2", "u_3"]
    assert len(scene.coordinates) + 3 + len(scene.wheels) == 9
    assert scene.axes.fixed_in_body


def test_the_rigid_body_has_a_position_and_a_quaternion() -> None:
    scene = short_of("rigid_body")
    assert scene.axes.quaternion
    assert scene.position is not None
    assert scene.velocity is not None
    assert scene.body.mass == symbol("m")


def test_the_rotor_turns_with_given_speeds_that_all_have_rates() -> None:
    scene = short_of("rotor_on_turning_axes")
    rates = [speed.rate.name for speed in scene.speeds if speed.rate]
    assert rates == ["W_x_dot", "W_y_dot", "W_z_dot", "p_dot"]
    assert scene.body.spin == symbol("p")
    assert scene.body.axis == "x"


def test_the_unsymmetrical_rotor_turns_through_a_prescribed_angle() -> None:
    scene = short_of("unsymmetrical_rotor_in_carrier_axes")
    gamma = scene.coordinates[0]
    assert gamma.free is False
    assert gamma.rate is not None
    assert gamma.acceleration is not None
    assert (gamma.rate.name, gamma.acceleration.name) == ("gamma_dot", "gamma_ddot")
    assert scene.axes.angular_velocity == (ZERO, ZERO, symbol("W"))
    assert scene.body.turned == (Turning("x", parse("gamma")),)


def test_numbers_of_a_file_are_exact() -> None:
    top = short_of("heavy_top")
    assert top.parameters[0].low == Fraction(1, 1000)
    assert top.coordinates[0].high == Fraction(314, 100)


@pytest.mark.parametrize("name", SHORT)
def test_no_name_of_a_user_can_meet_a_name_of_the_emitted_code(name: str) -> None:
    """Every quantity that is not the user's own must be refused as the name of a parameter."""
    scene, spoken = short_of(name), words(scene_of(name)).spoken
    entries: tuple[Any, ...] = (*scene.parameters, *scene.coordinates, *scene.speeds)
    own = {entry.name for entry in entries}
    names = {part for q in spoken.every() for part in (q.name, *q.components)} - own
    derived = {f"{entry}_{dots}" for entry in own for dots in ("dot", "ddot")}
    wheels = {f"{letter}_{wheel.name}" for wheel in scene.wheels for letter in "su"}
    wheels |= {f"s_{wheel.name}_dot" for wheel in scene.wheels}
    for part in sorted(names - derived - wheels):
        with pytest.raises(SceneError, match="taken"):
            distinct([(part, f"parameter '{part}'")])
