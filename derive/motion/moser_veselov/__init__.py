"""The preprocessed discrete Moser-Veselov step: torque-free rotation to order ten, for long runs.

A step solves c_i = al W_i + e_i c_j c_k for c = tan(angle/2) times its axis, al = 1 + |c|^2, and
moves omega by the products c_j c_k/al (Hairer and Vilmart, J. Phys. A 39 (2006) 13225, eq. 13 and
19). |I omega| and the energy do not drift. What rests on the invariants of one motion is worked
out once, by ``plan_dmv``; the sums carry their rounding remainder from call to call.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from derive.motion.axes import BodyAxes, counted_from, lacking, principal_body_axes, times
from derive.motion.compensated import closely_added, compensated_add, compensated_sums
from derive.motion.exact.inertia import Inertia, ascending
from derive.motion.moser_veselov.closed_steps import (
    about_any,
    about_momentum,
    change_of_revolution,
    less_than_one,
    plan_revolution,
    plan_sphere,
)
from derive.motion.moser_veselov.implicit import AXES, scaled, solved_step, turn_of
from derive.motion.moser_veselov.preprocessing import D, S, pi_coefficients, summed
from derive.motion.splitting.turns import quaternion_change
from derive.program.operations import absolute, less, select, splitter
from derive.program.pairs import two_product
from derive.program.tape import Number, Tape, Vector, named, number

CYCLIC = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
HARDLY = Fraction(1, 2**96)
"""Seconds in which nothing changes that a double holds, and by which floats may be divided."""


def plan_dmv(
    tape: Tape, body: Inertia, omega: Vector, time_step: Number
) -> list[tuple[str, Number, str]]:
    """Return what every step of one torque-free motion has in common: name, value, meaning.

    omega : (3,) rad/s along body axes, at any instant of the motion      time_step : s, in which
    the body turns by less than about a radian: beyond, the equations of a step have no solution
    A body of revolution and a sphere have a closed form, exact at any step.
    Source: Hairer and Vilmart (2006), eq. 19, expanded anew (see ``preprocessing``).
    """
    match body.kind:
        case "spherical":
            return plan_sphere(omega, time_step, about_momentum)
        case "axisymmetric":
            return plan_revolution(body, omega, time_step, about_momentum)
    axes = _axes(body)
    s, moments, ratios = _ratios(axes, omega, time_step)
    plan: list[tuple[str, Number, str]] = []
    factor = splitter(tape)
    moves = less(HARDLY, absolute(time_step))  # in no time nothing changes, whatever gain is
    quarter = select(moves, time_step * Fraction(1, 4), 1)
    for n, axis in enumerate(AXES):
        half = time_step * Fraction(1, 2) * ratios[n]
        gain = _share(n, s, moments, ratios) / quarter
        double, error = two_product(gain, half, factor)
        plan += [
            (f"half_{axis}", half, "half a time step, times I / It of the modified body, s"),
            (f"gain_{axis}", gain, "change of omega by two components of c, rad/s"),
            (f"couple_{axis}", double * Fraction(1, 2), "(It_j - It_k) / It_i: gain half / 2"),
            (f"couple_low_{axis}", error * Fraction(1, 2), "what rounding kept from that"),
        ]
    couple = plan[2][1] * plan[6][1] * Fraction(1, 2)
    plan.append(("couple", couple, "half the product of couple_x and couple_y"))
    return plan + _back(tape, axes)


def plan_slopes(tape: Tape, body: Inertia, omega: Vector, time_step: Number) -> list[Number]:
    """Return the values of ``plan_dmv`` by operations whose slopes keep their digits everywhere.

    Near rest and for hardly any time those of the plan lose them; what rounding kept has no slope.
    """
    match body.kind:
        case "spherical":
            return [value for _, value, _ in plan_sphere(omega, time_step, about_any)]
        case "axisymmetric":
            return [value for _, value, _ in plan_revolution(body, omega, time_step, about_any)]
    axes = _axes(body)
    s, moments, ratios = _ratios(axes, omega, time_step)
    plan: list[Number] = []
    for n in range(3):
        share = _share(n, s, moments, ratios)
        half, gain = time_step * Fraction(1, 2) * ratios[n], share / (time_step * Fraction(1, 4))
        plan += [half, gain, share * ratios[n], number(0)]
    return [*plan, plan[2] * plan[6] * Fraction(1, 2), *(x for _, x, _ in _back(tape, axes))]


def _ratios(
    axes: BodyAxes, omega: Vector, time_step: Number
) -> tuple[Number, list[Number], list[Number]]:
    """Return s, the moments, and those over the modified body's."""
    s, d, moments = _modified(axes.moments, axes.along([time_step * w for w in omega]))
    return s, moments, [s + d * moment for moment in moments]


