"""The preprocessed discrete Moser-Veselov step: torque-free rotation to order ten, for long runs.

A step solves c = al W + e c c for c = tan(angle/2) times its axis, al = 1 + |c|^2 (Hairer and
Vilmart, J. Phys. A 39 (2006) 13225, eq. 13 and 19); |I omega| and the energy do not drift. What
rests on the invariants of one motion is worked out once, by ``plan_dmv``; the sums carry their
rounding remainder from call to call. Moments are measured in the largest, so their scale is gone.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from derive.flows.closed_steps import change_of_revolution, plan_revolution, plan_sphere
from derive.flows.compensated import compensated_sums
from derive.flows.frame import Frame, own_frame, principal_frame
from derive.flows.inertia import Inertia
from derive.flows.moments import in_order
from derive.flows.preprocessing import D, S, coefficients, summed
from derive.flows.turns import quaternion_change
from derive.trace import Number, Tape, absolute, at_most, named, number, repeat, sqrt

AXES = "xyz"
CYCLIC = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
PASSES = 40
FAR = 64  # a change that 64 does not feel is followed by one below rounding
Plan = list[tuple[str, Number, str]]
Vector = Sequence[Number]


def plan_dmv(tape: Tape, body: Inertia, omega: Vector, time_step: Number) -> Plan:  # noqa: ARG001
    """Return what every step of one torque-free motion has in common: name, value, meaning.

    omega : (3,) rad/s along body axes, at any instant of the motion      time_step : s
    A body of revolution and a sphere have a closed form, exact at any step.
    Source: Hairer and Vilmart (2006), eq. 19, expanded anew (see ``preprocessing``).
    """
    match body.kind:
        case "spherical":
            return plan_sphere(omega, time_step)
        case "axisymmetric":
            return plan_revolution(body, omega, time_step)
    axes = _axes(body)
    turned = axes.along([time_step * w for w in omega])
    s, d, moments = _modified(axes.moments, turned)
    ratios = [s + d * moment for moment in moments]
    plan: Plan = []
    for (i, j, k), axis in zip(CYCLIC, AXES, strict=True):
        asymmetry = named(
            f"asymmetry_{axis}", (moments[j] - moments[k]) / moments[i], "(I_j - I_k) / I_i"
        )
        half = time_step * Fraction(1, 2) * ratios[i]
        gain = s * asymmetry / (ratios[j] * ratios[k]) / (time_step * Fraction(1, 4))
        plan += [
            (f"half_{axis}", half, "half a time step, times I / It of the modified body, s"),
            (f"gain_{axis}", gain, "change of omega by two components of c, rad/s"),
            (f"couple_{axis}", gain * half * Fraction(1, 2), "(It_j - It_k) / It_i"),
        ]
    couple = plan[2][1] * plan[5][1] * Fraction(1, 2)
    return [*plan, ("couple", couple, "half the product of couple_x and couple_y")]


def _axes(body: Inertia) -> Frame:
    return principal_frame(body) if body.kind == "general" else own_frame(body)


def _modified(given: Sequence[Number], turned: Vector) -> tuple[Number, Number, list[Number]]:
    """Return s, d and the moments, in units of the largest; ``turned`` is omega times the step."""
    c, b, a = in_order(given)
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
    s_rows, d_rows = coefficients(S, tau, pi), coefficients(D, tau, pi)
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
) -> tuple[list[Number], list[Number], list[Number]]:
    """Return attitude, omega and remainder one time step later.

    attitude : (4,) quaternion, scalar first, body to inertial      omega : (3,) rad/s along body
    axes      remainder : (7,) what rounding has kept from attitude and omega; zero at first
    Source: Hairer and Vilmart (2006), eq. 13, with the sums of Kahan (1965).
    """
    if body.kind == "spherical":
        less, turn = plan["less"], [plan[f"turn_{axis}"] for axis in AXES]
        change = [number(0)] * 3
    elif body.kind == "axisymmetric":
        less, turn, change = change_of_revolution(body, plan, omega)
    else:
        axes = _axes(body)
        less, turn, change = _change(tape, plan, axes.along(omega))
        turn, change = axes.back(turn), axes.back(change)
    return compensated_sums(
        attitude, omega, quaternion_change(attitude, less, turn), change, remainder
    )


def _change(
    tape: Tape, plan: Mapping[str, Number], omega: Vector
) -> tuple[Number, list[Number], list[Number]]:
    """Return a step's attitude change, as one less its scalar and its vector, and omega's."""
    half, gain = ([plan[f"{name}_{axis}"] for axis in AXES] for name in ("half", "gain"))
    c = _solved(tape, plan, [h * w for h, w in zip(half, omega, strict=True)])
    size = c[0] * c[0] + c[1] * c[1] + c[2] * c[2]
    root = sqrt(1 + size)
    inverse = 1 / root
    less = size * inverse / (1 + root)  # 1 - 1/root without cancellation
    square = inverse * inverse
    change = [gain[i] * (c[j] * c[k]) * square for i, j, k in CYCLIC]
    return less, [x * inverse for x in c], change


def _solved(tape: Tape, plan: Mapping[str, Number], W: Vector) -> list[Number]:
    """Return c: for a known third component the others and al are explicit, so one is sought.

    With D = 1/2 - e1 e2 c3^2/2 and P = W1 + e1 W2 c3, Q = W2 + e2 W1 c3, k = 1 + c3^2, the first
    two equations and al = 1 + |c|^2 give c1 = A P, c2 = A Q, al = 2 A D with
    A = k/(D + sqrt(D^2 - k (P^2 + Q^2))); the third is left for Newton's rule, its slope at c = W.
    """
    first, second, third = (plan[f"couple_{axis}"] for axis in AXES)
    across, along, twice = first * W[1], second * W[0], W[2] + W[2]
    slope = twice * W[2] + third * (across * W[1] + along * W[0])
    factor = 1 / (1 - slope)

    def others(c3: Number) -> tuple[Number, Number, Number]:
        square = c3 * c3
        D, k = Fraction(1, 2) - plan["couple"] * square, 1 + square
        P, Q = W[0] + across * c3, W[1] + along * c3
        A = k / (D + sqrt(D * D - k * (P * P + Q * Q)))
        return A * P, A * Q, A * D

    def one_pass(c: list[Number]) -> tuple[list[Number], Number]:
        c1, c2, half_al = others(c[0])
        step = (half_al * twice + third * (c1 * c2) - c[0]) * factor
        return [c[0] + step], at_most(FAR + absolute(step), FAR)

    start = W[2] + third * (W[0] * W[1])
    c3 = repeat(tape, PASSES, [start], one_pass)[0]
    c1, c2, _ = others(c3)
    return [c1, c2, c3]
