"""The motion of a scene as a step sees it: states, inputs that are held, and their rates.

A step is recorded over the program of the rates. What it needs of them, the rates and the nonzeros
of their Jacobian, is asked for times a part of the step's length: that factor is pushed down to
the constants, which all stages share, so that it costs a few operations a step and none a stage.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache

from derive.motion.runge_kutta.matrices import Matrix, beside, zeros
from derive.program.program import (
    Op,
    Operand,
    Program,
    Quantity,
    Sparsity,
    every_op,
    operands_of,
    placed,
)
from derive.program.recorded import called
from derive.program.tape import Number, Tape, free_prefix, number

TIME_STEP = Quantity(
    "time_step", ("time_step",), (), "s", "", Fraction(0), Fraction(1, 10), "length of the step"
)


@dataclass(frozen=True)
class System:
    """The rates of a scene's state.

    states : every state, in the order of the rates
    rate   : program of the rates; as inputs it may have constants, states and inputs
    slopes : program of the rates and, as its last output, the nonzeros of their Jacobian by the
             states and by whatever else, inputs or parameters, derivatives are wanted by
    step   : the length of the step
    taken  : further names of the scene, which no operation may have
    column : whether the step's length is the last that derivatives are wanted by
    """

    states: tuple[Quantity, ...]
    rate: Program
    slopes: Program | None = None
    step: Quantity = TIME_STEP
    taken: frozenset[str] = frozenset()
    column: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        """Return the components of all states."""
        return tuple(c for q in self.states for c in q.components)

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """Return what the rates use besides constants and states, held while the step lasts."""
        own = {q.name for q in self.states}
        given = (q for q in self.rate.inputs if q.is_value)
        return tuple(q for q in given if q.name not in own)

    @property
    def columns(self) -> tuple[str, ...]:
        """Return by what the Jacobian is taken: states, inputs or parameters, the step's length."""
        length = self.step.components if self.column else ()
        return (*pattern_of(self).columns, *length)

    @property
    def quaternions(self) -> tuple[slice, ...]:
        """Return where attitudes stand among the components."""
        return tuple(place for q, place in placed(self.states) if q.is_quaternion)

    @property
    def quaternion(self) -> slice | None:
        """Return where the attitude stands of a state that has a single one, else None."""
        return self.quaternions[0] if len(self.quaternions) == 1 else None


def next_of(q: Quantity) -> Quantity:
    """Return the quantity that a state is after a step.

    >>> next_of(Quantity("a", ("a_x",), (1,), "1", "", None, None, "a thing")).components
    ('a_x_next',)
    """
    parts = tuple(f"{c}_next" for c in q.components)
    return replace(q, name=f"{q.name}_next", components=parts, meaning=f"{q.meaning}, next")


def tape_for(system: System) -> Tape:
    """Return a tape whose names are none of the scene's."""
    programs = (system.rate, *([system.slopes] if system.slopes is not None else []))
    taken = {c for q in (*system.states, system.step) for c in q.components} | system.taken
    for program in programs:
        made = {op.result for op in every_op(program.ops)}
        taken |= operands_of(program.ops, program.results) - made
    return Tape(free_prefix("t", taken))


def rates_at(tape: Tape, system: System, state: Sequence[Number], factor: Number) -> list[Number]:
    """Return ``factor`` times the rates at ``state``."""
    return _scaled(tape, system.rate, _given(tape, system, state), factor)


def slopes_at(
    tape: Tape, system: System, state: Sequence[Number], factor: Number
) -> tuple[list[Number], Matrix]:
    """Return ``factor`` times the rates (n,) and their Jacobian (n, m) at ``state``.

    A column by the step's length, if there is one, is by ``factor``: it holds the rates themselves.
    """
    pattern, n = pattern_of(system), len(state)
    found = _scaled(tape, slopes_of(system), _given(tape, system, state), factor)
    full = zeros(n, len(pattern.columns))
    for (row, column), entry in zip(pattern.places(), found[n:], strict=True):
        full[row][column] = entry
    if system.column:
        full = beside(full, [[x] for x in rates_at(tape, system, state, number(1))])
    return found[:n], full


def slopes_of(system: System) -> Program:
    """Return the program of the rates with their Jacobian."""
    if system.slopes is None:
        raise ValueError(f"derivatives of a step need the Jacobian of '{system.rate.name}'")
    return system.slopes


def pattern_of(system: System) -> Sparsity:
    """Return the pattern of the rates' Jacobian."""
    program = slopes_of(system)
    return (program.sparsity or {})[program.outputs[-1].name]


def _given(tape: Tape, system: System, state: Sequence[Number]) -> dict[str, Number]:
    held = {c: tape.input(c) for q in system.inputs for c in q.components}
    return held | dict(zip(system.names, state, strict=True))


def _scaled(
    tape: Tape, program: Program, values: Mapping[str, Number], factor: Number
) -> list[Number]:
    """Return the results of ``program`` times ``factor``, which goes to constants where it can."""
    made = {op.result: op for op in program.ops if isinstance(op, Op)}
    every = called(tape, replace(program, results=tuple(made)), values)
    known = dict(zip(made, every, strict=True))
    ease = _ease(made, {c for q in program.inputs for c in q.components} & values.keys())

    def plain(operand: Operand) -> Number:
        if isinstance(operand, Fraction):
            return number(operand)
        return known.get(operand) or values.get(operand) or Number(tape, operand)

    @cache
    def scaled(operand: Operand) -> Number:
        op = made.get(operand) if isinstance(operand, str) else None
        if op is None or not ease(operand):
            return plain(operand) * factor
        first, *rest = op.operands
        if op.operator == "neg":
            return -scaled(first)
        if op.operator == "add":
            return scaled(first) + scaled(rest[0])
        if op.operator == "sub":
            return scaled(first) - scaled(rest[0])
        if op.operator == "div":
            return scaled(first) / plain(rest[0])
        if ease(first) >= ease(rest[0]):
            return scaled(first) * plain(rest[0])
        return plain(first) * scaled(rest[0])

    return [scaled(result) for result in program.results]


def _ease(made: Mapping[str, Op], varying: set[str]) -> Callable[[Operand], int]:
    """Return how well a factor of a value becomes one of constants: 2, of numbers: 1, or not: 0."""

    @cache
    def ease(operand: Operand) -> int:
        op = made.get(operand) if isinstance(operand, str) else None
        if op is None:
            return 1 if isinstance(operand, Fraction) else 2 * (operand not in varying)
        parts = [ease(o) for o in op.operands]
        if op.operator in ("neg", "div"):
            return parts[0]
        if op.operator == "mul":
            return max(parts)
        return min(parts) if op.operator in ("add", "sub") else 0

    return ease


FLOW, NEXT = "flow_exact", "_next"
