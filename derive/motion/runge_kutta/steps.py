"""Steps of a scene's state, and their derivatives, as programs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from derive.motion.runge_kutta.carried import carried_on, remainder
from derive.motion.runge_kutta.lie import lie_errors, lie_increments, lie_step
from derive.motion.runge_kutta.matrices import Matrix, beside
from derive.motion.runge_kutta.runge_kutta import Row, Stages, Step, increments, stages, step
from derive.motion.runge_kutta.sensitivity import Back, by_errors, step_slopes
from derive.motion.runge_kutta.step_program import (
    Slopes,
    Traced,
    moved,
    moved_with_remainder,
    moved_with_slopes,
    names_with_errors,
    next_names,
    program_of,
)
from derive.motion.runge_kutta.system import System, slopes_of, tape_for
from derive.program.program import Program
from derive.program.tape import Tape

RK4 = "One classic Runge-Kutta step (order 4)"
LIE = "One commutator-free Lie-group step: the attitude turns by exponentials (order 4)"
ERRORS = "its Jacobian over the tangent space of the attitude"
CARRYING = "carrying what rounding leaves"


def step_rk4(system: System) -> Program:
    """Return one classic Runge-Kutta step (order 4): the state after ``time_step``."""
    tape = tape_for(system)
    after = step(system, stages(tape, system)).after
    return program_of("step_rk4", f"{RK4}.", moved(tape, system, after))


def step_rk4_compensated(system: System) -> Program:
    """Return the step with sums that carry a remainder from call to call."""
    tape, plain = tape_for(system), replace(system, slopes=None)
    at = stages(tape, plain)
    made = _carried(tape, plain, at.start, increments(plain, at))
    return program_of("step_rk4_compensated", f"{RK4}, {CARRYING}.", made)


def step_rk4_jacobian(system: System) -> Program:
    """Return the step with its derivatives by the state and by the inputs."""
    tape, after, back = _with_slopes(system, step_slopes)
    slopes = _by_columns(system, beside(back.state, back.rest))
    made = moved_with_slopes(tape, system, after, slopes)
    return program_of("step_rk4_jacobian", f"{RK4}, with its Jacobian.", made)


def step_rk4_sensitivity(system: System) -> Program:
    """Return the step with its derivatives by what ``system.slopes`` has beside the states."""
    tape, after, back = _with_slopes(system, step_slopes)
    columns = system.columns[len(system.names) :]
    slopes = Slopes(back.rest, next_names(system.names), columns, "derivatives by the parameters")
    made = moved_with_slopes(tape, system, after, slopes)
    says = f"{RK4}, with its derivatives by the parameters."
    return program_of("step_rk4_sensitivity", says, made)


def step_rk4_tangent(system: System) -> Program:
    """Return the step with its derivatives over the tangent space: three errors of attitude.

    An error delta (3, rad, body axes) stands for the attitude q exp(delta / 2), before and after.
    """
    tape, after, back = _with_slopes(system, by_errors)
    slopes = _by_errors(system, beside(back.state, back.rest))
    made = moved_with_slopes(tape, system, after, slopes)
    return program_of("step_rk4_tangent", f"{RK4}, with {ERRORS}.", made)


def step_lie(system: System) -> Program:
    """Return one commutator-free Lie-group step (order 4); the state must have a quaternion."""
    tape, plain = tape_for(system), replace(system, slopes=None)
    made = moved(tape, plain, lie_step(tape, plain).values)
    return program_of("step_lie", f"{LIE}.", made)


def step_lie_compensated(system: System) -> Program:
    """Return the step with sums that carry a remainder from call to call."""
    tape, plain = tape_for(system), replace(system, slopes=None)
    made = _carried(tape, plain, *lie_increments(tape, plain))
    return program_of("step_lie_compensated", f"{LIE}, {CARRYING}.", made)


def step_lie_jacobian(system: System) -> Program:
    """Return the Lie-group step with its derivatives by the state and by the inputs."""
    slopes_of(system)  # a step without derivatives would be traced without them
    tape = tape_for(system)
    after = lie_step(tape, system)
    made = moved_with_slopes(tape, system, after.values, _by_columns(system, after.slopes))
    return program_of("step_lie_jacobian", f"{LIE}, with its Jacobian.", made)


def step_lie_tangent(system: System) -> Program:
    """Return the Lie-group step with its derivatives over errors of attitude, as for ``rk4``."""
    slopes_of(system)  # a step without derivatives would be traced without them
    tape = tape_for(system)
    after, slopes = lie_errors(tape, system)
    made = moved_with_slopes(tape, system, after, _by_errors(system, slopes))
    return program_of("step_lie_tangent", f"{LIE}, with {ERRORS}.", made)


def _with_slopes(
    system: System, slopes: Callable[[System, Stages, Step], Back]
) -> tuple[Tape, Row, Back]:
    slopes_of(system)  # a step without derivatives would be traced without them
    tape = tape_for(system)
    at = stages(tape, system)
    made = step(system, at)
    return tape, made.after, slopes(system, at, made)


def _by_columns(system: System, matrix: Matrix) -> Slopes:
    return Slopes(matrix, next_names(system.names), system.columns, "Jacobian")


def _by_errors(system: System, matrix: Matrix) -> Slopes:
    names = names_with_errors(system)
    columns = (*names, *system.columns[len(system.names) :])
    says = "Jacobian over attitude errors delta, q exp(delta / 2)"
    return Slopes(matrix, next_names(names), columns, says)


def _carried(tape: Tape, system: System, start: Row, gains: Row) -> Traced:
    rest = [tape.input(c) for c in remainder(system.states).components]
    return moved_with_remainder(tape, system, *carried_on(system, start, gains, rest))
