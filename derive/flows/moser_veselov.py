"""The preprocessed discrete Moser-Veselov step: torque-free rotation to order ten, for long runs.

A step solves c_i = al W_i + e_i c_j c_k for c = tan(angle/2) times its axis, al = 1 + |c|^2, and
moves omega by the products c_j c_k/al (Hairer and Vilmart, J. Phys. A 39 (2006) 13225, eq. 13 and
19). |I omega| and the energy do not drift. What rests on the invariants of one motion is worked
out once, by ``plan_dmv``; the sums carry their rounding remainder from call to call.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from derive.flows.closed_steps import change_of_revolution, plan_revolution, plan_sphere
from derive.flows.compensated import (
    closely_added,
    compensated_add,
    compensated_sums,
    splitter,
    two_product,
)
from derive.flows.frame import Frame, own_frame, principal_frame
from derive.flows.inertia import Inertia
from derive.flows.moments import in_order
from derive.flows.preprocessing import D, S, coefficients, summed
from derive.flows.turns import quaternion_change
from derive.trace import Number, Tape, absolute, at_most, named, number, repeat, sqrt

AXES = "xyz"
CYCLIC = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
PASSES = 40
QUARTER = Fraction(1, 4)
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
    factor = splitter(time_step / time_step)
    for (i, j, k), axis in zip(CYCLIC, AXES, strict=True):
        asymmetry = named(
            f"asymmetry_{axis}", (moments[j] - moments[k]) / moments[i], "(I_j - I_k) / I_i"
        )
        half = time_step * Fraction(1, 2) * ratios[i]
        gain = s * asymmetry / (ratios[j] * ratios[k]) / (time_step * Fraction(1, 4))
        double, error = two_product(gain, half, factor)
        plan += [
            (f"half_{axis}", half, "half a time step, times I / It of the modified body, s"),
            (f"gain_{axis}", gain, "change of omega by two components of c, rad/s"),
            (f"excess_{axis}", -error / half, "what gain lacks of twice couple over half, rad/s"),
            (f"couple_{axis}", double * Fraction(1, 2), "(It_j - It_k) / It_i"),
        ]
    couple = plan[3][1] * plan[7][1] * Fraction(1, 2)
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
        turn = [plan[f"turn_{axis}"] for axis in AXES]
        change = quaternion_change(attitude, plan["less"], turn)
        return compensated_sums(attitude, omega, change, [number(0)] * 3, remainder)
    if body.kind == "axisymmetric":
        less, turn, faster = change_of_revolution(body, plan, omega)
        change = quaternion_change(attitude, less, turn)
        return compensated_sums(attitude, omega, change, faster, remainder)
    axes = _axes(body)
    c, al = _solved(tape, plan, axes.along(omega))
    less, turn = _turn(c)
    change = quaternion_change(attitude, less, axes.back(turn))
    products = [c[j] * c[k] / al for _, j, k in CYCLIC]
    faster, low = (axes.back(_scaled(plan, name, products)) for name in ("gain", "excess"))
    sums = [compensated_add(*x) for x in zip(attitude, change, remainder[:4], strict=True)]
    sums += [closely_added(*x) for x in zip(omega, faster, low, remainder[4:], strict=True)]
    after = [x for x, _ in sums]
    return after[:4], after[4:], [r for _, r in sums]


def _scaled(plan: Mapping[str, Number], name: str, vector: Vector) -> list[Number]:
    return [plan[f"{name}_{axis}"] * x for axis, x in zip(AXES, vector, strict=True)]


def _turn(c: Vector) -> tuple[Number, list[Number]]:
    """Return the turn (1, c)/sqrt(1 + |c|^2): one less its scalar, without cancellation."""
    size = c[0] * c[0] + c[1] * c[1] + c[2] * c[2]
    root = sqrt(1 + size)
    inverse = 1 / root
    return size * inverse / (1 + root), [x * inverse for x in c]


def _solved(tape: Tape, plan: Mapping[str, Number], omega: Vector) -> tuple[list[Number], Number]:
    """Return c and al: for a known third component the rest is explicit, so one is sought.

    With D = 1/2 - e1 e2 c3^2/2, P = W1 + e1 W2 c3, Q = W2 + e2 W1 c3 and k = 1 + c3^2, the first
    two equations and al = 1 + |c|^2 give c1 = A P, c2 = A Q, al = 2 A D with
    A = k/(D + sqrt(D^2 - k (P^2 + Q^2))). The third is left for Newton's rule, its slope taken at
    c = W. A change d leaves an error of |W|^3 d: it ends when that is below rounding.
    """
    W, (e1, e2, e3) = _scaled(plan, "half", omega), (plan[f"couple_{axis}"] for axis in AXES)
    e1W2, e2W1, twice = e1 * W[1], e2 * W[0], W[2] + W[2]
    factor = 1 / (1 - (twice * W[2] + e3 * (e1W2 * W[1] + e2W1 * W[0])))
    size = W[0] * W[0] + W[1] * W[1] + W[2] * W[2]
    shrinks = size * sqrt(size)

    def one_pass(c: list[Number]) -> tuple[list[Number], Number]:
        square = c[2] * c[2]
        D, k = Fraction(1, 2) - plan["couple"] * square, 1 + square
        P, Q = W[0] + e1W2 * c[2], W[1] + e2W1 * c[2]
        A = k / (D + sqrt(D * D - k * (P * P + Q * Q)))
        c1, c2 = A * P, A * Q
        step = (A * D * twice + e3 * (c1 * c2) - c[2]) * factor
        more = A * step
        then = [c1 + e1W2 * more, c2 + e2W1 * more, c[2] + step]
        return then, at_most(QUARTER + absolute(step) * shrinks, QUARTER)

    start = W[2] + (size * W[2] + e3 * ((W[0] + e1W2 * W[2]) * (W[1] + e2W1 * W[2])))
    c = repeat(tape, PASSES, [W[0], W[1], start], one_pass)
    return _as_it_stands((e1, e2, e3), W, c)


def _as_it_stands(e: Vector, W: Vector, c: Vector) -> tuple[list[Number], Number]:
    """Return c and al after the equations as they stand: what is left of them must not be biased.

    Invariants drift with the part of the residual that does not change its sign. Rounding of the
    sums here does; that of D, which hardly changes while the body spins, would not.
    """
    al = 1 + (c[0] * c[0] + c[1] * c[1] + c[2] * c[2])
    aW = [al * x for x in W]
    c3 = aW[2] + e[2] * (c[0] * c[1])
    c2 = aW[1] + e[1] * (c3 * (aW[0] + e[0] * (c[1] * c3)))
    c1 = aW[0] + e[0] * (c2 * c3)
    return [c1, c2, aW[2] + e[2] * (c1 * c2)], al
