"""Formulas written over numbers, recorded as the operations of a program.

Steppers and attitude formulas are written once, in plain Python, over ``Number``. What depends on
parameters only goes to the tape of set-up and is worked out there in twice the working precision;
the rest goes to the tape of the function. Equal operations are recorded once; exact numbers are
folded; nothing is re-ordered, so an error-free transformation stays one.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from fractions import Fraction

from derive.program.arithmetic import OPERATORS
from derive.program.program import Line, Op, Operand


@dataclass
class Tape:
    """Operations as they are recorded; ``below`` is the tape of set-up, if this is a function's.

    names : what set-up's values are called as constants, with what is said of each
    held  : the constants that functions have besides, and which input each is, "" if none
    """

    prefix: str
    below: Tape | None = None
    ops: list[Line] = field(default_factory=list)
    names: dict[str, tuple[str, str]] = field(default_factory=dict)
    held: Mapping[str, str] = field(default_factory=dict)
    numbered: dict[tuple[object, ...], str] = field(default_factory=dict)
    inputs: set[str] = field(default_factory=set)
    made: int = 0

    def input(self, name: str) -> Number:
        """Return the number of an input."""
        self.inputs.add(name)
        return Number(self, name)

    def fresh(self) -> str:
        """Return a name that no operation of this tape has."""
        self.made += 1
        return f"{self.prefix}{self.made - 1}"

    def record(self, operator: str, operands: tuple[Operand, ...]) -> str:
        """Return the name of an operation's result; no operation is recorded twice."""
        same = sorted(operands, key=str) if OPERATORS[operator].commutes else operands
        key = (operator, *same)
        if key not in self.numbered:
            self.numbered[key] = self.fresh()
            self.ops.append(Op(self.numbered[key], operator, operands))
        return self.numbered[key]

    def constant(self, operand: str) -> str:
        """Return the name that a value of set-up has in the functions."""
        if operand not in self.names:
            own = operand if operand in self.inputs else f"c{len(self.names)}"
            self.name(operand, own, "")
        return self.names[operand][0]

    def name(self, operand: str, name: str, says: str) -> None:
        """Name a value of set-up, by a number after the name if it is another's already."""
        if operand not in self.names:
            taken = {*self.held, *(own for own, _ in self.names.values())}
            same = next((held for held, given in self.held.items() if given == operand), "")
            self.names[operand] = (same or free_name(name, taken), says)

    @contextmanager
    def within(self) -> Iterator[list[Line]]:
        """Record into a list of its own; what is recorded there is forgotten afterwards."""
        outer, known = self.ops, dict(self.numbered)
        self.ops = []
        try:
            yield self.ops
        finally:
            self.ops, self.numbered = outer, known


@dataclass(frozen=True)
class Number:
    """A value on a tape, or an exact number (``tape`` None)."""

    tape: Tape | None
    operand: Operand

    def __add__(self, other: Number | int | Fraction) -> Number:
        return _add(self, number(other))

    def __radd__(self, other: int | Fraction) -> Number:
        return _add(number(other), self)

    def __sub__(self, other: Number | int | Fraction) -> Number:
        return _sub(self, number(other))

    def __rsub__(self, other: int | Fraction) -> Number:
        return _sub(number(other), self)

    def __mul__(self, other: Number | int | Fraction) -> Number:
        return _mul(self, number(other))

    def __rmul__(self, other: int | Fraction) -> Number:
        return _mul(number(other), self)

    def __truediv__(self, other: Number | int | Fraction) -> Number:
        return _div(self, number(other))

    def __rtruediv__(self, other: int | Fraction) -> Number:
        return _div(number(other), self)

    def __neg__(self) -> Number:
        if isinstance(self.operand, Fraction):
            return number(-self.operand)
        return operation("neg", self)

    @property
    def exact(self) -> Fraction | None:
        """Return the exact number that this is, None if it is a value on a tape."""
        return self.operand if isinstance(self.operand, Fraction) else None


Vector = Sequence[Number]


def number(x: Number | int | Fraction) -> Number:
    """Return an exact number, or ``x`` if it is one of ours already."""
    return x if isinstance(x, Number) else Number(None, Fraction(x))


def operation(operator: str, *values: Number | int | Fraction) -> Number:
    """Record an operation on the highest of its operands' tapes; do it, if all are exact numbers.

    A truth is then 1 or 0.
    """
    numbers = [number(v) for v in values]
    tapes = [n.tape for n in numbers if n.tape is not None]
    hot = [t for t in tapes if t.below is not None]
    does = OPERATORS[operator].exact
    if not tapes and does is None:
        raise ValueError(f"{operator} of exact numbers alone is no operation of a program")
    if not tapes and does is not None:
        return number(Fraction(does(*(n.exact for n in numbers))))
    tape = (hot or tapes)[0]
    return Number(tape, tape.record(operator, tuple(seen_from(tape, n) for n in numbers)))


def seen_from(tape: Tape, n: Number) -> Operand:
    """Return what a number is called on ``tape``; a value of set-up is a constant there."""
    if n.tape is None or n.tape is tape or isinstance(n.operand, Fraction):
        return n.operand
    if n.tape is not tape.below:
        raise ValueError(f"'{n.operand}' belongs to another function")
    return n.tape.constant(n.operand)


def _add(a: Number, b: Number) -> Number:
    if a.exact is not None and b.exact is not None:
        return number(a.exact + b.exact)
    if a.exact == 0:
        return b
    return a if b.exact == 0 else operation("add", a, b)


def _sub(a: Number, b: Number) -> Number:
    if a.exact is not None and b.exact is not None:
        return number(a.exact - b.exact)
    if a.exact == 0:
        return -b
    return a if b.exact == 0 else operation("sub", a, b)


def _mul(a: Number, b: Number) -> Number:
    if a.exact is not None and b.exact is not None:
        return number(a.exact * b.exact)
    if a.exact is not None:
        a, b = b, a
    if b.exact == 0:
        return b
    if b.exact == 1:
        return a
    return -a if b.exact == -1 else operation("mul", a, b)


def _div(a: Number, b: Number) -> Number:
    if a.exact is not None and b.exact is not None:
        return number(a.exact / b.exact)
    if a.exact == 0:
        return a
    return a if b.exact == 1 else operation("div", a, b)


def named(name: str, value: Number, says: str) -> Number:
    """Name a value of set-up: what the constant is called in C, and what is said of it there."""
    if value.tape is not None and value.tape.below is None and isinstance(value.operand, str):
        value.tape.name(value.operand, name, says)
    return value


def free_name(name: str, taken: Collection[str]) -> str:
    """Return a name that is not taken, by a number after it if need be."""
    several = (name, *(f"{name}{k}" for k in range(2, len(taken) + 3)))
    return next(n for n in several if n not in taken)


def free_prefix(letter: str, taken: set[str]) -> str:
    """Return a prefix that makes no taken name when a number follows it."""
    while any(name.removeprefix(letter).isdigit() for name in taken if name.startswith(letter)):
        letter += letter[0]
    return letter
