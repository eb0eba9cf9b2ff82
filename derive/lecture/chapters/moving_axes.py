"""Moving axes: how a rate seen from turning axes differs from the rate seen from N.

The product rule is computed on R u, nothing about it is assumed. Everything that is usually said of
the unit vectors i, j, k follows from R^T R = 1.
"""

# fmt: off
# ruff: noqa: I001

from derive.lecture.facts import ANY
from derive.lecture.chapters.letters import (
    Omega, Omega_dot, R, R_dot, e_x, e_y, e_z, l, l_dot, l_N_dot, rho, rho_dot, rho_N_ddot,
    rho_N_dot,
)
from derive.lecture.rate import rate
from derive.lecture.step import Step
from derive.lecture.vectors import axial, cross, cross_tensor, tensor, transpose, vector, zero

any_vector, any_vector_dot = vector(ANY), vector(f"{ANY}_dot")
W = tensor("W")

STEPS = (
    Step(
        "turning",
        "Let R have the unit vectors of xyz as its columns. R^T R_dot is how they turn, along xyz.",
        "define", W, transpose(R) @ R_dot,
    ),
    Step(
        "axes_only_turn",
        "Differentiate the scalar products of the unit vectors: this tensor is antisymmetric.",
        "deduce", W + transpose(W), zero(3, 3),
        ("turning", "axes_are_orthonormal"),
    ),
    Step(
        "angular_velocity_of_axes",
        "So it is a vector in disguise: Omega, the angular velocity of the axes, along the axes.",
        "define", Omega, axial(W),
    ),
    Step(
        "axes_turn_with_Omega",
        "Omega says all of the turning of the axes.",
        "deduce", W, cross_tensor(Omega),
        ("axes_only_turn", "angular_velocity_of_axes"),
    ),
    Step(
        "rate_of_axes",
        "Carry the turning back to N.",
        "deduce", R_dot, R @ W,
        ("turning", "axes_are_orthonormal"),
    ),
    Step(
        "rotation_rate",
        "So the rate of R is R [Omega]x.",
        "deduce", R_dot, R @ cross_tensor(Omega),
        ("rate_of_axes", "axes_turn_with_Omega"),
    ),
    Step(
        "unit_vectors_turn",
        "For the unit vectors i, j, k, the columns of R, this says that each moves at Omega x "
        "itself.",
        "deduce",
        (R_dot @ e_x, R_dot @ e_y, R_dot @ e_z),
        (R @ cross(Omega, e_x), R @ cross(Omega, e_y), R @ cross(Omega, e_z)),
        ("rotation_rate",),
    ),
    Step(
        "rate_seen_from_N",
        "This is what the rate of a vector u seen from N means: write u along N's axes, which is "
        "R u, differentiate there, and write the result along xyz again.",
        "assume", vector(f"{ANY}_N_dot"), transpose(R) @ rate(R @ any_vector),
    ),
    Step(
        "transport_of_any_vector",
        "Seen from N a vector changes as it does seen from xyz, and also because xyz turns.",
        "deduce", vector(f"{ANY}_N_dot"), any_vector_dot + cross(Omega, any_vector),
        ("rate_seen_from_N", "rotation_rate", "axes_are_orthonormal"),
    ),
    Step(
        "transport_theorem",
        "For the angular momentum in particular.",
        "deduce", l_N_dot, l_dot + cross(Omega, l),
        ("transport_of_any_vector",),
    ),
    Step(
        "velocity_seen_from_axes",
        "For the position of a particle.",
        "deduce", rho_N_dot, rho_dot + cross(Omega, rho),
        ("transport_of_any_vector",),
    ),
    Step(
        "acceleration_seen_from_axes",
        "Apply it twice: the acceleration gains the terms of the axes' own acceleration, of "
        "Coriolis, and of the centripetal acceleration.",
        "deduce",
        rho_N_ddot,
        vector("rho_i_ddot") + cross(Omega_dot, rho) + 2 * cross(Omega, rho_dot)
        + cross(Omega, cross(Omega, rho)),
        ("transport_of_any_vector",),
    ),
)
