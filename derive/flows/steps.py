"""Steps of a scene's state, and their derivatives, as programs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from derive.flows.lie import lie_step
from derive.flows.matrices import Matrix, beside, compressed
from derive.flows.runge_kutta import Row, Stages, Step, stages, step
from derive.flows.sensitivity import Back, by_errors, step_slopes
from derive.flows.signs import with_signs_moved
from derive.flows.system import System, next_of, slopes_of, tape_for
from derive.program import Operand, Program, Quantity
from derive.trace import Tape, needed

RK4 = "One classic Runge-Kutta step (order 4)"


@dataclass(frozen=True)
class Slopes:
    """Derivatives of what a step returns, with the names of their rows and columns."""

    matrix: Matrix
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    says: str


def step_rk4(system: System) -> Program:
    """Return one classic Runge-Kutta step (order 4): the state after ``time_step``."""
    tape = tape_for(system)
    after = step(system, stages(tape, system)).after
    return _program("step_rk4", f"{RK4}.", (tape, system, after), None)


def step_lie(system: System) -> Program:
    """Return one commutator-free Lie-group step (order 4); the state must have a quaternion."""
    tape = tape_for(system)
    says = "One commutator-free Lie-group step: the attitude turns by exponentials (order 4)."
    return _program("step_lie", says, (tape, system, lie_step(tape, system)), None)


def step_rk4_jacobian(system: System) -> Program:
    """Return the step with its derivatives by the state and by the inputs."""
    tape, after, back = _with_slopes(system, step_slopes)
    slopes = Slopes(
        beside(back.state, back.rest),
        _next(system.names),
        system.columns,
        "nonzeros of the Jacobian, in compressed-column order",
    )
    says = f"{RK4}, with its Jacobian."
    return _program("step_rk4_jacobian", says, (tape, system, after), slopes)


def step_rk4_sensitivity(system: System) -> Program:
    """Return the step with its derivatives by what ``system.slopes`` has beside the states."""
    tape, after, back = _with_slopes(system, step_slopes)
    slopes = Slopes(
        back.rest,
        _next(system.names),
        system.columns[len(system.names) :],
        "nonzeros of the derivatives by the parameters, in compressed-column order",
    )
    says = f"{RK4}, with its derivatives by the parameters."
    return _program("step_rk4_sensitivity", says, (tape, system, after), slopes)


def step_rk4_tangent(system: System) -> Program:
    """Return the step with its derivatives over the tangent space: three errors of attitude.

    An error delta (3, rad, body axes) stands for the attitude q exp(delta / 2), before and after.
    """
    tape, after, back = _with_slopes(system, by_errors)
    rows = _with_errors(system)
    slopes = Slopes(
        beside(back.state, back.rest),
        _next(rows),
        (*rows, *system.columns[len(system.names) :]),
        "nonzeros of the Jacobian over attitude errors delta, q exp(delta / 2), "
        "in compressed-column order",
    )
    says = f"{RK4}, with its Jacobian over the tangent space of the attitude."
    return _program("step_rk4_tangent", says, (tape, system, after), slopes)


def _with_slopes(
    system: System, slopes: Callable[[System, Stages, Step], Back]
) -> tuple[Tape, Row, Back]:
    slopes_of(system)  # a step without derivatives would be traced without them
    tape = tape_for(system)
    at = stages(tape, system)
    made = step(system, at)
    return tape, made.after, slopes(system, at, made)


def _next(names: Sequence[str]) -> tuple[str, ...]:
    return tuple(f"{name}_next" for name in names)


def _with_errors(system: System) -> tuple[str, ...]:
    """Return the names of the states, three errors for the attitude."""
    attitude = system.place("attitude") or slice(0)
    errors = tuple(f"attitude_error_{axis}" for axis in "xyz")
    return (*system.names[: attitude.start], *errors, *system.names[attitude.stop :])


def _program(
    name: str, says: str, traced: tuple[Tape, System, Row], slopes: Slopes | None
) -> Program:
    tape, system, after = traced
    outputs = tuple(next_of(q) for q in system.states)
    results: list[Operand] = [x.operand for x in after]
    sparsity = None
    if slopes is not None:
        pattern, nonzeros = compressed(slopes.matrix, slopes.rows, slopes.columns)
        parts = tuple(f"d({pattern.rows[i]})/d({pattern.columns[k]})" for i, k in pattern.places())
        size = (len(parts),)
        outputs += (Quantity("jacobian", parts, size, "", "", None, None, slopes.says),)
        results += [x.operand for x in nonzeros]
        sparsity = {"jacobian": pattern}
    program = Program(
        name,
        says,
        _inputs(system),
        outputs,
        needed(tape.ops, results),
        tuple(results),
        steps=system.rate.steps,
        assumptions=system.rate.assumptions,
        sparsity=sparsity,
    )
    return with_signs_moved(program, tape.prefix)


def _inputs(system: System) -> tuple[Quantity, ...]:
    """Return the constants, every state, the inputs that the rates use, and the step's length."""
    constants = tuple(q for q in system.rate.inputs if q.name == "constants")
    return (*constants, *system.states, *system.inputs, system.step)
