"""The general form: the moment in any axes, and everything that follows from it by choosing axes.

The axes xyz turn with Omega, the body with omega. The body's particles move in those axes, so the
tensor may change; when it does not, when the axes are the body's own, and when they are principal,
the equation becomes simpler step by step, down to Euler's three.
"""

# fmt: off
# ruff: noqa: I001

from derive.lecture.chapters.letters import (
    A, C, I, I_dot, M, Omega, Omega_dot, a_A, e, e_z, l_dot, m, omega, omega_dot, rho, rho_dot,
    rho_G, s, s_dot, w,
)
from derive.lecture.step import Step
from derive.lecture.vectors import (
    IDENTITY, Expression, component, cross, cross_tensor, dot, number, outer, quantity, scalar,
    vector, zero,
)

pairs = ("xx", "yy", "zz", "xy", "xz", "yz")
Ixx, Iyy, Izz, Ixy, Ixz, Iyz = (quantity(I, pair) for pair in pairs)
M_x, M_y, M_z = (component(M, axis) for axis in "xyz")
o_x, o_y, o_z = (component(omega, axis) for axis in "xyz")
d_x, d_y, d_z = (component(omega_dot, axis) for axis in "xyz")
W_x, W_y, W_z = (component(Omega, axis) for axis in "xyz")
D_x, D_y, D_z = (component(Omega_dot, axis) for axis in "xyz")
I_1, I_2, I_3 = scalar("I_1"), scalar("I_2"), scalar("I_3")
e_1, e_2, e_3 = vector("e_1"), vector("e_2"), vector("e_3")
relative = omega - Omega
product_12 = (I_1 - I_2) * dot(w, e_3)
product_23 = (I_2 - I_3) * dot(w, e_1)
product_31 = (I_3 - I_1) * dot(w, e_2)


def mixed(first: Expression, second: Expression) -> Expression:
    """Return the symmetric tensor of two directions."""
    return outer(first, second) + outer(second, first)


GENERAL = (
    Step(
        "particle_in_axes",
        "Seen from xyz a particle moves at (omega - Omega) x rho, for the axes carry part of its "
        "motion.",
        "deduce", rho_dot, cross(relative, rho),
        ("velocity_seen_from_axes", "velocity_of_particle"),
    ),
    Step(
        "inertia_rate_in_axes",
        "So the six sums change, at a rate that the tensor itself and omega - Omega determine.",
        "deduce", I_dot, cross_tensor(relative) @ I - I @ cross_tensor(relative),
        ("inertia_tensor", "particle_in_axes", "constant_mass"),
    ),
    Step(
        "rate_in_axes",
        "Seen from xyz l = I omega changes because the tensor does and because omega does.",
        "deduce", l_dot, I_dot @ omega + I @ omega_dot,
        ("angular_momentum",),
    ),
    Step(
        "general_form",
        "The perfectly general form, about a fixed point or about G, in any axes.",
        "deduce", M, I_dot @ omega + I @ omega_dot + cross(Omega, I @ omega),
        ("moment_is_rate_of_angular_momentum", "transport_theorem", "angular_momentum"),
    ),
    Step(
        "moving_point_form",
        "The same about a point A that moves in any way.",
        "deduce", M,
        I_dot @ omega + I @ omega_dot + cross(Omega, I @ omega) + cross(rho_G, m * a_A),
        ("moving_point", "transport_theorem", "angular_momentum"),
    ),
    Step(
        "spherical_part",
        "In the axes of the body a part c 1 of the tensor, the same in all directions, feels no "
        "gyroscopic moment.",
        "deduce", cross(omega, (scalar("c") * IDENTITY) @ omega), zero(3),
    ),
)

CONSTANT_TENSOR = (
    Step("relative_turning", "Let w be how the body turns in the axes.", "define", w, relative),
    Step(
        "third_direction",
        "Take two directions, and the one that completes them to a right-handed triad.",
        "define", e_3, cross(e_1, e_2),
    ),
    Step(
        "principal_directions",
        "Let them be principal directions of the body. Every tensor has three that are "
        "perpendicular; principal.py computes them.",
        "assume", I, I_1 * outer(e_1, e_1) + I_2 * outer(e_2, e_2) + I_3 * outer(e_3, e_3),
    ),
    Step(
        "directions_are_perpendicular",
        "The first two are perpendicular and of unit length.",
        "assume", (dot(e_1, e_1), dot(e_2, e_2), dot(e_1, e_2)), (number(1), number(1), zero()),
    ),
    Step(
        "inertia_rate_is_three_products",
        "Along the principal directions the rate of the tensor is three products, each of a "
        "difference of two moments and one component of w.",
        "deduce", I_dot,
        (product_12 * mixed(e_1, e_2)) + (product_23 * mixed(e_2, e_3))
        + (product_31 * mixed(e_3, e_1)),
        ("inertia_rate_in_axes", "relative_turning", "principal_directions",
         "directions_are_perpendicular", "third_direction"),
    ),
    Step(
        "mixed_rates",
        "Each product can be read off between two of the directions.",
        "deduce",
        (dot(e_1, I_dot @ e_2), dot(e_2, I_dot @ e_3), dot(e_3, I_dot @ e_1)),
        (product_12, product_23, product_31),
        ("inertia_rate_is_three_products", "directions_are_perpendicular", "third_direction"),
    ),
    Step("tensor_is_constant", "Suppose the axes see no change of the tensor.", "assume",
         I_dot, zero(3, 3)),
    Step(
        "constant_tensor_needs",
        "Then each product vanishes: where w has a component along a principal direction, the "
        "other two moments are equal.",
        "deduce", (product_12, product_23, product_31), (zero(), zero(), zero()),
        ("mixed_rates", "tensor_is_constant"),
    ),
    Step("products_vanish", "Suppose, the other way round, that each product vanishes.", "assume",
         (product_12, product_23, product_31), (zero(), zero(), zero())),
    Step(
        "constant_tensor_suffices",
        "Then the tensor is constant in the axes, although they do not turn with the body. The "
        "condition is exact.",
        "deduce", I_dot, zero(3, 3),
        ("inertia_rate_is_three_products", "products_vanish"),
    ),
)

