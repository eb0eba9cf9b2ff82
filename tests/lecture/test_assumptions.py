"""What the final equations rest on, pinned: a new assumption must be meant, not slip in."""

import pytest

from derive.lecture.chapters import LECTURE

PARTICLES = {"newton", "third_law", "strong_third_law", "constant_mass"}
RIGID = {"rigid", "body_triad", "body_triad_is_orthonormal"}
AXES = {"axes_are_orthonormal", "rate_seen_from_N"}
GENERAL = PARTICLES | RIGID | AXES | {"reference_point"}
WHEEL = {
    *("wheel_on_carrier", "wheel_spins", "wheel_is_balanced", "wheel_is_axisymmetric"),
    "wheel_axis_is_unit",
}

RESTS_ON = {
    "mass_centre_motion": {"newton", "third_law", "constant_mass"},
    "moving_point": PARTICLES,
    "law_about_mass_centre": PARTICLES | {"A_is_G"},
    "angular_momentum": RIGID,
    "parallel_axes": set(),
    "change_of_axes": {"axes_are_orthonormal"},
    "transport_theorem": AXES,
    "inertia_rate_in_axes": RIGID | AXES | {"constant_mass"},
    "rate_in_axes": RIGID,
    "moving_point_form": PARTICLES | RIGID | AXES,
    "general_form": GENERAL,
    "body_axes_form": GENERAL | {"body_axes"},
    "euler": GENERAL | {"body_axes", "principal_axes"},
    "axisymmetric_equations": GENERAL | {"axisymmetric_body", "spins_in_axes", "axis_is_z"},
    "gyroscopic_moment": GENERAL
    | {"axisymmetric_body", "axis_is_unit", "spins_in_axes", "steady_precession"}
    | {"precession_across_axis"},
    "constant_tensor_suffices": RIGID
    | AXES
    | {"constant_mass", "principal_directions", "directions_are_perpendicular", "products_vanish"},
    "gyrostat_form": GENERAL | WHEEL | {"body_axes", "gyrostat_parts"},
    "wheel_equation": PARTICLES | AXES | WHEEL | {"body_axes"},
    "spherical_part": set(),
    "kinetic_energy_about_point": RIGID | {"A_is_fixed"},
    "koenig": RIGID | {"A_is_G", "constant_mass"},
    "power": PARTICLES | RIGID | {"A_is_fixed"},
    "rotation_of_vector": {"quaternion_of_axes"},
    "quaternion_rate_scalar": {"quaternion_of_axes", "unit_quaternion", "body_axes"},
    "quaternion_rate_vector": {"quaternion_of_axes", "unit_quaternion", "body_axes"},
    "angular_velocities_add": {
        *("axes_are_orthonormal", "composed_turns", "further_axes_are_right_handed"),
    },
    "euler_321_rates": {"euler_321", "body_axes", "no_gimbal_lock"},
    "axis_of_symmetry": {"rotational_symmetry", "sine_and_cosine", "turn_is_proper"},
    "mirror_plane": {"mirror_xy"},
    "two_mirror_planes": {"mirror_xy", "mirror_yz"},
}


@pytest.mark.parametrize("name", RESTS_ON)
def test_an_equation_rests_on_these_assumptions_and_no_others(name: str) -> None:
    assert LECTURE.assumptions(name) == tuple(sorted(RESTS_ON[name]))


def test_assumptions_are_assumed_and_nothing_else() -> None:
    kinds = {LECTURE[a].kind for name in RESTS_ON for a in LECTURE.assumptions(name)}
    assert kinds == {"assume"}


def test_a_step_that_is_not_there_is_asked_for_by_name() -> None:
    with pytest.raises(KeyError, match="the lecture has no step 'no_such_step'"):
        LECTURE.assumptions("no_such_step")
