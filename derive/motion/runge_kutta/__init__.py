"""Steps by stages as programs, with their derivatives: the classic one, and one on the Lie group.

A program's inputs are constants, every state, the inputs that the rates use, and the step's length.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction

from derive.lower.order import with_values_read_soon
from derive.lower.signs import with_signs_outside
from derive.motion.compensated import compensated_sums, normalising_increment, remainder
from derive.motion.runge_kutta import classic, lie, sensitivity, unit
from derive.motion.runge_kutta.matrices import Matrix, NumberRow
from derive.motion.runge_kutta.system import System, next_of, slopes_of, tape_for
from derive.program.pattern import compressed
from derive.program.program import MATRIX, Operand, Program, Quantity, Sparsity
from derive.program.recorded import needed
from derive.program.tape import Tape


@dataclass(frozen=True)
class Method:
    """A step by stages, recorded on a tape: what is said of it, and how it is worked out.

    after      : the state (n,) after the step
    increments : the state before it and what it adds, an attitude not yet of length one; None of a
                 step that carries nothing
    slopes     : by the kind of derivatives, the state after it and its derivatives by the state and
                 what else there is, of a tangent with three errors of attitude for its four parts
    """

    says: str
    after: Callable[[Tape, System], NumberRow]
    increments: Callable[[Tape, System], tuple[NumberRow, NumberRow]] | None
    slopes: Mapping[str, Callable[[Tape, System], tuple[NumberRow, Matrix]]] = field(
        default_factory=dict
    )


METHODS: Mapping[str, Method] = {
    "rk4": Method(
        "One classic Runge-Kutta step (order 4)",
        classic.after,
        classic.increments,
        {
            "jacobian": sensitivity.step_slopes,
            "tangent": sensitivity.by_errors,
            "sensitivity": sensitivity.step_slopes,
        },
    ),
    "rk4_unit": Method(
        "One classic Runge-Kutta step that keeps the length of the quaternion (order 4)",
        unit.after,
        None,
        {
            "jacobian": unit.step_slopes,
            "tangent": unit.by_errors,
            "sensitivity": unit.step_slopes,
        },
    ),
    "lie": Method(
        "One commutator-free Lie-group step: the attitude turns by exponentials (order 4)",
        lie.after,
        lie.increments,
        {"jacobian": lie.step_slopes, "tangent": lie.by_errors},
    ),
}
KINDS = {
    "": ".",
    "compensated": ", carrying what rounding leaves.",
    "jacobian": ", with its Jacobian.",
    "tangent": ", with its Jacobian over the tangent space of the attitude.",
    "sensitivity": ", with its derivatives by the parameters.",
}
JACOBIANS = {
    "jacobian": "Jacobian",
    "tangent": "Jacobian over attitude errors delta, q exp(delta / 2)",
    "sensitivity": "derivatives by the parameters",
}


@dataclass(frozen=True)
class Recorded:
    """A step on its tape: what it is given and returns beside the state, and its numbers."""

    tape: Tape
    numbers: NumberRow
    given: tuple[Quantity, ...] = ()
    returned: tuple[Quantity, ...] = ()
    sparsity: Mapping[str, Sparsity] | None = None


def step(system: System, name: str) -> Program:
    """Return one step of a state as a program.

    name : step_rk4, step_rk4_unit or step_lie, the state after ``time_step``; with _compensated,
    sums carry a remainder from call to call; with _jacobian there are derivatives by the state and
    the inputs; with _tangent over three errors of attitude, delta in rad along body axes for
    q exp(delta / 2), before and after; with _sensitivity by what ``system.slopes`` has beside the
    states. With ``system.column`` the last column is by the step's length
    Raises ValueError for a state, or a system without slopes, of which there is no such step.
    """
    named = name.removeprefix("step_")
    method, kind = (named, "") if named in METHODS else named.rsplit("_", 1)
    how = METHODS[method]
    if kind in JACOBIANS:
        made = _with_slopes(how, system, kind)
    else:
        made = _without_slopes(how, replace(system, slopes=None), kind)
    results = tuple[Operand, ...](n.operand for n in made.numbers)
    constants = (q for q in system.rate.inputs if q.role == "constants")
    program = Program(
        name,
        f"{how.says}{KINDS[kind]}",
        (*constants, *system.states, *system.inputs, system.step, *made.given),
        (*map(next_of, system.states), *made.returned),
        needed(made.tape.ops, results),
        results,
        steps=system.rate.steps,
        assumptions=system.rate.assumptions,
        sparsity=made.sparsity,
    )
    return with_values_read_soon(with_signs_outside(program, made.tape.prefix))


def _without_slopes(how: Method, system: System, kind: str) -> Recorded:
    tape = tape_for(system)
    if not kind:
        return Recorded(tape, how.after(tape, system))
    if how.increments is None:
        raise ValueError(f"{how.says}: it carries no remainder")
    rest = remainder(system.states)
    start, gains = how.increments(tape, system)
    for place in system.quaternions:
        gains[place] = normalising_increment(start[place], gains[place])
    after = compensated_sums(start, gains, [tape.input(c) for c in rest.components])
    return Recorded(tape, after, (rest,), (next_of(rest),))


def _with_slopes(how: Method, system: System, kind: str) -> Recorded:
    slopes_of(system)  # a step without derivatives would be recorded without them
    tape, n = tape_for(system), len(system.names)
    after, matrix = how.slopes[kind](tape, system)
    if system.column:  # by h/2 until here
        matrix = [[*row[:-1], row[-1] * Fraction(1, 2)] for row in matrix]
    rows, columns = system.names, system.columns
    if kind == "tangent":
        rows = _names_with_errors(system)
        columns = (*rows, *columns[n:])
    if kind == "sensitivity":
        matrix, columns = [row[n:] for row in matrix], columns[n:]
    after_step = [f"{name}_next" for name in rows]
    pattern, nonzeros = compressed(matrix, after_step, columns, lambda x: x.exact == 0)
    parts = tuple(f"d({pattern.rows[i]})/d({pattern.columns[k]})" for i, k in pattern.places())
    says = f"nonzeros of the {JACOBIANS[kind]}, in compressed-column order, each in its own unit"
    jacobian = Quantity(MATRIX, parts, (len(parts),), "", "", None, None, says)
    return Recorded(tape, [*after, *nonzeros], (), (jacobian,), {"jacobian": pattern})


def _names_with_errors(system: System) -> tuple[str, ...]:
    """Return the names of the states, three errors for the attitude."""
    attitude = system.quaternion or slice(0)
    errors = tuple(f"attitude_error_{axis}" for axis in "xyz")
    return (*system.names[: attitude.start], *errors, *system.names[attitude.stop :])
