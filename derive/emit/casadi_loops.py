"""Loops over arrays as Python that builds them in CasADi: an array is a list of expressions."""

from collections.abc import Callable, Sequence
from fractions import Fraction

from derive.emit.c.loops import SIGNS, bracketed
from derive.emit.operators import in_casadi
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
from derive.program.program import Line, Operand


def loops_python(
    line: Indexed,
    text: Callable[[Operand], str],
    inner: Callable[[Sequence[Line]], list[str]],
) -> list[str]:
    """Return the lines of a statement; ``inner`` writes the body of a loop."""
    match line:
        case Arrays():
            return [f"{name} = {_list(sizes)}" for name, sizes in line.sizes]
        case Integers():
            return [f"{line.name} = {list(line.values)}"]
        case Row():
            return [f"{line.name} = [{', '.join(map(text, line.values))}]"]
        case Assign():
            return [f"{line.target} {SIGNS[line.adds]} {_value(line.value, text)}"]
        case Loop():
            head = [_head(line)]
        case Even():
            head = [f"if {line.counter} % 2 == 0:", f"    {line.half} = {line.counter} // 2"]
    return [*head, *(f"    {one}" for one in inner(line.body))]


def _list(sizes: Sequence[int]) -> str:
    first, *rest = sizes
    return f"[{_list(rest)} for _ in range({first})]" if rest else f"[None] * {first}"


def _head(loop: Loop) -> str:
    first, last = loop.first, loop.last
    if not loop.mirror:
        step = "" if loop.step > 0 else ", -1"
        return f"for {loop.counter} in range({first}, {last}{step}):"
    below = Index(last.counter, last.plus - 1)
    end = f"({last} + 1) // 2" if loop.meets else f"{last}"  # they meet there if first is 1
    return (
        f"for {loop.counter}, {loop.mirror} in zip(range({first}, {end}), range({below}, 0, -1)):"
    )


def _value(value: Value, text: Callable[[Operand], str]) -> str:
    match value:
        case str() | Fraction():
            return text(value)
        case Whole():
            return f"float({value.index})"
        case Same():
            return f"float({value.one} == {value.other})"
        case Term():
            parts = [_value(o, text) for o in value.operands]
            return in_casadi(value.operator, bracketed(value, parts))
    return str(value)
