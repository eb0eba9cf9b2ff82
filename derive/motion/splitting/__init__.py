"""The two-rotation splitting: a rotation as turns about two body axes and one in space.

With b the intermediate axis the kinetic energy is |l|^2/(2 I_b) plus a square of l_a and one of
l_c. The first commutes with the others and is one turn about l; the others turn the body about the
axes a and c. A body of revolution needs one of the two only, and the step is then exact.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from derive.motion.axes import BodyAxes, axes_of
from derive.motion.compensated import compensated_sums
from derive.motion.exact.inertia import Inertia
from derive.motion.splitting.schemes import NYSTROEM6, S6, S10, STRANG, Scheme
from derive.motion.splitting.turns import (
    State,
    kicked,
    quaternion_change,
    turn_about,
    turn_with,
    unturned,
)
from derive.program.tape import Number, Tape, Vector, named, number

SCHEMES = {2: STRANG, 4: S6, 6: S10}
Moment = Callable[[list[Number]], Vector]
Flow = Callable[[Fraction, State], State]


@dataclass(frozen=True)
class Pieces:
    """The flows that a step is made of, each for a part of the step.

    spin_a, spin_c : turns about the body axes a and c      swing : turn about the momentum
    kick           : what the moment adds to the momentum
    """

    spin_a: Flow
    spin_c: Flow
    swing: Flow
    kick: Flow


@dataclass(frozen=True)
class Start:
    """Where a step begins, and how far it leads.

    attitude : (4,) quaternion, scalar first, body to inertial      omega : (3,) rad/s along body
    axes      moment : of an attitude, (3,) N m along body axes; None where there is none
    time_step : s, in which the body turns by less than half a revolution
    remainder : (7,) what rounding has kept from attitude and omega, zero at first; if it is carried
    """

    attitude: Vector
    omega: Vector
    moment: Moment | None
    time_step: Number
    remainder: Vector = ()


def step_split(tape: Tape, body: Inertia, order: int, start: Start) -> list[Number]:
    """Return attitude and omega (7,) one time step later, by a splitting of order 2, 4 or 6.

    With a remainder, what rounding has kept from them follows (7,).
    Source: Fasso, J. Comput. Phys. 189 (2003) 527, for the pieces; coefficients: see ``schemes``.
    """
    axes = axes_of(tape, body)
    end = _end(axes, body, order, start)
    turn = quaternion_change(start.attitude, end.less, axes.back(end.turn))
    if start.remainder:
        gains = [*turn, *_of_omega(axes, end.gain)]
        return compensated_sums([*start.attitude, *start.omega], gains, start.remainder)
    after = [q + change for q, change in zip(start.attitude, turn, strict=True)]
    gains = _of_omega(axes, end.gain)
    return after + [w + change for w, change in zip(start.omega, gains, strict=True)]


def _end(axes: BodyAxes, body: Inertia, order: int, start: Start) -> State:
    """Return the state in which a step ends."""
    ratios = _ratios(axes)
    begin = unturned([r * w for r, w in zip(ratios, axes.along(start.omega), strict=True)])
    pieces = _pieces(body, axes, start)
    closed = body.kind in ("axisymmetric", "spherical")
    if start.moment is not None:
        scheme = NYSTROEM6 if closed and order == 4 else SCHEMES[order]
        return _kicked(pieces, scheme, begin)
    if closed:
        return _free(pieces, Fraction(1), (Fraction(1), Fraction(0)), begin)
    return _spun(pieces, SCHEMES[order], pieces.swing(Fraction(1), begin))


def _ratios(axes: BodyAxes) -> list[Number]:
    return [
        named(f"ratio_{axis}", _over(m, axes.moments[1]), f"moment about {axis} over that about b")
        for axis, m in zip("abc", axes.moments, strict=True)
    ]


def _over(a: Number, b: Number) -> Number:
    return number(1) if a == b else a / b


def _of_omega(axes: BodyAxes, change: Vector) -> list[Number]:
    """Return the change of omega along x, y, z from that of mu along a, b, c."""
    inverse = [
        named(f"inverse_{axis}", _over(axes.moments[1], m), f"moment b over that about {axis}")
        for axis, m in zip("abc", axes.moments, strict=True)
    ]
    return axes.back([c * i for c, i in zip(change, inverse, strict=True)])


def _pieces(body: Inertia, axes: BodyAxes, start: Start) -> Pieces:
    quarter = Fraction(1, 4) * start.time_step
    middle = axes.moments[1]

    def spin(place: int) -> Flow:
        axis = "abc"[place]
        rate = (middle - axes.moments[place]) / axes.moments[place]
        factor = quarter * named(f"spin_{axis}", rate, f"(I_b - I_{axis}) / I_{axis}")
        return lambda part, state: turn_about(place, part * factor * state.mu[place], state)

    return Pieces(
        spin(0) if body.kind in ("general", "principal") else _still,
        spin(2) if body.kind != "spherical" else _still,
        lambda part, state: turn_with(part * quarter, state),
        _still if start.moment is None else _kicks(axes, start, start.moment),
    )


def _kicks(axes: BodyAxes, start: Start, moment: Moment) -> Flow:
    compliance = 1 / (axes.unit * axes.moments[1])
    push = start.time_step * named("compliance", compliance, "one over the moment about b")

    def kick(part: Fraction, state: State) -> State:
        now = quaternion_change(start.attitude, state.less, axes.back(state.turn))
        M = moment([q + d for q, d in zip(start.attitude, now, strict=True)])
        return kicked([part * push * m for m in axes.along(M)], state)

    return kick


def _still(_: Fraction, state: State) -> State:
    return state


def _spun(pieces: Pieces, scheme: Scheme, state: State) -> State:
    """Return the state after the turns about the body axes a and c by turns, a first and last."""
    state = pieces.spin_a(scheme.outer[0], state)
    for c, a in zip(scheme.inner, scheme.outer[1:], strict=True):
        state = pieces.spin_a(a, pieces.spin_c(c, state))
    return state


def _kicked(pieces: Pieces, scheme: Scheme, state: State) -> State:
    """Return the state after kicks with free motion between them."""
    state = pieces.kick(scheme.outer[0], state)
    for free, halves, after in zip(scheme.inner, scheme.halves(), scheme.outer[1:], strict=True):
        state = pieces.kick(after, _free(pieces, free, halves, state))
    return state


def _free(pieces: Pieces, part: Fraction, halves: tuple[Fraction, Fraction], state: State) -> State:
    """Return the state after free motion: the axis c between the two halves of the axis a."""
    state = pieces.spin_a(halves[0], pieces.swing(part, state))
    return pieces.spin_a(halves[1], pieces.spin_c(part, state))
