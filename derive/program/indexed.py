"""Loops over places of arrays: what a program is made of beside operations on single values.

Every loop's end is known before, so that a count walks it as a run does. In a run an array is known
place by place, under the name that C has for it: ``after[3]``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal

Counters = Mapping[str, int]
ArrayValues = Mapping[str, Any]


@dataclass(frozen=True)
class Index:
    """A whole number: a counter and so much more, or what a table has at that place, and more."""

    counter: str = ""
    plus: int = 0
    table: str = ""
    beyond: int = 0

    def __repr__(self) -> str:
        """Return what a digest of programs reads: of the last, only what is there."""
        more = f", beyond={self.beyond}" if self.beyond else ""
        return f"Index(counter={self.counter!r}, plus={self.plus}, table={self.table!r}{more})"

    def __str__(self) -> str:
        sign = "-" if self.plus < 0 else "+"
        more = f" {sign} {abs(self.plus)}" if self.plus else ""
        inside = f"{self.counter}{more}" if self.counter else str(self.plus)
        if not self.table:
            return inside
        return f"{self.table}[{inside}]" + (f" + {self.beyond}" if self.beyond else "")

    def at(self, counters: Counters, tables: ArrayValues) -> int:
        """Return the number where loops have got to."""
        place = counters.get(self.counter, 0) + self.plus
        return int(tables[self.table][place]) + self.beyond if self.table else place


@dataclass(frozen=True)
class Element:
    """A place of an array."""

    array: str
    places: tuple[Index, ...]

    def __str__(self) -> str:
        return self.array + "".join(f"[{place}]" for place in self.places)

    def at(self, counters: Counters, tables: ArrayValues) -> str:
        """Return its name where loops have got to."""
        return self.array + "".join(f"[{place.at(counters, tables)}]" for place in self.places)


def element_at(array: str, *places: str | int) -> Element:
    """Return a place of an array, by counters and numbers."""
    every = (Index(p) if isinstance(p, str) else Index(plus=p) for p in places)
    return Element(array, tuple(every))


@dataclass(frozen=True)
class Whole:
    """A counter as a value."""

    index: Index


@dataclass(frozen=True)
class Same:
    """One where two counters are the same, else zero."""

    one: Index
    other: Index


@dataclass(frozen=True)
class Term:
    """An operator on values that have no names of their own."""

    operator: str
    operands: tuple[IndexedOperand, ...]


IndexedOperand = str | Fraction | Element | Whole | Same | Term


@dataclass(frozen=True)
class Arrays:
    """Arrays by name, each with its sizes."""

    sizes: tuple[tuple[str, tuple[int, ...]], ...]


@dataclass(frozen=True)
class Integers:
    """A constant table of whole numbers."""

    name: str
    values: tuple[int, ...]


@dataclass(frozen=True)
class Row:
    """An array that holds these values and keeps them."""

    name: str
    values: tuple[str | Fraction, ...]


@dataclass(frozen=True)
class Assign:
    """``target`` becomes a value, or with ``adds`` "add" or "sub" that much more or less.

    makes : whether the name is made here, and may change later
    """

    target: str | Element
    value: IndexedOperand
    adds: Literal["", "add", "sub"] = ""
    makes: Literal["", "constant", "variable"] = ""


@dataclass(frozen=True)
class Loop:
    """``body`` for every whole number from ``first``, before ``last``.

    counter : its name, none if nothing reads it        step : 1 upwards, -1 downwards
    mirror  : a counter that goes down from ``last`` - 1 meanwhile; with ``meets`` until they meet
    carried : values that begin as ``start`` and become ``then`` after each turn
    done    : a truth; once it is, what is carried stays as it is, so the loop means the same
              unrolled
    """

    counter: str
    first: Index
    last: Index
    body: tuple[Any, ...]
    step: Literal[1, -1] = 1
    mirror: str = ""
    meets: bool = False
    carried: tuple[str, ...] = ()
    start: tuple[str | Fraction, ...] = ()
    then: tuple[str | Fraction, ...] = ()
    done: str | Fraction | None = None

    def __post_init__(self) -> None:
        """Refuse a loop that may end early and changes what it does not carry."""
        if self.done is not None and any(isinstance(line, Indexed) for line in self.body):
            raise ValueError("a loop that ends when something is done must carry what it changes")

    def turns(self, counters: Counters, tables: ArrayValues) -> Iterator[dict[str, int]]:
        """Yield the counters of each turn."""
        first, last = self.first.at(counters, tables), self.last.at(counters, tables)
        for n, now in enumerate(range(first, last, self.step)):
            other = last - 1 - n
            if self.meets and now >= other:
                return
            both = ((self.counter, now), (self.mirror, other))
            yield {name: place for name, place in both if name}


@dataclass(frozen=True)
class Even:
    """``body`` where a counter is even, with half of it."""

    counter: str
    half: str
    body: tuple[Any, ...]

    def turns(self, counters: Counters, _: ArrayValues) -> Iterator[dict[str, int]]:
        """Yield the half, if the counter is even."""
        now = counters[self.counter]
        if now % 2 == 0:
            yield {self.half: now // 2}


Indexed = Arrays | Integers | Row | Assign | Loop | Even


def value_at(
    value: IndexedOperand, arithmetic: ArrayValues, known: Mapping[str, Any], at: Counters
) -> Any:
    """Return a value in an arithmetic, where loops have got to."""
    match value:
        case str():
            return known[value]
        case Element():
            return known[value.at(at, known)]
        case Term():
            parts = [value_at(o, arithmetic, known, at) for o in value.operands]
            return arithmetic[value.operator](*parts)
        case Whole():
            return arithmetic["number"](Fraction(value.index.at(at, known)))
        case Same():
            same = value.one.at(at, known) == value.other.at(at, known)
            return arithmetic["number"](Fraction(int(same)))
    return arithmetic["number"](value)


def operators_in(line: Indexed) -> Iterator[str]:
    """Yield the operators of a statement that is no loop."""
    if isinstance(line, Assign):
        if line.adds:
            yield line.adds
        yield from (term.operator for term in _within(line.value) if isinstance(term, Term))


def names_in(line: Indexed) -> set[str]:
    """Return the names that a statement reads; of a loop, its body is asked."""
    if isinstance(line, Row):
        return {value for value in line.values if isinstance(value, str)}
    read = _within(line.value) if isinstance(line, Assign) else ()
    return {value for value in read if isinstance(value, str)}


def _within(value: IndexedOperand) -> Iterator[IndexedOperand]:
    yield value
    if isinstance(value, Term):
        for operand in value.operands:
            yield from _within(operand)
