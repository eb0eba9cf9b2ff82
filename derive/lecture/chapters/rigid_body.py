"""A rigid body: rigidity gives l = I omega, and six sums over the particles say all of I.

Rigidity enters in one place only, as coordinates in the body that do not change. What follows is
the inertia tensor: how it moves with the point, turns with the axes, and the energy it holds.
"""

# fmt: off
# ruff: noqa: I001

from fractions import Fraction

from derive.lecture.chapters.letters import (
    F, I, M, Q, Q_dot, R, T, b, dm, l, m, omega, rho, rho_G, rho_N_dot, v, v_A, v_G,
)
from derive.lecture.step import Step
from derive.lecture.vectors import (
    IDENTITY, Expression, axial, component, cross, cross_tensor, dot, inertia, outer, quantity,
    scalar, tensor, total, trace, transpose, vector, zero,
)

HALF = Fraction(1, 2)
S, J, K = vector("S"), tensor("J"), scalar("K")
rho_G_N_dot = vector("rho_G_N_dot")
xi, I_G = vector("xi_i"), inertia("I_G")
rho_1, I_1 = vector("rho_prime_i"), inertia("I_prime")
x, y, z = (component(rho, axis) for axis in "xyz")


def inertia_of(position: Expression) -> Expression:
    """Return what one particle at ``position`` gives to the inertia tensor."""
    return dm * (dot(position, position) * IDENTITY - outer(position, position))


RIGIDITY = (
    Step(
        "body_triad",
        "Fix three perpendicular unit vectors in the body and make them the columns of Q. A "
        "particle has the coordinates b in this triad.",
        "assume", rho, Q @ b,
    ),
    Step(
        "body_triad_is_orthonormal",
        "The triad stays perpendicular and of unit length, read by columns or by rows.",
        "assume", (transpose(Q) @ Q, Q @ transpose(Q)), (IDENTITY, IDENTITY),
    ),
    Step(
        "rigid",
        "The body is rigid: no particle changes its place in it.",
        "assume", vector("b_i_dot"), zero(3),
    ),
    Step(
        "velocity_in_body",
        "So a particle moves only because the triad does.",
        "deduce", rho_N_dot, Q_dot @ (transpose(Q) @ rho),
        ("body_triad", "body_triad_is_orthonormal", "rigid"),
    ),
    Step(
        "triad_only_turns",
        "Differentiate the rows: what carries a position to a velocity is antisymmetric.",
        "deduce", Q_dot @ transpose(Q) + transpose(Q_dot @ transpose(Q)), zero(3, 3),
        ("body_triad_is_orthonormal",),
    ),
    Step(
        "angular_velocity",
        "An antisymmetric tensor is a vector in disguise. We call it the angular velocity.",
        "define", omega, axial(Q_dot @ transpose(Q)),
    ),
    Step(
        "angular_velocity_turns_triad",
        "It says all of the turning.",
        "deduce", Q_dot @ transpose(Q), cross_tensor(omega),
        ("angular_velocity", "triad_only_turns"),
    ),
    Step(
        "velocity_of_particle",
        "So a particle of a rigid body moves at omega x rho, seen from A.",
        "deduce", rho_N_dot, cross(omega, rho),
        ("velocity_in_body", "angular_velocity_turns_triad"),
    ),
)

TENSOR = (
    Step(
        "inertia_tensor",
        "The inertia tensor is one sum over the particles.",
        "define", I, total(inertia_of(rho)),
    ),
    Step(
        "angular_momentum",
        "The sum of rho x dm (omega x rho) is linear in omega, and the tensor is its factor.",
        "deduce", l, I @ omega,
        ("angular_momentum_about_A", "velocity_of_particle", "inertia_tensor"),
    ),
    Step(
        "six_quantities",
        "In components: three moments of inertia, and three products of inertia, which are plus "
        "the sums of x y dm; the tensor carries them with a minus.",
        "deduce",
        tuple(quantity(I, pair) for pair in ("xx", "yy", "zz", "xy", "xz", "yz")),
        (total(dm * (y * y + z * z)), total(dm * (z * z + x * x)), total(dm * (x * x + y * y)),
         total(dm * (x * y)), total(dm * (x * z)), total(dm * (y * z))),
        ("inertia_tensor",),
    ),
    Step(
        "moments_of_one_sum",
        "Put 1, rho and rho rho^T into the same sum: mass, first moments and second moments.",
        "define", (S, J), (total(dm * rho), total(dm * outer(rho, rho))),
    ),
    Step(
        "first_moments_give_mass_centre",
        "The first moments are the mass times the place of G.",
        "deduce", S, m * rho_G,
        ("moments_of_one_sum", "first_moment"),
    ),
    Step(
        "second_moments_give_inertia",
        "The second moments hold the whole inertia tensor.",
        "deduce", I, trace(J) * IDENTITY - J,
        ("inertia_tensor", "moments_of_one_sum"),
    ),
    Step(
        "position_from_G",
        "Measure positions from G as well.",
        "define", xi, rho - rho_G,
    ),
    Step(
        "inertia_about_G",
        "The same sum about G is the central inertia tensor.",
        "define", I_G, total(inertia_of(xi)),
    ),
    Step(
        "parallel_axes",
        "About another point the tensor grows by that of the whole mass placed at G.",
        "deduce", I, I_G + m * (dot(rho_G, rho_G) * IDENTITY - outer(rho_G, rho_G)),
        ("inertia_tensor", "inertia_about_G", "position_from_G", "first_moment", "mass"),
    ),
    Step(
        "axes_are_orthonormal",
        "Other axes, turned by R: their unit vectors are perpendicular and of unit length.",
        "assume", (transpose(R) @ R, R @ transpose(R)), (IDENTITY, IDENTITY),
    ),
    Step(
        "position_in_other_axes",
        "Along the other axes a particle has the components R rho.",
        "define", rho_1, R @ rho,
    ),
    Step(
        "inertia_in_other_axes",
        "The same sum along the other axes is their inertia tensor.",
        "define", I_1, total(inertia_of(rho_1)),
    ),
    Step(
        "change_of_axes",
        "So the tensor turns with the axes, from both sides.",
        "deduce", I_1, R @ (I @ transpose(R)),
        ("inertia_in_other_axes", "position_in_other_axes", "inertia_tensor",
         "axes_are_orthonormal"),
    ),
)

