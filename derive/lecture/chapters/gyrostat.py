"""The gyrostat: a rigid carrier with any number of balanced axisymmetric wheels on any axes.

It is the same sum over particles, split into the carrier and the wheels. One generic wheel is
enough, since the sum over the wheels is linear too. The axes are fixed in the carrier.
"""

# fmt: off
# ruff: noqa: I001

from derive.lecture.chapters.letters import (
    C, F_i, I, I_dot, M, a, d, dm, h, h_dot, l, omega, omega_dot, r, r_A, rho, rho_N_dot, s,
    s_dot, u,
)
from derive.lecture.chapters.rigid_body import HALF, inertia_of
from derive.lecture.step import Step
from derive.lecture.vectors import (
    IDENTITY, Expression, cross, dot, inertia, number, outer, reciprocal, scalar, total, vector,
    zero,
)

sigma, sigma_dot, sigma_N_dot = vector("sigma_i"), vector("sigma_i_dot"), vector("sigma_i_N_dot")
r_w, d_dot, d_N_dot, a_dot = vector("r_w"), vector("d_dot"), vector("d_N_dot"), vector("a_dot")
l_c, I_c, I_c_dot = vector("l_c"), inertia("I_c"), inertia("I_c_dot")
l_w, I_w, I_w_dot = vector("l_w"), inertia("I_w"), inertia("I_w_dot")
m_w, r_Gw, sigma_G = scalar("m_w"), vector("r_Gw"), vector("sigma_G")
r_w_N_ddot = vector("r_w_N_ddot")
l_s, l_s_N_dot, M_w = vector("l_s"), vector("l_s_N_dot"), vector("M_w")
h_w, T_w, K, K_c, K_w = vector("h_w"), scalar("T_w"), scalar("K"), scalar("K_c"), scalar("K_w")
spin_momentum = (C * s) * a
spin_energy = (C * s) * dot(a, omega) + HALF * (C * (s * s))
SPINNING = (
    "wheel_sums", "place_in_wheel", "wheel_centre_moves_with_carrier", "velocity_in_wheel",
    "wheel_is_balanced", "wheel_axis_is_principal",
)
D, A_w = inertia("D"), scalar("A_w")


def over_wheel(summand: Expression) -> Expression:
    """Return the sum over the particles of one wheel."""
    return total(summand, "wheel")


PARTS = (
    Step("wheel_centre", "The centre of a wheel lies at d from A.", "define", d, r_w - r_A),
    Step(
        "position_in_wheel",
        "A particle of a wheel lies at sigma from the wheel's centre.",
        "define", sigma, r - r_w,
    ),
    Step(
        "place_in_wheel",
        "So its place from A is the centre's and its own.",
        "deduce", rho, d + sigma,
        ("position_from_A", "wheel_centre", "position_in_wheel"),
    ),
    Step(
        "wheel_sums",
        "Each wheel gives its share to the angular momentum, the inertia tensor and the energy K.",
        "define", (l_w, I_w, K_w),
        (over_wheel(cross(rho, dm * rho_N_dot)), over_wheel(inertia_of(rho)),
         HALF * over_wheel(dm * dot(rho_N_dot, rho_N_dot))),
    ),
    Step(
        "carrier_sums",
        "So does the carrier.",
        "define", (l_c, I_c, K_c),
        (total(cross(rho, dm * rho_N_dot), "carrier"), total(inertia_of(rho), "carrier"),
         HALF * total(dm * dot(rho_N_dot, rho_N_dot), "carrier")),
    ),
    Step(
        "gyrostat_parts",
        "The particles of a gyrostat are those of its carrier and those of its wheels, and no "
        "others.",
        "assume", (l, I, K),
        (l_c + total(l_w, "wheels"), I_c + total(I_w, "wheels"), K_c + total(K_w, "wheels")),
    ),
)

