"""Symmetry: what a mirror plane or an axis of rotation does to the six quantities.

A symmetric body looks the same after the mirror or the turn: the sum over the moved particles is
the sum over the particles. Comparing the two sums term by term is all that happens here.
"""

# fmt: off
# ruff: noqa: I001

from derive.lecture.chapters.letters import I, dm, e_x, e_z, n, rho
from derive.lecture.step import Step
from derive.lecture.vectors import (
    IDENTITY, Expression, component, cross, dot, number, outer, quantity, scalar, total, zero,
)

cos_turn, sin_turn, t = scalar("c_n"), scalar("s_n"), scalar("t_n")
xx, yy, zz, xy, xz, yz = (quantity(I, pair) for pair in ("xx", "yy", "zz", "xy", "xz", "yz"))
n_z = component(n, "z")


def mirrored(axis: Expression) -> Expression:
    """Return rho in the mirror whose plane is perpendicular to the unit vector ``axis``."""
    return rho - 2 * dot(axis, rho) * axis


turned = (
    cos_turn * rho + sin_turn * cross(e_z, rho) + ((number(1) - cos_turn) * dot(e_z, rho)) * e_z
)


def second_moments(place: Expression) -> Expression:
    """Return the sum of dm place place^T."""
    return total(dm * outer(place, place))


MIRRORS = (
    Step(
        "mirror_xy",
        "The xy plane is a mirror: the sum over the mirrored particles is the sum over the "
        "particles.",
        "assume", second_moments(mirrored(e_z)), second_moments(rho),
    ),
    Step(
        "mirror_plane",
        "In the mirror z changes its sign, and so do the two products that contain it: they "
        "vanish, and the normal of the plane is a principal axis.",
        "deduce", (xz, yz), (zero(), zero()),
        ("six_quantities", "mirror_xy"),
    ),
    Step(
        "mirror_yz",
        "The yz plane is a mirror as well.",
        "assume", second_moments(mirrored(e_x)), second_moments(rho),
    ),
    Step(
        "two_mirror_planes",
        "Two perpendicular mirrors leave no product of inertia.",
        "deduce", (xy, xz, yz), (zero(), zero(), zero()),
        ("six_quantities", "mirror_xy", "mirror_yz"),
    ),
)

ROTATION = (
    Step(
        "rotational_symmetry",
        "The body looks the same after a turn about z whose cosine is c_n and whose sine is s_n.",
        "assume", second_moments(turned), second_moments(rho),
    ),
    Step(
        "sine_and_cosine",
        "Sine and cosine of one angle.",
        "assume", cos_turn * cos_turn + sin_turn * sin_turn, number(1),
    ),
    Step(
        "turn_is_proper",
        "The turn is neither nothing nor half a turn: its sine is not zero and has an inverse "
        "t_n. Every n-fold axis with n = 3 or more has such a turn.",
        "assume", sin_turn * t, number(1),
    ),
    Step(
        "axis_of_symmetry",
        "Then no product of inertia is left and the two transverse moments are equal.",
        "deduce", (xy, xz, yz, xx - yy), (zero(), zero(), zero(), zero()),
        ("six_quantities", "rotational_symmetry", "sine_and_cosine", "turn_is_proper"),
    ),
    Step(
        "axisymmetric_tensor",
        "In other words the tensor knows one direction only.",
        "deduce", I, xx * IDENTITY + (zz - xx) * outer(e_z, e_z),
        ("axis_of_symmetry",),
    ),
    Step("transverse", "Take any direction n perpendicular to the axis.", "assume", n_z, zero()),
    Step(
        "transverse_directions_are_principal",
        "It is a principal axis, with the same moment as any other.",
        "deduce", I @ n, xx * n,
        ("axisymmetric_tensor", "transverse"),
    ),
)

STEPS = MIRRORS + ROTATION
