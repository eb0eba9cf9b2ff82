"""The implicit equations of a Moser-Veselov step, solved so that no rounding keeps its sign.

c_i = al W_i + e_i c_j c_k with al = 1 + |c|^2: c is tan(angle/2) times the axis of the step's turn.
"""

from collections.abc import Mapping
from fractions import Fraction

from derive.program.operations import absolute, at_most, sqrt
from derive.program.recorded import repeat
from derive.program.tape import Number, Tape, Vector

AXES = "xyz"
PASSES = 16  # three or four suffice; at one radian a step, ten
QUARTER = Fraction(1, 4)


def scaled(plan: Mapping[str, Number], name: str, vector: Vector) -> list[Number]:
    """Return a vector, each component times the plan's value of that name for its axis."""
    return [plan[f"{name}_{axis}"] * x for axis, x in zip(AXES, vector, strict=True)]


def turn_of(c: Vector) -> tuple[Number, list[Number]]:
    """Return the turn (1, c)/sqrt(1 + |c|^2): one less its scalar, without cancellation."""
    size = c[0] * c[0] + c[1] * c[1] + c[2] * c[2]
    root = sqrt(1 + size)
    inverse = 1 / root
    return size * inverse / (1 + root), [x * inverse for x in c]


def solved_step(
    tape: Tape, plan: Mapping[str, Number], omega: Vector, remainder: Vector
) -> tuple[list[Number], Number]:
    """Return c and al: for a known third component the rest is explicit, so one is sought.

    With D = 1/2 - e1 e2 c3^2/2, P = W1 + e1 W2 c3, Q = W2 + e2 W1 c3 and k = 1 + c3^2, the first
    two equations and al = 1 + |c|^2 give c1 = A P, c2 = A Q, al = 2 A D with
    A = k/(D + sqrt(D^2 - k (P^2 + Q^2))). The third is left for Newton's rule, its slope taken at
    c = W. A change d leaves an error of |W|^3 d: it ends when that is below rounding.
    """
    W, (e1, e2, e3) = scaled(plan, "half", omega), (plan[f"couple_{axis}"] for axis in AXES)
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
    return _as_it_stands(plan, W, c, scaled(plan, "half", remainder))


def _as_it_stands(
    plan: Mapping[str, Number], W: Vector, c: Vector, low: Vector
) -> tuple[list[Number], Number]:
    """Return c and al after the equations as they stand; ``low`` is what W lacks of its remainder.

    What is left of an equation moves the invariants, and they drift if its mean is not zero. The
    rounding of these sums has none; that of D would, and so would what omega has not yet taken up.
    """
    al = 1 + (c[0] * c[0] + c[1] * c[1] + c[2] * c[2])
    aW = [al * x for x in W]

    def component(i: int, product: Number) -> Number:
        e, short = plan[f"couple_{AXES[i]}"], plan[f"couple_low_{AXES[i]}"]
        return aW[i] + (e * product + (low[i] + short * product))

    e1, e3 = plan["couple_x"], plan["couple_z"]
    c3 = aW[2] + e3 * (c[0] * c[1])
    c2 = component(1, c3 * (aW[0] + e1 * (c[1] * c3)))
    c1 = component(0, c2 * c3)
    return [c1, c2, component(2, c1 * c2)], al
