"""Turns of a body about its own axes: the pieces that a splitted step is made of.

A turn is made from the tangent of a quarter of its angle, a fraction of polynomials: a third of the
work of a sine and a cosine of libm, and lengths are kept to rounding whatever the angle.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from derive.program.operations import horner
from derive.program.tape import Number, Vector, number

CYCLIC = ((0, 1, 2), (1, 2, 0), (2, 0, 1))

# tan(x)/x is the first over the second, by powers of x^2: six levels of Lambert's fraction. Its
# relative error is x^12/1.4e9: below rounding for turns up to 1.1 rad, 3e-11 at half a revolution.
NUMERATOR = (Fraction(1), Fraction(-4, 33), Fraction(1, 495))
DENOMINATOR = (Fraction(1), Fraction(-5, 11), Fraction(2, 99), Fraction(-1, 10395))


@dataclass(frozen=True)
class State:
    """How far a body has turned since the step began, and its momentum now.

    less, turn : the attitude change is the quaternion (1 - less, turn), along body axes
    mu         : (3,) angular momentum along body axes over the intermediate moment, rad/s
    gain       : (3,) what was added to mu since the step began, without the roundings of mu
    """

    less: Number
    turn: list[Number]
    mu: list[Number]
    gain: list[Number]


def unturned(mu: Vector) -> State:
    """Return the state in which a step begins."""
    zero = number(0)
    return State(zero, [zero] * 3, list(mu), [zero] * 3)


def tangent(square: Number) -> Number:
    """Return tan(x)/x from x^2."""
    top = horner([number(c) for c in NUMERATOR], square)
    return top / horner([number(c) for c in DENOMINATOR], square)


def turn_about(axis: int, quarter: Number, state: State) -> State:
    """Return the state after the body turned about one of its axes, by four times ``quarter``.

    A turn in a plane is three shears, by tan(half), sin and tan(half): whatever is rounded, areas
    stay, so lengths cannot drift (Buneman, SIAM J. Sci. Stat. Comput. 7 (1986) 624).
    """
    i, j, k = CYCLIC[axis]
    turn, mu, gain = list(state.turn), list(state.mu), list(state.gain)
    t = quarter * tangent(quarter * quarter)
    twice = t + t
    s = twice / (1 + t * t)
    less = state.less + t * turn[i]
    turn[i] = turn[i] + (s - s * less)
    less = less + t * turn[i]
    turn[k] = turn[k] - t * turn[j]
    turn[j] = turn[j] + s * turn[k]
    turn[k] = turn[k] - t * turn[j]

    def add(place: int, more: Number) -> None:
        mu[place], gain[place] = mu[place] + more, gain[place] + more

    # Half the angle twice; the two shears in the middle are one.
    add(j, t * mu[k])
    add(k, -(s * mu[j]))
    add(j, twice * mu[k])
    add(k, -(s * mu[j]))
    add(j, t * mu[k])
    return State(less, turn, mu, gain)


def turn_with(quarter: Number, state: State) -> State:
    """Return the state after a turn about the angular momentum: four times ``quarter`` mu.

    It stands still in space, so its components along body axes stay what they are.
    """
    mu = state.mu
    square = quarter * quarter * (mu[0] * mu[0] + mu[1] * mu[1] + mu[2] * mu[2])
    t = tangent(square)
    across = square * (t * t)
    f = quarter * ((t + t) / (1 + across))
    less, turn = (across + across) / (1 + across), [f * m for m in mu]
    change = quaternion_change([1 - state.less, *state.turn], less, turn)
    vector = [v + d for v, d in zip(state.turn, change[1:], strict=True)]
    return State(state.less - change[0], vector, mu, state.gain)


def kicked(push: Vector, state: State) -> State:
    """Return the state after something was added to the momentum at once."""
    mu = [m + p for m, p in zip(state.mu, push, strict=True)]
    gain = [g + p for g, p in zip(state.gain, push, strict=True)]
    return State(state.less, state.turn, mu, gain)


def quaternion_change(
    attitude: Sequence[Number], less: Number, v: Sequence[Number]
) -> list[Number]:
    """Return what an attitude gains when it is multiplied by the quaternion (1 - less, v)."""
    q0, q1, q2, q3 = attitude
    a, b, c = v
    return [
        -(less * q0 + q1 * a + q2 * b + q3 * c),
        q0 * a + q2 * c - q3 * b - less * q1,
        q0 * b + q3 * a - q1 * c - less * q2,
        q0 * c + q1 * b - q2 * a - less * q3,
    ]
