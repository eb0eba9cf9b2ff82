"""A commutator-free Lie-group step: the attitude turns by exponentials and never leaves the sphere.

Celledoni, Marthinsen and Owren, Future Generation Computer Systems 19 (2003) 341, the method of
order four with five exponentials, one of them used twice; what is not attitude goes by the classic
Runge-Kutta step, which is the same method on a vector space. Angular velocities are along body
axes, so exponentials multiply from the right and come in the opposite order to the paper's.
"""

from __future__ import annotations

from fractions import Fraction

from derive.flows.dependence import attitude_turns
from derive.flows.matrices import beside, identity, plus, product, zeros
from derive.flows.runge_kutta import THIRD
from derive.flows.system import System, rates_at, slopes_at
from derive.flows.varying import Varying, added, finished, turned, weighed
from derive.trace import Number, Tape

FIRST = (Fraction(1, 4), Fraction(1, 6), Fraction(1, 6), Fraction(-1, 12))
"""Weights of the stages in the first of the two last exponentials; the second has them reversed."""


def lie_step(tape: Tape, system: System) -> Varying:
    """Return the state after a step of order four, with slopes if the system has them.

    Raises ValueError if the state has no quaternion that follows an angular velocity in it.
    """
    attitude, omega = system.place("attitude"), system.place("omega")
    if attitude is None or omega is None or not attitude_turns(system):
        raise ValueError("a Lie-group step needs an attitude quaternion with its angular velocity")
    (h,) = (tape.input(c) for c in system.step.components)
    half, start = h * Fraction(1, 2), _start(tape, system)
    states, rates = [start], [_rates(tape, system, start, half)]
    for part in (1, 1, 2):
        state = added(start, weighed([part], [rates[-1]]))
        turns = [weighed([half], [one[omega]]) for one in states]
        states.append(state.replaced(attitude, _stage(tape, start[attitude], turns)))
        rates.append(_rates(tape, system, states[-1], half))
    after = added(start, weighed([THIRD, 2 * THIRD, 2 * THIRD, THIRD], rates))
    turns = [weighed([h], [state[omega]]) for state in states]
    last = [weighed(weights, turns) for weights in (FIRST, FIRST[::-1])]
    return after.replaced(attitude, finished(tape, start[attitude], last))


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
    direct = beside(zeros(n, n), [row[n:] for row in slopes])
    return Varying(rates, plus(direct, product([row[:n] for row in slopes], state.slopes)))


def _stage(tape: Tape, q: Varying, turns: list[Varying]) -> Varying:
    """Return the attitude of the stage that follows as many ``turns``, each h/2 times a rate."""
    if len(turns) < 3:
        return turned(tape, q, turns[-1])
    first, _, third = turns
    return turned(tape, turned(tape, q, first), weighed([2, -1], [third, first]))