WHEEL = (
    Step(
        "wheel_on_carrier",
        "A wheel's centre and its axis a are fixed in the carrier.",
        "assume", (d_dot, a_dot), (zero(3), zero(3)),
    ),
    Step(
        "wheel_centre_moves_with_carrier",
        "So the centre moves as a point of the carrier does.",
        "deduce", d_N_dot, cross(omega, d),
        ("transport_of_any_vector", "body_axes", "wheel_on_carrier"),
    ),
    Step(
        "wheel_spins",
        "Seen from the carrier the wheel turns about its axis, at the spin speed s.",
        "assume", sigma_dot, cross(s * a, sigma),
    ),
    Step(
        "velocity_in_wheel",
        "Seen from N it turns with omega + s a.",
        "deduce", sigma_N_dot, cross(omega + s * a, sigma),
        ("transport_of_any_vector", "body_axes", "wheel_spins"),
    ),
    Step("wheel_is_balanced", "The wheel's centre is its centre of mass.", "assume",
         over_wheel(dm * sigma), zero(3)),
    Step(
        "wheel_tensor",
        "D is the wheel's inertia tensor about its own centre.",
        "define", D, over_wheel(inertia_of(sigma)),
    ),
    Step(
        "wheel_is_axisymmetric",
        "The wheel is axisymmetric: C about its axis, the same moment across it.",
        "assume", D, A_w * IDENTITY + (C - A_w) * outer(a, a),
    ),
    Step("wheel_axis_is_unit", "The axis a is a unit vector.", "assume", dot(a, a), number(1)),
    Step(
        "wheel_axis_is_principal",
        "So its axis is principal, with the moment C.",
        "deduce", over_wheel(inertia_of(sigma)) @ a, C * a,
        ("wheel_tensor", "wheel_is_axisymmetric", "wheel_axis_is_unit"),
    ),
    Step(
        "axial_moment",
        "C can be read off along the axis.",
        "deduce", C, dot(a, D @ a),
        ("wheel_is_axisymmetric", "wheel_axis_is_unit"),
    ),
    Step(
        "axial_moment_is_constant",
        "The wheel's particles keep their distances from the axis, so C does not change.",
        "deduce", scalar("C_dot"), zero(),
        ("axial_moment", "wheel_tensor", "wheel_on_carrier", "wheel_spins", "constant_mass"),
    ),
    Step(
        "wheel_share",
        "Call h_w and T_w what a wheel gives beyond what it would give if it were locked.",
        "define", (h_w, T_w), (l_w - I_w @ omega, K_w - HALF * dot(omega, I_w @ omega)),
    ),
    Step(
        "wheel_momentum",
        "By spinning it gives C s along its axis to the momentum.",
        "deduce", h_w, spin_momentum,
        ("wheel_share", *SPINNING),
    ),
    Step(
        "wheel_energy",
        "And this to the energy.",
        "deduce", T_w, spin_energy,
        ("wheel_share", *SPINNING, "wheel_axis_is_unit"),
    ),
    Step(
        "momentum_of_wheel",
        "So this is the momentum of a wheel.",
        "deduce", l_w, I_w @ omega + spin_momentum,
        ("wheel_share", "wheel_momentum"),
    ),
    Step(
        "energy_of_wheel",
        "And this is its energy.",
        "deduce", K_w, HALF * dot(omega, I_w @ omega) + spin_energy,
        ("wheel_share", "wheel_energy"),
    ),
    Step(
        "wheel_tensor_is_constant",
        "Though its particles move, the spinning of an axisymmetric wheel leaves its tensor alone.",
        "deduce", I_w_dot, zero(3, 3),
        ("wheel_sums", "place_in_wheel", "wheel_on_carrier", "wheel_spins", "wheel_is_balanced",
         "constant_mass", "wheel_tensor", "wheel_is_axisymmetric"),
    ),
)

