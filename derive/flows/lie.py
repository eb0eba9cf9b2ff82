"""A commutator-free Lie-group step: the attitude turns by exponentials and never leaves the sphere.

Celledoni, Marthinsen and Owren, Future Generation Computer Systems 19 (2003) 341, the method of
order four with five exponentials, one of them used twice; what is not attitude goes by the classic
Runge-Kutta step, which is the same method on a vector space. Angular velocities are along body
axes, so exponentials multiply from the right and come in the opposite order to the paper's.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from derive.flows.dependence import attitude_turns
from derive.flows.runge_kutta import THIRD, Row, unit
from derive.flows.system import System, rates_at
from derive.rotations.quaternion import exponential, product
from derive.trace import Number, Tape

FIRST = (Fraction(1, 4), Fraction(1, 6), Fraction(1, 6), Fraction(-1, 12))
"""Weights of the stages in the first of the two last exponentials; the second has them reversed."""


def lie_step(tape: Tape, system: System) -> Row:
    """Return the state after a step of order four.

    Raises ValueError if the state has no quaternion that follows an angular velocity in it.
    """
    attitude, omega = system.place("attitude"), system.place("omega")
    if attitude is None or omega is None or not attitude_turns(system):
        raise ValueError("a Lie-group step needs an attitude quaternion with its angular velocity")
    (h,) = (tape.input(c) for c in system.step.components)
    half, start = h * Fraction(1, 2), [tape.input(c) for c in system.names]
    states, rates = [start], [rates_at(tape, system, start, half)]
    for part in (1, 1, 2):
        state = [y + g * part for y, g in zip(start, rates[-1], strict=True)]
        turns = [[w * half for w in one[omega]] for one in states]
        state[attitude] = _stage(tape, start[attitude], turns)
        states.append(state)
        rates.append(rates_at(tape, system, state, half))
    after = [y + (a + 2 * (b + c) + d) * THIRD for y, a, b, c, d in zip(start, *rates, strict=True)]
    turns = [[w * h for w in state[omega]] for state in states]
    after[attitude] = unit(_last(tape, start[attitude], turns))[0]
    return after


def _stage(tape: Tape, q: Row, turns: Sequence[Row]) -> Row:
    """Return the attitude of the stage that follows as many ``turns``, each h/2 times a rate."""
    if len(turns) < 3:
        return product(q, exponential(tape, turns[-1]))
    first, _, third = turns
    rest = [2 * c - a for a, c in zip(first, third, strict=True)]
    return product(product(q, exponential(tape, first)), exponential(tape, rest))


def _last(tape: Tape, q: Row, turns: Sequence[Row]) -> Row:
    """Return the attitude after the step: two exponentials, the earlier stages first."""
    for weights in (FIRST, FIRST[::-1]):
        total = [_weighed(weights, each) for each in zip(*turns, strict=True)]
        q = product(q, exponential(tape, total))
    return q


def _weighed(weights: Sequence[Fraction], values: Sequence[Number]) -> Number:
    """Return a sum of four with the two in the middle of one weight."""
    first, second, third, fourth = values
    return weights[0] * first + weights[1] * (second + third) + weights[3] * fourth
