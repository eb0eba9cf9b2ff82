"""What is recorded whole: a loop, another program; and what of it the results rest on."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, TypeVar

from derive.program.indexed import Assign, Even, Index, Loop, Row, Term
from derive.program.program import Line, Op, Operand, Program, operands_of
from derive.program.tape import Number, Tape, number, operation, seen_from
from derive.scene.functions import PLAIN

OneLine = TypeVar("OneLine", bound=Line)
Renamable = TypeVar("Renamable", bound=Line | Operand)
LoopBody = Callable[[list[Number]], tuple[Sequence[Number], Number | None]]


def repeat(tape: Tape, passes: int, start: Sequence[Number], body: LoopBody) -> list[Number]:
    """Record a loop: ``body`` takes what is carried, and returns it anew and the truth of done.

    A loop that is there already, whatever its values are called, is not recorded twice.
    """
    names = [tape.fresh() for _ in start]
    with tape.within() as ops:
        then, done = body([Number(tape, name) for name in names])
        after = tuple(seen_from(tape, number(n)) for n in then)
        until = None if done is None else seen_from(tape, done)
    inner = tuple(op for op in ops if isinstance(op, Op))
    if len(inner) < len(ops):
        raise ValueError("a loop within a loop is not there")
    begin = tuple(seen_from(tape, number(n)) for n in start)
    loop = Loop("", Index(), Index(plus=passes), inner, carried=tuple(names), start=begin,
                then=after, done=until)  # fmt: skip
    key = _without_names(loop)
    if key not in tape.numbered:
        tape.numbered[key] = " ".join(names)
        tape.ops.append(loop)
    return [Number(tape, name) for name in tape.numbered[key].split()]


def _without_names(loop: Loop) -> tuple[object, ...]:
    """Return what a loop does, its own values called by their places."""
    own = (*loop.carried, *(op.result for op in loop.body))
    (same,) = renamed((loop,), {name: f" {place}" for place, name in enumerate(own)})
    steps = ((op.operator, op.operands) for op in same.body)
    return ("repeat", same.last, same.start, *steps, same.then, same.done)


def needed(ops: Sequence[OneLine], results: Sequence[Operand | None]) -> tuple[OneLine, ...]:
    """Return the operations without those that no result rests on, and no place of an array."""
    wanted = {r for r in results if isinstance(r, str)}
    kept: list[OneLine] = []
    for line in reversed(ops):
        if isinstance(line, Op) and line.result not in wanted:
            continue
        if isinstance(line, Assign) and line.makes and line.target not in wanted:
            continue
        one: Any = _needed_turns(line, wanted) if isinstance(line, Loop) else line
        if isinstance(one, Loop) and not one.carried and not one.body:
            continue
        kept.append(one)
        wanted |= operands_of(kept[-1:])
    return tuple(reversed(kept))


def _needed_turns(loop: Loop, wanted: set[str]) -> Loop:
    """Return a loop that carries what is wanted afterwards, and what its turns need for that."""
    live: set[str] = wanted & {*loop.carried}
    while True:
        rows = [
            row for row in zip(loop.carried, loop.start, loop.then, strict=True) if row[0] in live
        ]
        then = tuple(t for _, _, t in rows)
        body = needed(loop.body, (*then, loop.done if rows else None))
        more = operands_of(body, then) & {*loop.carried} - live
        if not more:
            names, start = tuple(c for c, _, _ in rows), tuple(s for _, s, _ in rows)
            done = loop.done if rows else None
            return replace(loop, body=body, carried=names, start=start, then=then, done=done)
        live |= more


def called(tape: Tape, program: Program, values: Mapping[str, Number]) -> list[Number]:
    """Return the results of a program on ``values`` by component, its operations recorded here.

    The program's constants are read as they are; equal operations are recorded once.
    """
    inputs = [c for q in program.inputs if q.role != "constants" for c in q.components]
    known = {name: number(values[name]) for name in inputs}

    def value(operand: Operand) -> Number:
        if isinstance(operand, str):
            return known.get(operand) or Number(tape, operand)  # what is left are constants
        return number(operand)

    for op in program.ops:
        if not isinstance(op, Op):
            raise TypeError(f"'{program.name}' has a loop, and a loop cannot be called yet")
        # x + 0, or a sum of exact numbers, is no operation of the program
        known[op.result] = PLAIN.get(op.operator, partial(operation, op.operator))(
            *map(value, op.operands)
        )
    return [value(result) for result in program.results]


def renamed(lines: Sequence[Renamable], names: Mapping[str, Operand]) -> tuple[Renamable, ...]:
    """Return lines or operands with operands called by new ``names``; results keep theirs."""

    def one(line: Any) -> Any:
        match line:
            case str():
                return names.get(line, line)
            case tuple():
                return tuple(map(one, line))
            case Op() | Term():
                return replace(line, operands=one(line.operands))
            case Loop():
                parts = ("start", "body", "then", "done")
                return replace(line, **{name: one(getattr(line, name)) for name in parts})
            case Even():
                return replace(line, body=one(line.body))
            case Assign():
                return replace(line, value=one(line.value))
            case Row():
                return replace(line, values=one(line.values))
        return line

    return tuple(map(one, lines))
