"""A commutator-free Lie-group step: the attitude turns by exponentials and never leaves the sphere.

Celledoni, Marthinsen and Owren, Future Generation Computer Systems 19 (2003) 341, the method of
order four with five exponentials, one of them used twice; what is not attitude goes by the classic
Runge-Kutta step, which is the same method on a vector space. Angular velocities are along body
axes, so exponentials multiply from the right and come in the opposite order to the paper's.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from derive.motion.attitude.quaternion import conjugate
from derive.motion.attitude.quaternion import product as hamilton
from derive.motion.runge_kutta.classic import THIRD
from derive.motion.runge_kutta.dependence import attitude_and_omega
from derive.motion.runge_kutta.matrices import (
    Matrix,
    NumberRow,
    beside,
    identity,
    lifted,
    plus,
    product,
    sandwich_matrix,
    zeros,
)
from derive.motion.runge_kutta.system import System, rates_at, slopes_at
from derive.motion.runge_kutta.varying import (
    Varying,
    added,
    finished,
    turned,
    weighed,
    whole_turn,
)
from derive.program.tape import Number, Tape

FIRST = (Fraction(1, 4), Fraction(1, 6), Fraction(1, 6), Fraction(-1, 12))
"""Weights of the stages in the first of the two last exponentials; the second has them reversed."""


@dataclass(frozen=True)
class Gain:
    """What a step adds to the state but for the attitude, which it turns by two ``vectors``."""

    state: Varying
    vectors: list[Varying]


def step_slopes(tape: Tape, system: System) -> tuple[NumberRow, Matrix]:
    """Return the state after a step of order four, and its slopes if the system has them.

    Raises ValueError if the state has no quaternion that follows an angular velocity in it.
    """
    attitude, _ = _places(system)
    start = _start(tape, system)
    gain = _gain(tape, system, start)
    turned = finished(start[attitude], whole_turn(gain.vectors))
    found = added(start, gain.state).replaced(attitude, turned)
    return found.values, found.slopes


def after(tape: Tape, system: System) -> NumberRow:
    """Return the state after a step."""
    return step_slopes(tape, system)[0]


def by_errors(tape: Tape, system: System) -> tuple[NumberRow, Matrix]:
    """Return the state after a step and its slopes with three errors of attitude for its parts."""
    attitude, _ = _places(system)
    begin = _start(tape, system)
    start = Varying(begin.values, lifted(begin.values[attitude], attitude, begin.slopes))
    gain = _gain(tape, system, start)
    turn = whole_turn(gain.vectors)
    found = added(start, gain.state).replaced(attitude, finished(start[attitude], turn))
    errors = [list(row) for row in turn.slopes]
    for row, entries in zip(
        errors, sandwich_matrix(conjugate(turn.values), turn.values), strict=True
    ):
        for k, entry in enumerate(entries, attitude.start):
            row[k] = row[k] + entry
    rows = [*found.slopes[: attitude.start], *errors, *found.slopes[attitude.stop :]]
    return found.values, rows


def increments(tape: Tape, system: System) -> tuple[NumberRow, NumberRow]:
    """Return the state at the start of a step, and what it adds, an attitude not yet normalised."""
    attitude, _ = _places(system)
    start = _start(tape, system)
    gain = _gain(tape, system, start)
    w, *vector = whole_turn(gain.vectors).values
    found = gain.state.values
    found[attitude] = hamilton(start.values[attitude], [w - 1, *vector])
    return start.values, found


def _places(system: System) -> tuple[slice, slice]:
    places = attitude_and_omega(system)
    if places is None:
        raise ValueError("a Lie-group step needs an attitude quaternion with its angular velocity")
    return places


def _gain(tape: Tape, system: System, start: Varying) -> Gain:
    attitude, omega = _places(system)
    (h,) = (tape.input(c) for c in system.step.components)
    half = h * Fraction(1, 2)
    states, rates = [start], [_rates(tape, system, start, half)]
    for part in (1, 1, 2):
        state = added(start, weighed([part], [rates[-1]]))
        turns = [_turn(system, 1, half, one[omega]) for one in states]
        states.append(state.replaced(attitude, _stage(start[attitude], turns)))
        rates.append(_rates(tape, system, states[-1], half))
    turns = [_turn(system, 2, h, state[omega]) for state in states]
    vectors = [weighed(weights, turns) for weights in (FIRST, FIRST[::-1])]
    return Gain(weighed([THIRD, 2 * THIRD, 2 * THIRD, THIRD], rates), vectors)


def _turn(system: System, part: int, time: Number, omega: Varying) -> Varying:
    """Return omega times a time of so many halves of the step: a column may be by h/2."""
    found = weighed([time], [omega])
    if not system.column:
        return found
    grown = [
        [*row[:-1], row[-1] + part * w] for row, w in zip(found.slopes, omega.values, strict=True)
    ]
    return Varying(found.values, grown)


def _start(tape: Tape, system: System) -> Varying:
    """Return the state that the tape is given, its slopes by the columns of the Jacobian."""
    values, n = [tape.input(c) for c in system.names], len(system.names)
    if system.slopes is None:
        return Varying(values, zeros(n, 0))
    return Varying(values, beside(identity(n), zeros(n, len(system.columns) - n)))


def _rates(tape: Tape, system: System, state: Varying, factor: Number) -> Varying:
    """Return ``factor`` times the rates at a state."""
    if system.slopes is None:
        return Varying(rates_at(tape, system, state.values, factor), state.slopes)
    n = len(state.values)
    rates, slopes = slopes_at(tape, system, state.values, factor)
    rest = [row[n:] for row in slopes]
    direct = beside(zeros(n, len(state.slopes[0]) - len(rest[0])), rest)
    return Varying(rates, plus(direct, product([row[:n] for row in slopes], state.slopes)))


def _stage(q: Varying, turns: list[Varying]) -> Varying:
    """Return the attitude of the stage that follows as many ``turns``, each h/2 times a rate."""
    if len(turns) < 3:
        return turned(q, turns[-1])
    first, _, third = turns
    return turned(turned(q, first), weighed([2, -1], [third, first]))
