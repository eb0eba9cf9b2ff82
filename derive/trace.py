"""Formulas written over numbers, recorded as the operations of a program.

Steppers and attitude formulas are written once, in plain Python, over ``Number``. What depends on
parameters only goes to the tape of set-up and is worked out there in twice the working precision;
the rest goes to the tape of the function. Equal operations are recorded once; exact numbers are
folded; nothing is re-ordered, so an error-free transformation stays one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial

from derive.program import Line, Op, Operand, Program, Repeat

COMMUTATIVE = ("add", "mul", "both", "either")


@dataclass
class Tape:
    """Operations as they are recorded; ``below`` is the tape of set-up, if this is a function's.

    names : what set-up's values are called as constants, with what is said of each
    """

    prefix: str
    below: Tape | None = None
    ops: list[Line] = field(default_factory=list)
    names: dict[str, tuple[str, str]] = field(default_factory=dict)
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
        same = sorted(operands, key=str) if operator in COMMUTATIVE else operands
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
            taken = {own for own, _ in self.names.values()}
            several = (name, *(f"{name}{k}" for k in range(2, len(taken) + 3)))
            self.names[operand] = (next(n for n in several if n not in taken), says)

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


def number(x: Number | int | Fraction) -> Number:
    """Return an exact number, or ``x`` if it is one of ours already."""
    return x if isinstance(x, Number) else Number(None, Fraction(x))


def operation(operator: str, *values: Number | int | Fraction) -> Number:
    """Record an operation on the highest of its operands' tapes."""
    numbers = [number(v) for v in values]
    tapes = [n.tape for n in numbers if n.tape is not None]
    hot = [t for t in tapes if t.below is not None]
    if not tapes:
        raise ValueError(f"{operator} of exact numbers alone is no operation of a program")
    tape = (hot or tapes)[0]
    return Number(tape, tape.record(operator, tuple(_seen_from(tape, n) for n in numbers)))


def _seen_from(tape: Tape, n: Number) -> Operand:
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


def unit_roundoff(tape: Tape) -> Number:
    """Return u of the arithmetic that the program runs in: half the distance from 1 to the next."""
    return Number(tape, tape.record("unit_roundoff", ()))


def splitter(tape: Tape) -> Number:
    """Return the number that splits a float into halves, 2^ceil(p/2) + 1 for p bits (Veltkamp)."""
    return Number(tape, tape.record("splitter", ()))


def sqrt(x: Number) -> Number:
    """Return the square root."""
    return operation("sqrt", x)


def sin(x: Number) -> Number:
    """Return the sine of an angle in rad."""
    return operation("sin", x)


def cos(x: Number) -> Number:
    """Return the cosine of an angle in rad."""
    return operation("cos", x)


def atan2(y: Number | int, x: Number | int) -> Number:
    """Return the angle of the point (x, y), in rad, from -pi to pi."""
    return operation("atan2", y, x)


def exp(x: Number) -> Number:
    """Return e to the power x."""
    return operation("exp", x)


def log(x: Number) -> Number:
    """Return the natural logarithm."""
    return operation("log", x)


def floor(x: Number) -> Number:
    """Return the largest whole number that is not above ``x``."""
    return operation("floor", x)


def absolute(x: Number) -> Number:
    """Return ``x`` without its sign."""
    return operation("abs", x)


def power_of_two(x: Number) -> Number:
    """Return the power of two at or next to ``x`` > 0."""
    return operation("power_of_two", x)


def less(a: Number | int | Fraction, b: Number | int | Fraction) -> Number:
    """Return the truth of a < b, for ``select``, ``both`` and ``either``."""
    return operation("less", a, b)


def at_most(a: Number | int | Fraction, b: Number | int | Fraction) -> Number:
    """Return the truth of a <= b."""
    return operation("at_most", a, b)


def both(a: Number, b: Number) -> Number:
    """Return the truth of a and b."""
    return operation("both", a, b)


def either(a: Number, b: Number) -> Number:
    """Return the truth of a or b."""
    return operation("either", a, b)


def select(condition: Number, yes: Number | int | Fraction, no: Number | int | Fraction) -> Number:
    """Return ``yes`` where ``condition`` is true, else ``no``; both are worked out."""
    if number(yes) == number(no):
        return number(yes)
    return operation("select", condition, yes, no)


Body = Callable[[list[Number]], tuple[Sequence[Number], Number | None]]


def repeat(tape: Tape, passes: int, start: Sequence[Number], body: Body) -> list[Number]:
    """Record a loop: ``body`` takes what is carried, and returns it anew and the truth of done.

    A loop that is there already, whatever its values are called, is not recorded twice.
    """
    names = [tape.fresh() for _ in start]
    with tape.within() as ops:
        then, done = body([Number(tape, name) for name in names])
        after = tuple(_seen_from(tape, number(n)) for n in then)
        until = None if done is None else _seen_from(tape, done)
    inner = tuple(op for op in ops if isinstance(op, Op))
    if len(inner) < len(ops):
        raise ValueError("a loop within a loop is not there")
    begin = tuple(_seen_from(tape, number(n)) for n in start)
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

    def called(operand: Operand | None) -> object:
        return places.get(operand, operand) if isinstance(operand, str) else operand

    steps = ((op.operator, *map(called, op.operands)) for op in loop.ops)
    ends = (*map(called, loop.then), called(loop.done))
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
        elif wanted & set(line.carried):
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
    inputs = [c for q in program.inputs if q.name != "constants" for c in q.components]
    known = {name: number(values[name]) for name in inputs}

    def value(operand: Operand) -> Number:
        if isinstance(operand, str):
            return known.get(operand) or Number(tape, operand)  # what is left are constants
        return number(operand)

    for op in program.ops:
        if not isinstance(op, Op):
            raise TypeError(f"'{program.name}' has a loop, and a loop cannot be called yet")
        known[op.result] = _OPERATIONS.get(op.operator, partial(operation, op.operator))(
            *map(value, op.operands)
        )
    return [value(result) for result in program.results]


_OPERATIONS: Mapping[str, Callable[..., Number]] = {
    "add": _add,
    "sub": _sub,
    "mul": _mul,
    "div": _div,
    "neg": Number.__neg__,
}
