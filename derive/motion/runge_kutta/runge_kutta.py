"""One classic Runge-Kutta step of a scene's state, its attitude brought back to length one.

A principal body with a quaternion (217 operations), length of the quaternion less 1, error of the
attitude in rad after 100 s, h = 0.01 s (0.1 s) in double: normalised 2e-16, 1.2e-9 (2e-16, 1.2e-5);
left alone (215) 4e-12, 1.2e-9 (3e-7, 1.2e-5); with 10/s (1 - |q|^2) q in the kinematics (284) 2e-8,
1.2e-9 (4e-4, 2e-4), and with five times that it is unstable at 0.1 s. So one normalisation it is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

from derive.motion.attitude.quaternion import product
from derive.motion.runge_kutta.attitude_stages import Turning, norm_squared, turning
from derive.motion.runge_kutta.dependence import free_omega
from derive.motion.runge_kutta.matrices import Matrix
from derive.motion.runge_kutta.system import System, rates_at, slopes_at
from derive.program.operations import sqrt
from derive.program.tape import Number, Tape

Row = list[Number]
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
    start: Row
    states: list[Row]
    rates: list[Row]
    slopes: list[Matrix]
    by: list[Matrix]
    turn: Turning | None


@dataclass(frozen=True)
class Step:
    """The state after a step, and its quaternions' squared lengths before these became one."""

    after: Row
    lengths_squared: Row


def stages(tape: Tape, system: System) -> Stages:
    """Return the stages of the classic step (Kutta 1901) from the state that the tape is given."""
    (h,) = (tape.input(c) for c in system.step.components)
    start = [tape.input(c) for c in system.names]
    found = Stages(h, start, [], [], [], [], None)
    half = h * Fraction(1, 2)
    for part in (0, 1, 1, 2):
        moved = [g * part for g in found.rates[-1]] if part else []
        state = [y + g for y, g in zip(start, moved, strict=True)] if part else start
        _add(tape, system, found, state, half)
    omega = free_omega(system)
    if omega is None:
        return found
    return replace(found, turn=turning([state[omega] for state in found.states], h))


def _add(tape: Tape, system: System, found: Stages, state: Row, half: Number) -> None:
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


def increments(system: System, stages: Stages) -> Row:
    """Return what the step adds: (k1 + 2 k2 + 2 k3 + k4) h / 6, an attitude not yet normalised."""
    found = [(a + 2 * (b + c) + d) * THIRD for a, b, c, d in zip(*stages.rates, strict=True)]
    attitude = system.place("attitude")
    if attitude is not None and stages.turn is not None:
        found[attitude] = product(stages.start[attitude], stages.turn.increment)
    return found


def step(system: System, stages: Stages) -> Step:
    """Return the state after the step, its quaternions of length one."""
    after = [y + d for y, d in zip(stages.start, increments(system, stages), strict=True)]
    lengths_squared = []
    for place in system.quaternions:
        after[place], squared = unit(after[place])
        lengths_squared.append(squared)
    return Step(after, lengths_squared)


def unit(q: Row) -> tuple[Row, Number]:
    """Return a quaternion (4) near the sphere made of length one, and its squared length before."""
    squared = norm_squared(q)
    scale = 1 / sqrt(squared)
    return [x * scale for x in q], squared
