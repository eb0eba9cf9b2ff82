"""The lines of a program in any language: what all printers do alike, told what each one writes.

A new language is a ``Language``, a template, and whatever it calls pairs of floats by.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from derive.emit.operators import SUMS
from derive.program.indexed import (
    Arrays,
    Assign,
    Even,
    Index,
    IndexedOperand,
    Integers,
    Loop,
    Row,
    Same,
    Term,
    Whole,
)
from derive.program.program import Line, Op, Operand

SIGNS = {"": "=", "add": "+=", "sub": "-="}


@dataclass(frozen=True)
class Language:
    """How a language writes what a program is made of.

    text, patterns, call : an operand; operators by pattern, all others by what they are called
    line, assign         : an operation and an assignment, their values given
    declared             : arrays, tables and rows
    carried              : the lines before a loop that carries values, and those that end a turn
    head, end            : what opens a loop or a choice, and what closes it
    whole, same          : a counter as a value, in parentheses or a call, for it may be a sum; the
                           pattern of one where two counters are the same
    """

    text: Callable[[Operand], str]
    patterns: Mapping[str, str]
    call: Callable[[str], str]
    line: Callable[[Op, str], str]
    carried: Callable[[Language, Loop], tuple[list[str], list[str]]]
    declared: Callable[[Language, Arrays | Integers | Row], list[str]]
    assign: Callable[[Assign, str], str]
    head: Callable[[Loop | Even], list[str]]
    end: tuple[str, ...]
    whole: Callable[[Index], str]
    same: str


def operation_text(of: Language, operator: str, operands: Sequence[str]) -> str:
    """Return an operator on operands that are written already."""
    if operator in of.patterns:
        return of.patterns[operator].format(*operands)
    return f"{of.call(operator)}({', '.join(operands)})"


def written(of: Language, lines: Sequence[Line]) -> list[str]:
    """Return the lines of operations and loops."""
    return [text for line in lines for text in _written(of, line)]


def _written(of: Language, line: Line) -> Iterator[str]:
    match line:
        case Op():
            yield of.line(line, operation_text(of, line.operator, [*map(of.text, line.operands)]))
        case Assign():
            yield of.assign(line, _value(of, line.value))
        case Loop() | Even():
            before, after = list[str](), list[str]()
            if isinstance(line, Loop) and line.carried:
                before, after = of.carried(of, line)
            inner = (*written(of, line.body), *after)
            yield from (*before, *of.head(line), *(f"    {one}" for one in inner), *of.end)
        case _:
            yield from of.declared(of, line)


def _value(of: Language, value: IndexedOperand) -> str:
    match value:
        case str() | Fraction():
            return of.text(value)
        case Whole():
            return of.whole(value.index)
        case Same():
            return of.same.format(value.one, value.other)
        case Term():
            return operation_text(of, value.operator, [*_bracketed(of, value)])
    return str(value)


def _bracketed(of: Language, term: Term) -> Iterator[str]:
    """Yield operands, in parentheses but for a first one of the operator's own precedence."""
    for place, o in enumerate(term.operands):
        alike = isinstance(o, Term) and (o.operator in SUMS) == (term.operator in SUMS)
        inner = isinstance(o, Term | Same) and (place or not alike)
        yield f"({_value(of, o)})" if inner else _value(of, o)