def _share(n: int, s: Number, moments: Vector, ratios: Vector) -> Number:
    """Return what gain and couple of an axis have in common."""
    i, j, k = CYCLIC[n]
    difference = (moments[j] - moments[k]) / moments[i]
    asymmetry = named(f"asymmetry_{AXES[n]}", difference, "(I_j - I_k) / I_i")
    return s * asymmetry / (ratios[j] * ratios[k])


def _back(tape: Tape, axes: BodyAxes) -> list[tuple[str, Number, str]]:
    says = "what the way back from principal axes lacks by rounding"
    rows = zip(AXES, lacking(tape, axes.rows) if axes.rows else (), strict=False)
    each = ((x, zip("abc", row, strict=True)) for x, row in rows)
    return [(f"back_{x}{a}", entry, says) for x, row in each for a, entry in row]


def _axes(body: Inertia) -> BodyAxes:
    return principal_body_axes(body) if body.kind == "general" else counted_from(0, body)


def _modified(given: Sequence[Number], turned: Vector) -> tuple[Number, Number, list[Number]]:
    """Return s, d and the moments, in units of the largest; ``turned`` is omega times the step."""
    c, b, a = ascending(given)
    moments = [
        named(f"moment_{axis}", moment / a, "moment over the largest one")
        for axis, moment in zip(AXES, given, strict=True)
    ]
    b, c = b / a, c / a
    tau, pi = (b + c - 1) / (b * c), b * c
    H, delta = number(0), number(0)
    for axis, moment, w in zip(AXES, moments, turned, strict=True):
        spread = named(f"spread_{axis}", moment * (moment - 1) / (2 * pi), "I (I - a) / (2 b c)")
        half = named(f"energy_{axis}", moment * Fraction(1, 2), "half the moment over the largest")
        H = H + half * (w * w)
        delta = delta + spread * (w * w)
    s_rows, d_rows = pi_coefficients(S, tau, pi), pi_coefficients(D, tau, pi)
    for letter, rows in (("s", s_rows), ("d", d_rows)):
        for k, row in enumerate(rows):
            for i, value in enumerate(row):
                named(f"{letter}{k + 1}{i}", value, f"coefficient of delta^{k + 1 - i} H^{i}")
    return 1 + summed(s_rows, delta, H), summed(d_rows, delta, H), moments


def step_dmv(
    tape: Tape,
    body: Inertia,
    plan: Mapping[str, Number],
    attitude: Vector,
    omega: Vector,
    remainder: Vector,
) -> list[Number]:
    """Return attitude, omega (7,) and remainder (7,) one time step later.

    attitude : (4,) quaternion, scalar first, body to inertial      omega : (3,) rad/s along body
    axes      remainder : (7,) what rounding has kept from attitude and omega; zero at first
    Source: Hairer and Vilmart (2006), eq. 13, with the sums of Kahan (1965).
    """
    state = [*attitude, *omega]
    if body.kind == "spherical":
        turn = [plan[f"turn_{axis}"] for axis in AXES]
        change = quaternion_change(attitude, plan["less"], turn)
        return compensated_sums(state, [*change, *[number(0)] * 3], remainder)
    if body.kind == "axisymmetric":
        turn, faster = change_of_revolution(body, plan, omega)
        change = quaternion_change(attitude, less_than_one(plan["forward"], turn), turn)
        return compensated_sums(state, [*change, *faster], remainder)
    axes = _axes(body)
    c, al = solved_step(tape, plan, axes.along(omega), axes.along(remainder[4:]))
    missing, turn = turn_of(c)
    change = quaternion_change(attitude, missing, axes.back(turn))
    faster = scaled(plan, "gain", [c[j] * c[k] / al for _, j, k in CYCLIC])
    if not axes.rows:
        return compensated_sums(state, [*change, *faster], remainder)
    low = times([[plan[f"back_{x}{a}"] for a in "abc"] for x in AXES], faster)
    sums = [compensated_add(*x) for x in zip(attitude, change, remainder[:4], strict=True)]
    back = zip(omega, axes.back(faster), remainder[4:], low, strict=True)
    sums += [closely_added(*x) for x in back]
    return [x for x, _ in sums] + [rest for _, rest in sums]
