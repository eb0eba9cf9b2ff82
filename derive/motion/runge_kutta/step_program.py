"""A traced step as a program: what it is given and returns, in which order, by which names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from derive.lower.order import with_values_read_soon
from derive.lower.signs import with_signs_moved
from derive.motion.runge_kutta.carried import remainder
from derive.motion.runge_kutta.matrices import Matrix
from derive.motion.runge_kutta.system import System, next_of
from derive.program.pattern import compressed
from derive.program.program import Operand, Program, Quantity, Sparsity
from derive.program.recorded import needed
from derive.program.tape import Number, Tape

Row = list[Number]
COMPRESSED = "in compressed-column order"


@dataclass(frozen=True)
class Traced:
    """A step on its tape: quantities given beside the state's and returned, and their numbers."""

    tape: Tape
    system: System
    more: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    numbers: Row
    sparsity: dict[str, Sparsity] | None


@dataclass(frozen=True)
class Slopes:
    """Derivatives of what a step returns, with the names of their rows and columns."""

    matrix: Matrix
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    says: str


def moved(tape: Tape, system: System, after: Row) -> Traced:
    """Return a step to the state ``after``."""
    return Traced(tape, system, (), tuple(map(next_of, system.states)), after, None)


def moved_with_slopes(tape: Tape, system: System, after: Row, slopes: Slopes) -> Traced:
    """Return a step with derivatives."""
    pattern, nonzeros = compressed(
        slopes.matrix, slopes.rows, slopes.columns, lambda n: n.exact == 0
    )
    parts = tuple(f"d({pattern.rows[i]})/d({pattern.columns[k]})" for i, k in pattern.places())
    says = f"nonzeros of the {slopes.says}, {COMPRESSED}"
    jacobian = Quantity("jacobian", parts, (len(parts),), "", "", None, None, says)
    outputs = (*map(next_of, system.states), jacobian)
    return Traced(tape, system, (), outputs, [*after, *nonzeros], {"jacobian": pattern})


def moved_with_remainder(tape: Tape, system: System, after: Row, left: Row) -> Traced:
    """Return a step that is given a remainder and leaves one."""
    rest = remainder(system.states)
    outputs = (*map(next_of, system.states), next_of(rest))
    return Traced(tape, system, (rest,), outputs, [*after, *left], None)


def program_of(name: str, says: str, made: Traced) -> Program:
    """Return the program of a traced step.

    Its inputs are constants, every state, the inputs that the rates use, and the step's length.
    """
    system, results = made.system, tuple[Operand, ...](n.operand for n in made.numbers)
    constants = tuple(q for q in system.rate.inputs if q.role == "constants")
    program = Program(
        name,
        says,
        (*constants, *system.states, *system.inputs, system.step, *made.more),
        made.outputs,
        needed(made.tape.ops, results),
        results,
        steps=system.rate.steps,
        assumptions=system.rate.assumptions,
        sparsity=made.sparsity,
    )
    return with_values_read_soon(with_signs_moved(program, made.tape.prefix))


def next_names(names: Sequence[str]) -> tuple[str, ...]:
    """Return what components of a state are called after a step."""
    return tuple(f"{name}_next" for name in names)


def names_with_errors(system: System) -> tuple[str, ...]:
    """Return the names of the states, three errors for the attitude."""
    attitude = system.quaternion or slice(0)
    errors = tuple(f"attitude_error_{axis}" for axis in "xyz")
    return (*system.names[: attitude.start], *errors, *system.names[attitude.stop :])
