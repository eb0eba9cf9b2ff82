"""A program as C99 text: one line an operation, everything computed before anything is stored."""

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction

from derive.emit.c.loops import loops_c
from derive.emit.operators import WRITTEN, in_c, literal
from derive.program.arithmetic import TRUTHS, pair_of
from derive.program.precision import Precision
from derive.program.program import Line, Op, Operand, Program, Quantity, Repeat, every_op


def places(quantities: tuple[Quantity, ...]) -> dict[str, str]:
    """Return where in C each component of ``quantities`` is found."""
    found: dict[str, str] = {}
    for q in quantities:
        for i, name in enumerate(q.components):
            if q.role == "constants":
                found[name] = f"constants->{name}"
            else:
                found[name] = f"{q.name}[{i}]" if q.shape else q.name
    return found


def body(program: Program, precision: Precision) -> list[str]:
    """Return the lines between the braces of a hot function."""
    place = places(program.inputs)
    place |= {n: literal(q[precision.bits], precision) for n, q in program.numbers.items()}

    def text(operand: Operand) -> str:
        if isinstance(operand, Fraction):
            return literal(operand, precision)
        return place.get(operand, operand)

    def one(op: Op) -> str:
        kind = "int" if op.operator in TRUTHS else precision.scalar
        return (
            f"const {kind} {op.result} = {in_c(op.operator, [*map(text, op.operands)], precision)};"
        )

    return [*written(program.ops, one, text, precision), *_stores(program, text, precision)]


def written(
    lines: Sequence[Line],
    one: Callable[[Op], str],
    text: Callable[[Operand], str],
    precision: Precision,
    kind: str = "",
) -> list[str]:
    """Return the C lines of operations and loops; ``one`` writes an operation.

    kind : the type of what a loop carries, if it is not the precision's
    """

    def inner(body: Sequence[Line]) -> list[str]:
        return written(body, one, text, precision, kind)

    found: list[str] = []
    for line in lines:
        if isinstance(line, Op):
            found.append(one(line))
        elif isinstance(line, Repeat):
            found += _loop(line, one, text, kind or precision.scalar)
        else:
            found += loops_c(line, text, precision, inner)
    return found


def _loop(
    loop: Repeat, one: Callable[[Op], str], text: Callable[[Operand], str], kind: str
) -> list[str]:
    begin = [f"{kind} {c} = {text(s)};" for c, s in zip(loop.carried, loop.start, strict=True)]
    kept = {c: f"{c}_then" for c in loop.carried if c in loop.then}
    after = [f"const {kind} {name} = {c};" for c, name in kept.items()]
    after += [
        f"{c} = {kept.get(t, text(t)) if isinstance(t, str) else text(t)};"
        for c, t in zip(loop.carried, loop.then, strict=True)
        if c != t
    ]
    end = [] if loop.done is None else [f"if ({text(loop.done)}) {{", "    break;", "}"]
    inner = [*map(one, loop.ops), *after, *end]
    name = f"pass_{loop.carried[0]}"
    head = f"for (int {name} = 0; {name} < {loop.passes}; ++{name}) {{"
    return [*begin, head, *(f"    {line}" for line in inner), "}"]


def _stores(program: Program, text: Callable[[Operand], str], precision: Precision) -> list[str]:
    """Return the stores; an input that is also a result is read first: outputs may lie over it."""
    slots = [slot for q in program.outputs for slot in _slots(q)]
    arrays = {c for q in program.inputs if q.shape and q.role != "constants" for c in q.components}
    read = [r for r in dict.fromkeys(program.results) if r in arrays]
    loads = [f"const {precision.scalar} {name}_in = {text(name)};" for name in read]
    held = [f"{r}_in" if r in arrays else text(r) for r in program.results]
    stored = [pair for pair in zip(slots, held, strict=True) if pair[0] != pair[1]]
    return [*loads, *(f"{slot} = {value};" for slot, value in stored)]


def _slots(q: Quantity) -> list[str]:
    if q.role == "constants":
        return [f"constants->{name}" for name in q.components]
    return [f"{q.name}[{i}]" for i in range(len(q.components))] if q.shape else [f"*{q.name}"]


def pair_body(program: Program, scene: str, precision: Precision) -> list[str]:
    """Return the lines of a program in pairs of floats: rounded once, at the end."""
    place = places(program.inputs) if not program.makes("constants") else _by_value(program)
    pair = f"{scene}_pair_{precision.name}"

    def text(operand: Operand) -> str:
        if isinstance(operand, Fraction):
            return _pair_literal(operand, pair, precision)
        if operand in place:
            return f"({pair}){{{place[operand]}, {literal(Fraction(0), precision)}}}"
        return operand

    def one(op: Op) -> str:
        kind = "int" if op.operator in TRUTHS else pair
        operands = [text(operand) for operand in op.operands]
        if WRITTEN[op.operator].rests is None:  # of truths, or a choice between two structs
            return f"const {kind} {op.result} = {in_c(op.operator, operands, precision)};"
        symbol = f"{scene}_{op.operator}_{precision.name}"
        return f"const {kind} {op.result} = {symbol}({', '.join(operands)});"

    lines = written(program.ops, one, text, precision, pair)

    def stored(operand: Operand) -> str:
        if isinstance(operand, str) and operand not in place:
            return f"{operand}.high"
        return literal(operand, precision) if isinstance(operand, Fraction) else place[operand]

    return lines + _stores(program, stored, precision)


def _by_value(program: Program) -> dict[str, str]:
    return {c: c for q in program.inputs for c in q.components}


def _pair_literal(q: Fraction, pair: str, precision: Precision) -> str:
    high, low = pair_of(q, precision.dtype)
    return f"({pair}){{{literal(high, precision)}, {literal(low, precision)}}}"


def pair_functions(programs: Iterable[Program]) -> list[str]:
    """Return the pair operations that programs in pairs need, each after those it rests on."""
    used = {op.operator for program in programs for op, _ in every_op(program.ops)}
    wanted = used | {name for kind in used for name in WRITTEN[kind].rests or ()}
    return [name for name, row in WRITTEN.items() if name in wanted and row.rests is not None]
