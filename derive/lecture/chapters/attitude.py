"""Attitude: where the body's axes point, by a quaternion or by three angles, and how that changes.

R takes components along the body's axes to components along N's. Everything follows from the one
equation R_dot = R [Omega]x, here for axes fixed in the body.
"""

# fmt: off
# ruff: noqa: I001

from derive.lecture.chapters.letters import (
    Omega, R, e_x, e_y, e_z, omega, q_v, q_v_dot, q_w, q_w_dot,
)
from derive.lecture.chapters.rigid_body import HALF
from derive.lecture.step import Step
from derive.lecture.vectors import (
    IDENTITY, Expression, axial, component, cosine, cross, cross_tensor, dot, number, scalar,
    sine, tensor, transpose, turn, vector, zero,
)

any_v = vector("v")
R_1, R_2, Omega_1, Omega_2 = tensor("R_1"), tensor("R_2"), vector("Omega_1"), vector("Omega_2")
angle, angle_dot, e = scalar("angle"), scalar("angle_dot"), vector("e")
psi, theta, phi = scalar("psi"), scalar("theta"), scalar("phi")
psi_dot, theta_dot, phi_dot = scalar("psi_dot"), scalar("theta_dot"), scalar("phi_dot")
sec = scalar("sec_theta")
twice_conj_q_q_dot = 2 * (q_w * q_v_dot - q_w_dot * q_v - cross(q_v, q_v_dot))
o_x, o_y, o_z = (component(omega, axis) for axis in "xyz")


def columns(t: Expression) -> tuple[Expression, Expression, Expression]:
    """Return the images of the three unit vectors."""
    return t @ e_x, t @ e_y, t @ e_z


QUATERNION = (
    Step(
        "quaternion_of_axes",
        "Write R with four numbers, a scalar q_w and a vector q_v, the same along N's axes and "
        "along the body's.",
        "assume", R,
        IDENTITY + (2 * q_w) * cross_tensor(q_v) + 2 * (cross_tensor(q_v) @ cross_tensor(q_v)),
    ),
    Step(
        "unit_quaternion",
        "The four numbers form a unit quaternion.",
        "assume", q_w * q_w + dot(q_v, q_v), number(1),
    ),
    Step(
        "quaternion_gives_axes",
        "Then the columns of R are perpendicular, of unit length, and right-handed.",
        "deduce",
        (transpose(R) @ R, cross(R @ e_x, R @ e_y)),
        (IDENTITY, R @ e_z),
        ("quaternion_of_axes", "unit_quaternion"),
    ),
    Step(
        "rotation_of_vector",
        "To take a vector v from the body's axes to N's, two vector products are enough.",
        "deduce", R @ any_v,
        any_v + (2 * q_w) * cross(q_v, any_v) + 2 * cross(q_v, cross(q_v, any_v)),
        ("quaternion_of_axes",),
    ),
    Step(
        "turning_of_quaternion",
        "Put it into R^T R_dot: Omega is twice the vector part of conj(q) q_dot.",
        "deduce", Omega, twice_conj_q_q_dot,
        ("angular_velocity_of_axes", "turning", "quaternion_of_axes", "unit_quaternion"),
    ),
    Step(
        "angular_velocity_of_quaternion",
        "For axes fixed in the body this is omega.",
        "deduce", omega, twice_conj_q_q_dot,
        ("turning_of_quaternion", "body_axes"),
    ),
    Step(
        "quaternion_rate_scalar",
        "Solve for the rate of the scalar part: it is the scalar part of q (0, omega) / 2.",
        "deduce", q_w_dot, -(HALF * dot(q_v, omega)),
        ("angular_velocity_of_quaternion", "unit_quaternion"),
    ),
    Step(
        "quaternion_rate_vector",
        "And for the vector part of q (0, omega) / 2. No attitude is singular.",
        "deduce", q_v_dot, HALF * (q_w * omega + cross(q_v, omega)),
        ("angular_velocity_of_quaternion", "unit_quaternion"),
    ),
)

COMPOSED = (
    Step(
        "composed_turns",
        "Further axes are turned by R_2 from xyz, which themselves turn.",
        "assume", R_1, R @ R_2,
    ),
    Step(
        "further_axes",
        "They have angular velocities as any axes do: R_1 seen from N, R_2 seen from xyz.",
        "define", (Omega_1, Omega_2),
        (axial(transpose(R_1) @ tensor("R_1_dot")), axial(transpose(R_2) @ tensor("R_2_dot"))),
    ),
    Step(
        "further_axes_are_right_handed",
        "The further axes are perpendicular, of unit length and right-handed.",
        "assume",
        (transpose(R_2) @ R_2, cross(R_2 @ e_y, R_2 @ e_z), cross(R_2 @ e_z, R_2 @ e_x),
         cross(R_2 @ e_x, R_2 @ e_y)),
        (IDENTITY, *columns(R_2)),
    ),
    Step(
        "angular_velocities_add",
        "The angular velocities add: the first, along the further axes, and the second.",
        "deduce", Omega_1, transpose(R_2) @ Omega + Omega_2,
        ("further_axes", "composed_turns", "rotation_rate", "axes_are_orthonormal",
         "further_axes_are_right_handed"),
    ),
    Step(
        "turn_of_vector",
        "A turn by an angle about a unit vector e keeps what lies along e, and takes the rest "
        "partly into e x v.",
        "deduce", turn(e, angle) @ any_v,
        cosine(angle) * any_v + sine(angle) * cross(e, any_v)
        + ((number(1) - cosine(angle)) * dot(e, any_v)) * e,
    ),
    Step("simple_turn", "Let the turn be by an angle about a fixed unit vector e.", "assume",
         R_2, turn(e, angle)),
    Step("fixed_axis", "The vector e keeps its place.", "assume", vector("e_dot"), zero(3)),
    Step(
        "rate_of_simple_turn",
        "Then the second angular velocity is the rate of the angle, along e.",
        "deduce", Omega_2, angle_dot * e,
        ("further_axes", "simple_turn", "fixed_axis", "axis_is_unit"),
    ),
)

EULER_ANGLES = (
    Step(
        "euler_321",
        "Yaw psi about z, then pitch theta about the new y, then roll phi about the new x.",
        "assume", R, turn(e_z, psi) @ (turn(e_y, theta) @ turn(e_x, phi)),
    ),
    Step(
        "angular_velocity_321",
        "Each rate turns about its own axis; along the body's axes they make up omega.",
        "deduce", omega,
        phi_dot * e_x + transpose(turn(e_x, phi)) @ (theta_dot * e_y)
        + transpose(turn(e_x, phi)) @ (transpose(turn(e_y, theta)) @ (psi_dot * e_z)),
        ("angular_velocity_of_axes", "turning", "body_axes", "euler_321"),
    ),
    Step(
        "no_gimbal_lock",
        "The pitch is not 90 degrees up or down: its cosine is not zero and has an inverse. "
        "There, and only there, the angles are singular.",
        "assume", cosine(theta) * sec, number(1),
    ),
    Step(
        "euler_321_rates",
        "Solve for the rates. Near 90 degrees of pitch the inverse of the cosine grows without "
        "bound.",
        "deduce", (psi_dot, theta_dot, phi_dot),
        (sec * (sine(phi) * o_y + cosine(phi) * o_z),
         cosine(phi) * o_y - sine(phi) * o_z,
         o_x + (sine(theta) * sec) * (sine(phi) * o_y + cosine(phi) * o_z)),
        ("angular_velocity_321", "no_gimbal_lock"),
    ),
)

STEPS = QUATERNION + COMPOSED + EULER_ANGLES
