"""Loops over arrays as C: a statement a line, a counter a variable of its loop."""

from collections.abc import Callable, Sequence
from fractions import Fraction

from derive.emit.operators import in_c, literal
from derive.program.indexed import (
    Arrays,
    Assign,
    Even,
    Index,
    Indexed,
    Integers,
    Loop,
    Row,
    Same,
    Term,
    Value,
    Whole,
)
from derive.program.precision import Precision
from derive.program.program import Line, Operand

UNSIGNED_CHAR = 255
SIGNS = {"": "=", "add": "+=", "sub": "-="}
SUMS = ("add", "sub")


def loops_c(
    line: Indexed,
    text: Callable[[Operand], str],
    precision: Precision,
    inner: Callable[[Sequence[Line]], list[str]],
) -> list[str]:
    """Return the lines of a statement; ``inner`` writes the body of a loop."""
    kind = precision.scalar
    match line:
        case Arrays():
            every = (f"{name}{''.join(f'[{n}]' for n in sizes)}" for name, sizes in line.sizes)
            return [f"{kind} {', '.join(every)};"]
        case Integers():
            return table(line.name, line.values)
        case Row():
            fixed = "" if any(isinstance(v, str) for v in line.values) else "static "
            values = ", ".join(map(text, line.values))
            return [f"{fixed}const {kind} {line.name}[{len(line.values)}] = {{{values}}};"]
        case Assign():
            makes = {"": "", "constant": f"const {kind} ", "variable": f"{kind} "}[line.makes]
            value = _value(line.value, text, precision)
            return [f"{makes}{line.target} {SIGNS[line.adds]} {value};"]
        case Loop():
            head = _head(line)
        case Even():
            head = (
                f"if ({line.counter} % 2 == 0) {{\n    const int {line.half} = {line.counter} / 2;"
            )
    return [*head.splitlines(), *(f"    {one}" for one in inner(line.body)), "}"]


def _head(loop: Loop) -> str:
    i, sign, below = loop.counter, "++" if loop.step > 0 else "--", "<" if loop.step > 0 else ">"
    if not loop.mirror:
        return f"for (int {i} = {loop.first}; {i} {below} {loop.last}; {sign}{i}) {{"
    m, end = loop.mirror, loop.mirror if loop.meets else loop.last
    start = Index(loop.last.counter, loop.last.plus - 1)
    return f"for (int {i} = {loop.first}, {m} = {start}; {i} < {end}; ++{i}, --{m}) {{"


def _value(value: Value, text: Callable[[Operand], str], precision: Precision) -> str:
    match value:
        case str() | Fraction():
            return text(value)
        case Whole():
            inside = f"({value.index})" if value.index.plus else f"{value.index}"
            return f"({precision.scalar}){inside}"
        case Same():
            one, zero = (literal(Fraction(n), precision) for n in (1, 0))
            return f"({value.one} == {value.other}) ? {one} : {zero}"
        case Term():
            parts = [_value(o, text, precision) for o in value.operands]
            return in_c(value.operator, bracketed(value, parts), precision)
    return str(value)


def bracketed(term: Term, parts: Sequence[str]) -> list[str]:
    """Return operands in parentheses where they bind less than the operator, or come second."""
    return [
        f"({part})"
        if isinstance(o, Same)
        or (isinstance(o, Term) and o.operator in SUMS and (place or term.operator not in SUMS))
        else part
        for place, (o, part) in enumerate(zip(term.operands, parts, strict=True))
    ]


def table(name: str, values: Sequence[int]) -> list[str]:
    """Return the lines of a constant table, in the smallest type that holds its numbers."""
    kind = "unsigned char" if max(values) <= UNSIGNED_CHAR else "unsigned short"
    lines, line = [f"static const {kind} {name}[{len(values)}] = {{"], ""
    for value in values:
        if len(line) > 80:
            lines.append(f"    {line.rstrip()}")
            line = ""
        line += f"{value}, "
    return [*lines, f"    {line.rstrip(', ')}", "};"]
