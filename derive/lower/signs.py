"""A program with its minus signs moved to where they cost nothing; its results are the same bits.

The operations are recorded anew, a value and its sign apart: what differs by its sign only is
computed once, a difference is one whichever way round, and a sign left at the end is one ``neg``.
Rounding to nearest knows no signs, so nothing changes but the sign of a zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from derive.program.program import Op, Operand, Program
from derive.program.recorded import needed
from derive.program.tape import Number, Tape, number
from derive.scene.functions import PLAIN


@dataclass(frozen=True)
class Signed:
    """``sign`` (1 or -1) times a value; an exact number is never below zero here."""

    sign: int
    value: Number


def signed(value: Number) -> Signed:
    """Return a number with its sign apart, where that is known."""
    if value.exact is not None and value.exact < 0:
        return Signed(-1, number(-value.exact))
    return Signed(1, value)


def with_signs_outside(program: Program, prefix: str) -> Program:
    """Return ``program`` with fewer operations of sign, and without what no result rests on.

    prefix : what operations are called, before a number
    """
    tape = Tape(prefix)
    known: dict[str, Signed] = {}

    def value(operand: Operand) -> Signed:
        if isinstance(operand, str):
            return known.get(operand) or Signed(1, Number(tape, operand))
        return signed(number(operand))

    for line in program.ops:
        if not isinstance(line, Op):
            raise TypeError(f"'{program.name}' has a loop, whose signs cannot be moved")
        known[line.result] = _signed_result(tape, line, [value(o) for o in line.operands])
    ends = [_plain(value(result)) for result in program.results]
    results = tuple(end.operand for end in ends)
    return replace(program, ops=needed(tape.ops, results), results=results)


def _signed_result(tape: Tape, op: Op, given: Sequence[Signed]) -> Signed:
    if op.operator not in PLAIN:
        operands = tuple(_plain(each).operand for each in given)
        return Signed(1, Number(tape, tape.record(op.operator, operands)))
    if op.operator == "neg":
        return Signed(-given[0].sign, given[0].value)
    a, b = given
    if op.operator in ("mul", "div"):
        made = a.value * b.value if op.operator == "mul" else a.value / b.value
        return Signed(a.sign * b.sign, made)
    return _sum(tape, a, b if op.operator == "add" else Signed(-b.sign, b.value))


def _sum(tape: Tape, a: Signed, b: Signed) -> Signed:
    if a.value.exact == 0 or b.value.exact == 0:
        return b if a.value.exact == 0 else a
    if a.sign == b.sign:
        return Signed(a.sign, a.value + b.value)
    if a.value.exact is not None and b.value.exact is not None:
        difference = signed(a.value - b.value)
        return Signed(a.sign * difference.sign, difference.value)
    more, less = (a, b) if a.sign > 0 else (b, a)
    if ("sub", less.value.operand, more.value.operand) in tape.numbered:
        return Signed(-1, less.value - more.value)
    return Signed(1, more.value - less.value)


def _plain(value: Signed) -> Number:
    return value.value if value.sign > 0 else -value.value
