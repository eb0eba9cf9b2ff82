"""One classic Runge-Kutta step of a scene's state, its attitude brought back to length one.

A principal body with a quaternion (217 operations), length of the quaternion less 1, error of the
attitude in rad after 100 s, h = 0.01 s (0.1 s) in double: normalised 2e-16, 1.2e-9 (2e-16, 1.2e-5);
left alone (215) 4e-12, 1.2e-9 (3e-7, 1.2e-5); with 10/s (1 - |q|^2) q in the kinematics (284) 2e-8,
1.2e-9 (4e-4, 2e-4), and with five times that it is unstable at 0.1 s. So one normalisation it is.

Where nothing in the stages knows the attitude, with b_i = h W_i / 4, W_i the angular velocities of
the stages, the classic step from q0 is q0 P,

    3 (P - 1) = b1 R1 + 2 b2 R2 + 2 b3 R3 + b4,   R1 = 1 + 2 b2 R2,  R2 = 1 + b3 R3,  R3 = 1 + b4,

a product of quaternions in which q0 has no part. A change of the W_i turns the result by the
vector Im(conj(P) dP) / |P|^2 = sum K_i dW_i, in axes fixed in the body after the step.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from derive.motion.attitude.quaternion import conjugate, norm_squared, product
from derive.motion.runge_kutta.dependence import free_omega
from derive.motion.runge_kutta.matrices import Matrix, NumberRow, sandwich_matrix
from derive.motion.runge_kutta.system import System, rates_at, slopes_at
from derive.program.operations import sqrt
from derive.program.tape import Number, Tape, number

THIRD = Fraction(1, 3)


@dataclass(frozen=True)
class Stages:
    """The four stages of a step from ``start``.

    rates  : (4, n) times h/2
    slopes : (4, n, n) Jacobians by the states, times h/2; none if there are no derivatives
    by     : (4, n, m) Jacobians by what else there is, times h/2
    turn   : how the attitude turns if nothing that turns it knows it, else None
    """

    time_step: Number
    start: NumberRow
    states: list[NumberRow]
    rates: list[NumberRow]
    slopes: list[Matrix]
    by: list[Matrix]
    turn: StageTurns | None


@dataclass(frozen=True)
class StageTurns:
    """Quarter-step vectors of the stages, what multiplies each from the right, and P - 1."""

    quarters: list[NumberRow]
    rights: list[NumberRow]
    increment: NumberRow


def stages(tape: Tape, system: System) -> Stages:
    """Return the stages of the classic step (Kutta 1901) from the state that the tape is given."""
    (h,) = (tape.input(c) for c in system.step.components)
    start = [tape.input(c) for c in system.names]
    found = Stages(h, start, [], [], [], [], None)
    half = h * Fraction(1, 2)
    for part in (0, 1, 1, 2):
        gains = [g * part for g in found.rates[-1]] if part else []
        _add(tape, system, found, added(start, gains) if part else start, half)
    omega = free_omega(system)
    if omega is None:
        return found
    return replace(found, turn=turning([state[omega] for state in found.states], h))


def _add(tape: Tape, system: System, found: Stages, state: NumberRow, half: Number) -> None:
    """Add a stage at ``state``; the program of the slopes gives the rates as well."""
    n = len(state)
    found.states.append(state)
    if system.slopes is None:
        found.rates.append(rates_at(tape, system, state, half))
        return
    rates, slopes = slopes_at(tape, system, state, half)
    found.rates.append(rates)
    found.slopes.append([row[:n] for row in slopes])
    found.by.append([row[n:] for row in slopes])


def added(a: Sequence[Number], b: Sequence[Number]) -> NumberRow:
    """Return the sum of two rows of numbers, as of two quaternions."""
    return [x + y for x, y in zip(a, b, strict=True)]


def gains_of(system: System, stages: Stages) -> NumberRow:
    """Return what the step adds: (k1 + 2 k2 + 2 k3 + k4) h / 6, an attitude not yet normalised."""
    found = [(a + 2 * (b + c) + d) * THIRD for a, b, c, d in zip(*stages.rates, strict=True)]
    attitude = system.quaternion
    if attitude is not None and stages.turn is not None:
        found[attitude] = product(stages.start[attitude], stages.turn.increment)
    return found


def increments(tape: Tape, system: System) -> tuple[NumberRow, NumberRow]:
    """Return the state at the start of a step, and what it adds, an attitude not yet normalised."""
    at = stages(tape, system)
    return at.start, gains_of(system, at)


def after(tape: Tape, system: System) -> NumberRow:
    """Return the state after the step, its quaternions of length one."""
    return normalised(system, stages(tape, system))[0]


def normalised(system: System, stages: Stages) -> tuple[NumberRow, NumberRow]:
    """Return the state after the step, and its quaternions' squared lengths before normalising."""
    found, squares = added(stages.start, gains_of(system, stages)), list[Number]()
    for place in system.quaternions:
        squares.append(norm_squared(found[place]))
        scale = 1 / sqrt(squares[-1])
        found[place] = [x * scale for x in found[place]]
    return found, squares


def one_and(q: Sequence[Number]) -> NumberRow:
    """Return 1 + q."""
    return [1 + q[0], *q[1:]]


def turning(omegas: Sequence[Sequence[Number]], time_step: Number) -> StageTurns:
    """Return how a step turns, from the angular velocities (4 stages of 3, body axes, rad/s)."""
    quarter = time_step * Fraction(1, 2) * Fraction(1, 2)
    b1, b2, b3, b4 = ([number(0), *(w * quarter for w in omega)] for omega in omegas)
    third = product(b3, one_and(b4))
    twice_third = [x + x for x in third]
    right2 = [2 + twice_third[0], *twice_third[1:]]
    twice_second = product(b2, right2)
    right1 = one_and(twice_second)
    total = added(added(added(product(b1, right1), twice_second), twice_third), b4)
    increment = [x * THIRD for x in total]
    rights = [right1, right2, one_and(b4), [number(1), *[number(0)] * 3]]
    return StageTurns([b1, b2, b3, b4], rights, increment)


def turn_slopes(turn: StageTurns, scale: Number) -> list[Matrix]:
    """Return K_1 ... K_4 (3, 3) but for a factor: ``scale`` stands for h / (12 |P|^2)."""
    b1, b2, b3, _ = turn.quarters
    whole = [x * scale for x in conjugate(one_and(turn.increment))]
    left2 = added(whole, product(whole, b1))
    left3 = [x + x for x in added(whole, product(left2, b2))]
    left4 = added(whole, product(left3, b3))
    lefts = (whole, left2, left3, left4)
    return [sandwich_matrix(left, right) for left, right in zip(lefts, turn.rights, strict=True)]