BODY_AXES = (
    Step("body_axes", "Fix the axes in the body.", "assume", Omega, omega),
    Step(
        "inertia_constant",
        "Then no particle moves in them, and the tensor is constant.",
        "deduce", I_dot, zero(3, 3),
        ("inertia_rate_in_axes", "body_axes"),
    ),
    Step(
        "body_axes_form",
        "Only the change of omega and the gyroscopic term remain.",
        "deduce", M, I @ omega_dot + cross(omega, I @ omega),
        ("general_form", "body_axes", "inertia_constant"),
    ),
    Step(
        "principal_axes",
        "Let the axes be principal axes too: no products of inertia.",
        "assume", (Ixy, Ixz, Iyz), (zero(), zero(), zero()),
    ),
    Step(
        "euler",
        "Euler's equations. Each follows from the one before by x to y to z to x.",
        "deduce", (M_x, M_y, M_z),
        (Ixx * d_x - (Iyy - Izz) * (o_y * o_z),
         Iyy * d_y - (Izz - Ixx) * (o_z * o_x),
         Izz * d_z - (Ixx - Iyy) * (o_x * o_y)),
        ("body_axes_form", "principal_axes"),
    ),
)

AXISYMMETRIC = (
    Step(
        "axisymmetric_body",
        "An axisymmetric body has one moment C about its axis e and the same moment A across it.",
        "assume", I, A * IDENTITY + (C - A) * outer(e, e),
    ),
    Step("axis_is_unit", "The axis e is a unit vector.", "assume", dot(e, e), number(1)),
    Step(
        "spins_in_axes",
        "Let the axes follow its axis but not its spin s.",
        "assume", omega, Omega + s * e,
    ),
    Step(
        "constant_though_spinning",
        "Then the tensor is constant in axes that do not spin with the body: the important case.",
        "deduce", I_dot, zero(3, 3),
        ("inertia_rate_in_axes", "axisymmetric_body", "spins_in_axes"),
    ),
    Step(
        "axisymmetric_form",
        "The general form loses its first term, and Omega stays different from omega.",
        "deduce", M, I @ omega_dot + cross(Omega, I @ omega),
        ("general_form", "constant_though_spinning"),
    ),
    Step("axis_is_z", "Let e be the z axis.", "assume", e, e_z),
    Step(
        "axisymmetric_equations",
        "In components, for a body that spins about z.",
        "deduce", (M_x, M_y, M_z),
        (A * D_x + (C * (W_z + s) - A * W_z) * W_y,
         A * D_y - (C * (W_z + s) - A * W_z) * W_x,
         C * (D_z + s_dot)),
        ("axisymmetric_form", "axisymmetric_body", "spins_in_axes", "axis_is_z"),
    ),
    Step(
        "steady_precession",
        "Precession is steady: Omega and s do not change, and the axis keeps its place in the "
        "axes.",
        "assume", (Omega_dot, s_dot, vector("e_dot")), (zero(3), zero(), zero(3)),
    ),
    Step(
        "moment_of_steady_precession",
        "A steady precession needs a moment, perpendicular to the axis and to the precession.",
        "deduce", M, (C * (s + dot(Omega, e)) - A * dot(Omega, e)) * cross(Omega, e),
        ("axisymmetric_form", "axisymmetric_body", "axis_is_unit", "spins_in_axes",
         "steady_precession"),
    ),
    Step("precession_across_axis", "Let the precession be perpendicular to the axis.",
         "assume", dot(Omega, e), zero()),
    Step(
        "gyroscopic_moment",
        "Then it is the well known product of spin momentum and precession.",
        "deduce", M, (C * s) * cross(Omega, e),
        ("moment_of_steady_precession", "precession_across_axis"),
    ),
)

STEPS = GENERAL + CONSTANT_TENSOR + BODY_AXES + AXISYMMETRIC
