"""Particles: Newton's laws for each, and what is left of them in the sum.

Every particle i feels an external force and one force from each other particle j. We add over all
particles, and over all pairs for the internal forces, and see which part of the third law each
conclusion needs.
"""

# fmt: off
# ruff: noqa: I001

from derive.lecture.chapters.letters import (
    F, F_i, P_ij, P_ji, a_G, a_i, dm, f_i, m, p_ij, r, r_G, r_j, v, v_G,
)
from derive.lecture.sums import others
from derive.lecture.step import Step
from derive.lecture.vectors import cross, reciprocal, scalar, total, zero

STEPS = (
    Step(
        "force_on_particle",
        "A particle feels an external force and a force from every other particle of the body.",
        "define", f_i, F_i + others(P_ij),
    ),
    Step(
        "newton",
        "In an inertial frame N the force on a particle is its mass times its acceleration.",
        "assume", f_i, dm * a_i,
    ),
    Step(
        "external_force",
        "So the external force is what remains of mass times acceleration without the internal "
        "forces.",
        "deduce", F_i, dm * a_i - others(P_ij),
        ("force_on_particle", "newton"),
    ),
    Step(
        "third_law",
        "Two particles act on each other with opposite forces.",
        "assume", P_ji, -P_ij,
    ),
    Step(
        "internal_forces_cancel",
        "Add the internal forces over all particles: every pair enters twice, as i j and as j i, "
        "and the two forces cancel.",
        "deduce", total(others(P_ij)), zero(3),
        ("third_law",),
    ),
    Step(
        "internal_moments",
        "Add their moments the same way. The pair leaves a couple: its force times the arm between "
        "the two particles.",
        "deduce", total(cross(r, others(P_ij))), total(cross(r - r_j, P_ij), "pairs"),
        ("third_law",),
    ),
    Step(
        "strong_third_law",
        "The force between two particles acts along the line that joins them. Opposite forces "
        "alone do not say this.",
        "assume", P_ij, p_ij * (r - r_j),
    ),
    Step(
        "internal_moments_vanish",
        "Only then does the arm lie along the force, and the internal forces have no moment.",
        "deduce", total(cross(r, others(P_ij))), zero(3),
        ("internal_moments", "strong_third_law"),
    ),
    Step("mass", "The mass of the body is that of all its particles.", "define", m, total(dm)),
    Step(
        "constant_mass",
        "A particle keeps its mass.",
        "assume", scalar("dm_i_dot"), zero(),
    ),
    Step(
        "mass_is_constant",
        "So the body keeps its mass too.",
        "deduce", scalar("m_dot"), zero(),
        ("mass", "constant_mass"),
    ),
    Step(
        "mass_centre",
        "The centre of mass G is the mean position of the particles, each weighed by its mass.",
        "define", r_G, reciprocal(m) * total(dm * r),
    ),
    Step(
        "momentum_of_mass_centre",
        "Differentiate: the momentum of the body is that of its whole mass moving with G.",
        "deduce", m * v_G, total(dm * v),
        ("mass_centre", "mass_is_constant", "constant_mass"),
    ),
    Step(
        "mass_centre_acceleration",
        "Differentiate again.",
        "deduce", m * a_G, total(dm * a_i),
        ("mass_centre", "mass_is_constant", "constant_mass"),
    ),
    Step("total_force", "F is the sum of the external forces.", "define", F, total(F_i)),
    Step(
        "mass_centre_motion",
        "G moves as a particle would that had all the mass and felt all the external forces.",
        "deduce", F, m * a_G,
        ("total_force", "external_force", "internal_forces_cancel", "mass_centre_acceleration"),
    ),
)
