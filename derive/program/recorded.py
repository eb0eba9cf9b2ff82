"""What is recorded whole: a loop, another program; and what of it the results rest on."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from derive.program.indexed import Assign, Even, Loop, Row, Term
from derive.program.program import Line, Op, Operand, Program, Repeat
from derive.program.tape import Number, Tape, number, operation, seen_from
from derive.scene.functions import PLAIN

Body = Callable[[list[Number]], tuple[Sequence[Number], Number | None]]


def repeat(tape: Tape, passes: int, start: Sequence[Number], body: Body) -> list[Number]:
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
    loop = Repeat(tuple(names), begin, inner, after, until, passes)
    key = _without_names(loop)
    if key not in tape.numbered:
        tape.numbered[key] = " ".join(names)
        tape.ops.append(loop)
    return [Number(tape, name) for name in tape.numbered[key].split()]


def _without_names(loop: Repeat) -> tuple[object, ...]:
    """Return what a loop does, its own values called by their places."""
    own = (*loop.carried, *(op.result for op in loop.ops))
    places = {name: ("place", i) for i, name in enumerate(own)}

    def placed(operand: Operand | None) -> object:
        return places.get(operand, operand) if isinstance(operand, str) else operand

    steps = ((op.operator, *map(placed, op.operands)) for op in loop.ops)
    ends = (*map(placed, loop.then), placed(loop.done))
    return ("repeat", loop.passes, *loop.start, *steps, *ends)


def needed(ops: Sequence[Line], results: Sequence[Operand]) -> tuple[Line, ...]:
    """Return the operations without those that no result rests on."""
    wanted = {r for r in results if isinstance(r, str)}
    kept: list[Line] = []
    for line in reversed(ops):
        if isinstance(line, Op):
            if line.result in wanted:
                kept.append(line)
                wanted |= {o for o in line.operands if isinstance(o, str)}
        elif isinstance(line, Repeat) and wanted & set(line.carried):
            loop = _needed_loop(line)
            kept.append(loop)
            every = [*loop.start, *loop.then, *(o for op in loop.ops for o in op.operands)]
            every += [] if loop.done is None else [loop.done]
            wanted |= {o for o in every if isinstance(o, str)}
    return tuple(reversed(kept))


def _needed_loop(loop: Repeat) -> Repeat:
    ends = loop.then if loop.done is None else (*loop.then, loop.done)
    inner = tuple(op for op in needed(loop.ops, ends) if isinstance(op, Op))
    return Repeat(loop.carried, loop.start, inner, loop.then, loop.done, loop.passes)


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


def renamed(lines: Sequence[Line], names: Mapping[str, Operand]) -> tuple[Line, ...]:
    """Return the lines with operands called by their new ``names``; results keep theirs."""

    def new(operands: Sequence[Operand]) -> tuple[Operand, ...]:
        return tuple(names.get(o, o) if isinstance(o, str) else o for o in operands)

    def one(line: Any) -> Any:
        match line:
            case Op():
                return Op(line.result, line.operator, new(line.operands))
            case Repeat():
                done = None if line.done is None else new((line.done,))[0]
                start, then, ops = new(line.start), new(line.then), tuple(map(one, line.ops))
                return replace(line, start=start, ops=ops, then=then, done=done)
            case Loop() | Even():
                return replace(line, body=tuple(map(one, line.body)))
            case Assign():
                return replace(line, value=one(line.value))
            case Row():
                return replace(line, values=new(line.values))
            case Term():
                return replace(line, operands=tuple(map(one, line.operands)))
            case str():
                return names.get(line, line)
        return line

    return tuple(map(one, lines))
