"""Angular momentum: its rate is the moment, about a fixed point, about G, about any moving point.

Nothing here asks the body to be rigid. The point A may move as it likes; the price is one extra
term, and we see exactly when it vanishes.
"""

# fmt: off
# ruff: noqa: I001

from derive.lecture.chapters.letters import (
    F_i, M, a_A, a_i, dm, l, l_N_dot, m, r, r_A, r_G, rho, rho_G, rho_N_ddot, rho_N_dot, v, v_A,
)
from derive.lecture.sums import others
from derive.lecture.step import Step
from derive.lecture.vectors import cross, reciprocal, scalar, total, vector, zero

l_O, M_O, l_O_N_dot = vector("l_O"), vector("M_O"), vector("l_O_N_dot")

ABOUT_O = (
    Step(
        "angular_momentum_about_O",
        "The angular momentum about a point O fixed in N is the sum of the moments of momentum.",
        "define", l_O, total(cross(r, dm * v)),
    ),
    Step(
        "moment_about_O",
        "The moment about O is the sum of the moments of the external forces.",
        "define", M_O, total(cross(r, F_i)),
    ),
    Step(
        "angular_momentum_rate_about_O",
        "Differentiate each product: v x v is nothing, only the accelerations remain.",
        "deduce", l_O_N_dot, total(cross(r, dm * a_i)),
        ("angular_momentum_about_O", "constant_mass"),
    ),
    Step(
        "fixed_point_law",
        "The moment about a fixed point is the rate of the angular momentum about it.",
        "deduce", M_O, l_O_N_dot,
        ("moment_about_O", "external_force", "internal_moments_vanish",
         "angular_momentum_rate_about_O"),
    ),
)

ABOUT_A = (
    Step(
        "position_from_A",
        "Now measure positions from a point A that moves in any way.",
        "define", rho, r - r_A,
    ),
    Step(
        "mass_centre_from_A",
        "G lies at rho_G from A.",
        "define", rho_G, r_G - r_A,
    ),
    Step(
        "first_moment",
        "Seen from A too, G is the mean position of the particles.",
        "deduce", rho_G, reciprocal(m) * total(dm * rho),
        ("mass_centre_from_A", "position_from_A", "mass_centre", "mass"),
    ),
    Step(
        "angular_momentum_about_A",
        "The angular momentum about A is made of positions from A and of velocities relative to A.",
        "define", l, total(cross(rho, dm * rho_N_dot)),
    ),
    Step(
        "moment",
        "The moment about A is made of the external forces alone.",
        "define", M, total(cross(rho, F_i)),
    ),
    Step(
        "angular_momentum_rate_about_A",
        "Differentiate as before.",
        "deduce", l_N_dot, total(cross(rho, dm * rho_N_ddot)),
        ("angular_momentum_about_A", "constant_mass"),
    ),
    Step(
        "internal_moments_about_A_vanish",
        "The internal forces have no moment about A either, since they have none about O and no "
        "sum.",
        "deduce", total(cross(rho, others(vector("P_ij")))), zero(3),
        ("position_from_A", "internal_moments_vanish", "internal_forces_cancel"),
    ),
    Step(
        "moving_point",
        "About a moving point the rate of l falls short of the moment by rho_G x m a_A.",
        "deduce", M, l_N_dot + cross(rho_G, m * a_A),
        ("moment", "external_force", "internal_moments_about_A_vanish",
         "angular_momentum_rate_about_A", "position_from_A", "mass_centre_from_A", "mass_centre",
         "mass"),
    ),
)

CASES = (
    Step("A_is_fixed", "First case: A stays where it is.", "assume", v_A, zero(3)),
    Step(
        "law_about_fixed_point",
        "Then A has no acceleration, the extra term is gone, and the law of a fixed point is back.",
        "deduce", M, l_N_dot,
        ("moving_point", "A_is_fixed"),
    ),
    Step("A_is_G", "Second case: A is the centre of mass.", "assume", rho_G, zero(3)),
    Step(
        "law_about_mass_centre",
        "Then the extra term has no arm: about G the law holds however G accelerates.",
        "deduce", M, l_N_dot,
        ("moving_point", "A_is_G"),
    ),
    Step(
        "A_accelerates_along_the_line_to_G",
        "Third case: A accelerates straight towards G, or straight away from it.",
        "assume", a_A, scalar("k") * rho_G,
    ),
    Step(
        "law_about_such_a_point",
        "Then arm and acceleration are parallel, as at the contact point of a rolling uniform "
        "disc.",
        "deduce", M, l_N_dot,
        ("moving_point", "A_accelerates_along_the_line_to_G"),
    ),
    Step(
        "reference_point",
        "There is no other case. From here on, unless A is said to move, it is a point without the "
        "extra term.",
        "assume", cross(rho_G, m * a_A), zero(3),
    ),
    Step(
        "moment_is_rate_of_angular_momentum",
        "About such a point the moment is the rate of the angular momentum.",
        "deduce", M, l_N_dot,
        ("moving_point", "reference_point"),
    ),
)

STEPS = ABOUT_O + ABOUT_A + CASES
