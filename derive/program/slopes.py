"""Derivatives of what is recorded on a tape: carried forward along a change, or back from weights.

Both walk the operations once and record theirs beside them, so that one may be walked over the
other: derivatives carried back, and these carried forward, are second derivatives.
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

from derive.program.operations import cos, sin
from derive.program.program import Line, Op, Operand
from derive.program.tape import Number, Tape, number

PartialsOf = Callable[[Sequence[Number], Number], Sequence[Number]]
STEADY = frozenset({"power_of_two", "floor", "pi", "unit_roundoff", "splitter"})
"""Operators whose results stay while operands change, or go up in steps."""
PARTIALS: Mapping[str, PartialsOf] = {
    "add": lambda v, r: (number(1), number(1)),  # noqa: ARG005
    "sub": lambda v, r: (number(1), number(-1)),  # noqa: ARG005
    "neg": lambda v, r: (number(-1),),  # noqa: ARG005
    "mul": lambda v, r: (v[1], v[0]),  # noqa: ARG005
    "div": lambda v, r: (1 / v[1], -(r / v[1])),
    "sin": lambda v, r: (cos(v[0]),),  # noqa: ARG005
    "cos": lambda v, r: (-sin(v[0]),),  # noqa: ARG005
    "sqrt": lambda v, r: (1 / (2 * r),),  # noqa: ARG005
}
"""The partial derivatives of an operation by its operands, from these and its result."""


def forward(tape: Tape, lines: Sequence[Line], changes: Mapping[str, Number]) -> dict[str, Number]:
    """Return how values change, by their names, if some of them change so; no zeros.

    Raises ValueError for a loop, and for an operator whose derivatives are not known.
    """
    found = {name: change for name, change in changes.items() if change.exact != 0}
    for op in map(_single, tuple(lines)):
        if not found.keys().isdisjoint(op.operands):
            total = number(0)
            for o, partial in zip(op.operands, _partials(tape, op), strict=True):
                if isinstance(o, str) and o in found:
                    total = total + partial * found[o]
            if total.exact != 0:
                found[op.result] = total
    return found


def backward(tape: Tape, lines: Sequence[Line], weights: Mapping[str, Number]) -> dict[str, Number]:
    """Return what a weighed sum of values changes by with each value, by its name; no zeros.

    Raises ValueError as ``forward`` does.
    """
    found = {name: weight for name, weight in weights.items() if weight.exact != 0}
    for op in map(_single, reversed(tuple(lines))):
        if op.result in found:
            for o, partial in zip(op.operands, _partials(tape, op), strict=True):
                if isinstance(o, str):
                    found[o] = found.get(o, number(0)) + partial * found[op.result]
    return {name: weight for name, weight in found.items() if weight.exact != 0}


def _single(line: Line) -> Op:
    if not isinstance(line, Op):
        raise ValueError("derivatives of a loop are not known here")
    return line


def _partials(tape: Tape, op: Op) -> Sequence[Number]:
    return partials(op, [_value(tape, o) for o in op.operands], Number(tape, op.result))


def partials(op: Op, operands: Sequence[Number], result: Number) -> Sequence[Number]:
    """Return the derivatives of an operation by its operands, from their values and its result.

    Raises ValueError for an operator whose derivatives are not known.
    """
    if op.operator in STEADY:
        return [number(0)] * len(operands)
    if op.operator not in PARTIALS:
        raise ValueError(f"derivatives of '{op.operator}' are not known here")
    return PARTIALS[op.operator](operands, result)


def _value(tape: Tape, operand: Operand) -> Number:
    return number(operand) if isinstance(operand, Fraction) else Number(tape, operand)
