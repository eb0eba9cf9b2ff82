"""Machines: bodies that are cut free, one by one or together, and moments about any point.

A balance may be written about whatever point keeps the unknowns out that nobody asks for. The price
is the moment of the mass centre's own acceleration.
"""

# fmt: off

from derive.lecture.chapters.letters import F, F_i, M, a_G, dm, m, rho_G
from derive.lecture.chapters.rigid_body import I_G, xi
from derive.lecture.step import Step
from derive.lecture.vectors import cross, dot, scalar, total, vector

M_G, g, k, c = vector("M_G"), vector("g"), scalar("k"), vector("c")

STEPS = (
    Step(
        "moment_about_G",
        "The moment of the external forces about G.",
        "define", M_G, total(cross(xi, F_i)),
    ),
    Step(
        "moment_about_any_point",
        "About any other point their resultant has a moment too, as if it acted at G.",
        "deduce", M, M_G + cross(rho_G, F),
        ("moment", "moment_about_G", "position_from_G", "total_force"),
    ),
    Step(
        "any_point_form",
        "So a body, or several cut free together, can be balanced about any point whatever.",
        "deduce", M, M_G + cross(rho_G, m * a_G),
        ("moment_about_any_point", "mass_centre_motion"),
    ),
    Step(
        "distant_centre",
        "A distant body attracts from the direction c. Its pull on a particle differs from that "
        "at G in proportion to the distance from G, to first order.",
        "assume", F_i, dm * (g + k * (3 * (dot(c, xi) * c) - xi)),
    ),
    Step(
        "gravity_gradient",
        "So the nearer part of the body is pulled more, and there is a moment about G.",
        "deduce", M_G, (3 * k) * cross(c, I_G @ c),
        ("moment_about_G", "distant_centre", "inertia_about_G", "position_from_G", "first_moment",
         "mass"),
    ),
)