ENERGY = (
    Step(
        "kinetic_energy",
        "Kinetic energy is half the sum of dm v^2.",
        "define", T, HALF * total(dm * dot(v, v)),
    ),
    Step(
        "velocity_through_A",
        "The velocity of a particle is that of A and its own relative to A.",
        "deduce", v, v_A + rho_N_dot,
        ("position_from_A",),
    ),
    Step(
        "energy_relative_to_A",
        "K is the part that the velocities relative to A make up.",
        "define", K, HALF * total(dm * dot(rho_N_dot, rho_N_dot)),
    ),
    Step(
        "energy_about_fixed_point",
        "If A is fixed there is no other part, for any cloud of particles.",
        "deduce", T, K,
        ("kinetic_energy", "velocity_through_A", "energy_relative_to_A", "A_is_fixed"),
    ),
    Step(
        "velocity_of_G",
        "G moves as A does and as rho_G changes.",
        "deduce", v_G, v_A + rho_G_N_dot,
        ("mass_centre_from_A",),
    ),
    Step(
        "momentum_relative_to_A",
        "The momentum relative to A is that of the whole mass at G.",
        "deduce", total(dm * rho_N_dot), m * rho_G_N_dot,
        ("first_moment", "mass_is_constant", "constant_mass"),
    ),
    Step(
        "energy_about_mass_centre",
        "If A is G the mixed term is gone: K stands beside the energy of the mass moving with G.",
        "deduce", T, HALF * (m * dot(v_G, v_G)) + K,
        ("kinetic_energy", "velocity_through_A", "energy_relative_to_A", "velocity_of_G", "mass",
         "momentum_relative_to_A", "A_is_G"),
    ),
    Step(
        "energy_of_turning",
        "For a rigid body K is a quadratic form in omega, and the inertia tensor is its matrix.",
        "deduce", K, HALF * dot(omega, I @ omega),
        ("energy_relative_to_A", "velocity_of_particle", "inertia_tensor"),
    ),
    Step(
        "kinetic_energy_about_point",
        "So this is the energy of a rigid body that turns about a fixed point.",
        "deduce", T, HALF * dot(omega, I @ omega),
        ("energy_about_fixed_point", "energy_of_turning"),
    ),
    Step(
        "koenig",
        "And this is the energy of a free rigid body: that of its mass moving with G and that of "
        "its turning about G.",
        "deduce", T, HALF * (m * dot(v_G, v_G)) + HALF * dot(omega, I @ omega),
        ("energy_about_mass_centre", "energy_of_turning"),
    ),
    Step(
        "power",
        "About a fixed point the moment works on the turning and on nothing else.",
        "deduce", scalar("T_dot"), dot(M, omega),
        ("kinetic_energy", "constant_mass", "velocity_through_A", "A_is_fixed",
         "velocity_of_particle", "law_about_fixed_point", "angular_momentum_rate_about_A"),
    ),
    Step(
        "power_of_free_body",
        "For a free body the force works on the velocity of G and the moment about G on the "
        "turning.",
        "deduce", scalar("T_dot"), dot(F, v_G) + dot(M, omega),
        ("kinetic_energy", "constant_mass", "velocity_through_A", "velocity_of_particle",
         "velocity_of_G", "law_about_mass_centre", "angular_momentum_rate_about_A",
         "mass_centre_motion", "mass_centre_acceleration", "A_is_G", "first_moment"),
    ),
)

STEPS = RIGIDITY + TENSOR + ENERGY