WHOLE = (
    Step(
        "momentum_of_carrier",
        "The carrier is a rigid body.",
        "deduce", l_c, I_c @ omega,
        ("carrier_sums", "velocity_of_particle"),
    ),
    Step(
        "carrier_tensor_is_constant",
        "In its own axes its tensor is constant.",
        "deduce", I_c_dot, zero(3, 3),
        ("carrier_sums", "particle_in_axes", "body_axes", "constant_mass"),
    ),
    Step(
        "relative_momentum",
        "h is what all the wheels add by spinning.",
        "define", h, total(spin_momentum, "wheels"),
    ),
    Step(
        "gyrostat_momentum",
        "So the whole has the momentum of a rigid body, wheels locked, and h.",
        "deduce", l, I @ omega + h,
        ("gyrostat_parts", "momentum_of_carrier", "momentum_of_wheel", "relative_momentum"),
    ),
    Step(
        "energy_of_carrier",
        "The energy of the carrier is that of a rigid body too.",
        "deduce", K_c, HALF * dot(omega, I_c @ omega),
        ("carrier_sums", "velocity_of_particle"),
    ),
    Step(
        "gyrostat_energy",
        "The energy of the whole relative to A, wheels locked, and what each wheel adds.",
        "deduce", K, HALF * dot(omega, I @ omega) + total(spin_energy, "wheels"),
        ("gyrostat_parts", "energy_of_carrier", "energy_of_wheel"),
    ),
    Step(
        "gyrostat_tensor_is_constant",
        "The tensor of the whole, wheels locked, is constant in the carrier.",
        "deduce", I_dot, zero(3, 3),
        ("gyrostat_parts", "carrier_tensor_is_constant", "wheel_tensor_is_constant"),
    ),
    Step(
        "gyrostat_form",
        "The moment on a gyrostat, in axes fixed in its carrier.",
        "deduce", M, I @ omega_dot + h_dot + cross(omega, I @ omega + h),
        ("moment_is_rate_of_angular_momentum", "transport_theorem", "body_axes",
         "gyrostat_momentum", "gyrostat_tensor_is_constant"),
    ),
    Step(
        "relative_momentum_rate",
        "In the carrier h changes only as the wheels spin up or down.",
        "deduce", h_dot, total((C * s_dot) * a, "wheels"),
        ("relative_momentum", "wheel_on_carrier", "axial_moment_is_constant"),
    ),
)

MOTOR = (
    Step(
        "moment_on_wheel",
        "About its centre a wheel has an angular momentum and feels a moment, as any body does.",
        "define", (l_s, M_w),
        (over_wheel(cross(sigma, dm * sigma_N_dot)), over_wheel(cross(sigma, F_i))),
    ),
    Step(
        "mass_centre_of_wheel",
        "It has a mass and a centre of mass, too.",
        "define", (m_w, r_Gw, sigma_G),
        (over_wheel(dm), reciprocal(m_w) * over_wheel(dm * r), r_Gw - r_w),
    ),
    Step(
        "wheel_obeys_the_same_law",
        "The law about a moving point was shown for any cloud of particles, so for the wheel's.",
        "deduce", M_w, l_s_N_dot + cross(sigma_G, m_w * r_w_N_ddot),
        ("moving_point", "position_in_wheel", "moment_on_wheel", "mass_centre_of_wheel"),
        (("body", "wheel"), ("r_A", "r_w"), ("a_A", "r_w_N_ddot"), ("r_G", "r_Gw"),
         ("rho_G", "sigma_G"), ("m", "m_w"), ("rho_i", "sigma_i"),
         ("rho_i_N_dot", "sigma_i_N_dot"), ("l", "l_s"), ("l_N_dot", "l_s_N_dot"), ("M", "M_w")),
    ),
    Step(
        "centre_of_wheel_is_its_mass_centre",
        "A balanced wheel has no arm between its centre and its centre of mass.",
        "deduce", sigma_G, zero(3),
        ("mass_centre_of_wheel", "position_in_wheel", "wheel_is_balanced"),
    ),
    Step(
        "law_of_wheel",
        "So the moment on a balanced wheel is the rate of its own momentum, however it is carried.",
        "deduce", M_w, l_s_N_dot,
        ("wheel_obeys_the_same_law", "centre_of_wheel_is_its_mass_centre"),
    ),
    Step(
        "motor_torque",
        "u is the part of that moment along the axis: the torque of the motor, friction included.",
        "define", u, dot(a, M_w),
    ),
    Step(
        "spin_momentum_of_wheel",
        "A wheel turning with omega + s a has this momentum about its centre.",
        "deduce", l_s, A_w * omega + ((C - A_w) * dot(a, omega) + C * s) * a,
        ("moment_on_wheel", "velocity_in_wheel", "wheel_tensor", "wheel_is_axisymmetric",
         "wheel_axis_is_unit"),
    ),
    Step(
        "wheel_equation",
        "Along the axis the gyroscopic terms drop out: the motor turns C against the whole turning "
        "about the axis.",
        "deduce", u, C * (dot(a, omega_dot) + s_dot),
        ("motor_torque", "law_of_wheel", "transport_of_any_vector", "body_axes",
         "spin_momentum_of_wheel", "wheel_on_carrier", "wheel_axis_is_unit",
         "axial_moment_is_constant"),
    ),
)

STEPS = PARTS + WHEEL + WHOLE + MOTOR
