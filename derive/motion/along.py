"""First and second derivatives of any step along changes of what it is given, as programs.

A program is recorded once; what its results change by is carried forward over it, what a weighed
sum of them changes by is carried back, and the one over the other is a column of the second
derivatives. Nothing is asked of the step but operations that have derivatives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from derive.lower.setup import used_inputs
from derive.program.program import Line, Op, Operand, Program, Quantity, operands_of
from derive.program.recorded import called, needed
from derive.program.slopes import backward, forward
from derive.program.tape import Number, Tape, free_prefix, number

ADJOINT, CHANGE = "adjoint", "change"


@dataclass(frozen=True)
class Recording:
    """A program on a tape, and how what derivatives are taken by changes.

    changes : the change of each by its name: 1 if there is one, else a part of ``change``
    """

    tape: Tape
    results: list[Number]
    fixed: tuple[Line, ...]
    changes: Mapping[str, Number]
    given: tuple[Quantity, ...]


def with_set_up(step: Program, setup: Program) -> Program:
    """Return a step as a function of the parameters themselves, set-up done in plain floats."""
    read = operands_of(step.ops, step.results)
    made = [(c, r) for c, r in zip(_names(setup.outputs), setup.results, strict=True) if c in read]
    inputs = tuple(q for q in step.inputs if q.role != "constants")
    tape = Tape(_prefix(step, setup))
    values = {c: tape.input(c) for c in _names((*setup.inputs, *inputs))}
    ops = needed(setup.ops, [r for _, r in made])
    before = replace(setup, ops=ops, results=tuple(r for _, r in made))
    constants = zip((c for c, _ in made), called(tape, before, values), strict=True)
    unread = dict.fromkeys(_names(setup.outputs), number(0))
    results = called(tape, _of_values(step), unread | values | dict(constants))
    return replace(
        step,
        inputs=(*setup.inputs, *inputs),
        ops=tuple(tape.ops),
        results=tuple(r.operand for r in results),
    )


def first_along(program: Program, by: Sequence[str], name: str) -> Program:
    """Return the derivatives of the results by ``by``; along a ``change`` of several."""
    at = _recorded(program, by)
    slopes = forward(at.tape, at.fixed, at.changes)
    found = [_of(slopes, r) for r in at.results]
    says = "First derivatives of the state after the step."
    return _program(program, at, name, says, found)


def second_along(program: Program, by: Sequence[str], of: Sequence[str], name: str) -> Program:
    """Return how the derivatives by ``of`` of ``adjoint`` times the results change with ``by``."""
    at = _recorded(program, by)
    weights = dict[str, Number]()
    adjoint = _array(ADJOINT, len(at.results))
    for result, c in zip(at.results, adjoint.components, strict=True):
        if isinstance(result.operand, str):
            before = weights.get(result.operand, number(0))
            weights[result.operand] = before + at.tape.input(c)
    back = backward(at.tape, at.fixed, weights)
    slopes = [back.get(c, number(0)) for c in of]
    carried = needed(at.tape.ops, [s.operand for s in slopes])
    bends = forward(at.tape, carried, at.changes)
    found = [_of(bends, s) for s in slopes]
    says = "Second derivatives of adjoint times the state after the step."
    return _program(program, replace(at, given=(adjoint, *at.given)), name, says, found)


def _recorded(program: Program, by: Sequence[str]) -> Recording:
    tape = Tape(_prefix(program))
    names = _names(program.inputs)
    results = called(tape, _of_values(program), {c: tape.input(c) for c in names})
    if len(by) == 1:
        return Recording(tape, results, tuple(tape.ops), {by[0]: number(1)}, ())
    change = _array(CHANGE, len(by))
    parts = [tape.input(c) for c in change.components]
    changes = {b: part for b, part in zip(by, parts, strict=True) if b in names}
    return Recording(tape, results, tuple(tape.ops), changes, (change,))


def _of(known: Mapping[str, Number], value: Number) -> Number:
    return known.get(value.operand, number(0)) if isinstance(value.operand, str) else number(0)


def _program(
    program: Program, at: Recording, name: str, says: str, found: Sequence[Number]
) -> Program:
    results = tuple[Operand, ...](n.operand for n in found)
    ops = tuple(op for op in needed(at.tape.ops, results) if isinstance(op, Op))
    entries = _array("entries", len(results))
    given = used_inputs((*program.inputs, *at.given), ops, results)
    return Program(name, says, given, (entries,), ops, results, numbers=program.numbers)


def _array(name: str, size: int) -> Quantity:
    parts = tuple(f"{name}_{k}" for k in range(size))
    return Quantity(name, parts, (size,), "", "", None, None, name)


def _of_values(program: Program) -> Program:
    """Return a program whose constants are given as all else is."""
    whole = program.unrolled or program
    return replace(whole, inputs=tuple(replace(q, role="value") for q in whole.inputs))


def _names(quantities: Sequence[Quantity]) -> list[str]:
    return [c for q in quantities for c in q.components]


def _prefix(*programs: Program) -> str:
    taken = {c for p in programs for c in _names((*p.inputs, *p.outputs))}
    return free_prefix("t", taken.union(*(p.numbers for p in programs)))
