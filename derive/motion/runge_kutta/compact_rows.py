"""Rows of a compact step's derivatives: which are carried back alike, through what, to where."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from derive.motion.runge_kutta.dependence import rests_on
from derive.motion.runge_kutta.matrices import Matrix
from derive.motion.runge_kutta.system import System, pattern_of, slopes_of
from derive.program.program import Line, Op, Operand, Program, Sparsity, placed

ALIKE = Fraction(3, 4)
"""So much of what a loop over rows works out is each row's own, or it has a loop of its own."""
EntryPlace = tuple[int, int]


@dataclass(frozen=True)
class KeptSlopes:
    """What each stage keeps, and what entries of A and B are of it: a factor, and whose."""

    values: tuple[str, ...]
    entries: Mapping[EntryPlace, tuple[Fraction, int | None]]


@dataclass(frozen=True)
class AlikeRows:
    """AlikeRows that are carried back alike, and the states that their seeds are by."""

    rows: tuple[int, ...]
    own: tuple[int, ...]

    def __add__(self, other: AlikeRows) -> AlikeRows:
        """Return both as one."""
        return AlikeRows(self.rows + other.rows, self.own + other.own)


@dataclass(frozen=True)
class CarriedWay:
    """The derivatives of a fast step, and the rates' slopes that they come from."""

    system: System
    step: Program

    @cached_property
    def pattern(self) -> Sparsity:
        """Return the pattern of the derivatives."""
        return (self.step.sparsity or {})["jacobian"]

    @cached_property
    def places(self) -> Mapping[EntryPlace, int]:
        """Return where derivatives stand among the nonzeros, by row and column."""
        return {place: k for k, place in enumerate(self.pattern.places())}

    @cached_property
    def plain(self) -> Mapping[int, Operand]:
        """Return the nonzeros that rest on no state, by their places."""
        n, states = len(self.system.names), {*self.system.names}
        entries = zip(self.step.results[n:], rests_on(self.step)[n:], strict=True)
        return {k: operand for k, (operand, by) in enumerate(entries) if not by & states}

    @cached_property
    def slopes(self) -> Mapping[EntryPlace, Operand]:
        """Return the entries of A and B."""
        entries = slopes_of(self.system).results[len(self.system.names) :]
        return dict(zip(pattern_of(self.system).places(), entries, strict=True))

    @cached_property
    def still(self) -> Mapping[int, Mapping[int, Operand]]:
        """Return the columns of B that no stage changes, by row."""
        n, states = len(self.system.names), {*self.system.names}
        rests = rests_on(slopes_of(self.system))[n:]
        moving = {c for (_, c), by in zip(self.slopes, rests, strict=True) if by & states}
        columns = {c for _, c in self.slopes if c >= n} - moving
        return {c: {r: x for (r, k), x in self.slopes.items() if k == c} for c in sorted(columns)}

    @cached_property
    def reads(self) -> Mapping[int, frozenset[int]]:
        """Return the columns of A and B in which rows have entries."""
        return {row: frozenset(c for r, c in self.slopes if r == row) for row, _ in self.slopes}

    @cached_property
    def errors(self) -> slice | None:
        """Return where three errors stand for the attitude, None if none do."""
        return self.system.quaternion if self.step.name.endswith("_tangent") else None

    def kept(self, slopes: Matrix, ops: Sequence[Line]) -> KeptSlopes:
        """Return what stages keep of the rates' Jacobian (n, n + m) that ``ops`` work out."""
        signs = {
            op.result: op.operands[0] for op in ops if isinstance(op, Op) and op.operator == "neg"
        }
        values: dict[str, int] = {}
        entries: dict[EntryPlace, tuple[Fraction, int | None]] = {}
        for row, column in self.slopes:
            operand = slopes[row][column].operand
            if isinstance(operand, Fraction):
                entries[row, column] = operand, None
            elif column not in self.still:
                value = str(signs.get(operand, operand))
                sign = Fraction(1 if value == operand else -1)
                entries[row, column] = sign, values.setdefault(value, len(values))
        return KeptSlopes(tuple(values), entries)

    def is_of_attitude(self, rows: AlikeRows) -> bool:
        """Tell whether these are the rows of the attitude, or of its errors."""
        place = self.system.quaternion
        return place is not None and rows.own[0] == place.start

    def reached(self, own: Iterable[int]) -> set[int]:
        """Return the columns of A and B that rows come to."""
        found, ahead = set[int](), {*own}
        while ahead:
            ahead = set[int]().union(*(self.reads.get(k, ()) for k in ahead)) - found
            found |= ahead
        return found

    def cost(self, rows: AlikeRows) -> int:
        """Return how many entries of A and B a row is multiplied by."""
        used = {*rows.own} | self.reached(rows.own)
        return len([row for row, _ in self.slopes if row in used])

    def spots(self, rows: AlikeRows) -> dict[int, list[int]]:
        """Return where a loop puts the entries of its rows, by column of the pattern."""
        found = {}
        for column in range(len(self.pattern.columns)):
            every = [self.places.get((row, column), -1) for row in rows.rows]
            if {*every} - {-1, *self.plain}:
                found[column] = every
        return found

    def is_whole(self, rows: AlikeRows) -> bool:
        """Tell whether where one of these rows has an entry all have."""
        return not any(-1 in every for every in self.spots(rows).values())

    def alike(self) -> list[AlikeRows]:
        """Return the rows of each loop."""
        found, first = list[AlikeRows](), 0
        for q, place in placed(self.system.states):
            count = 3 if q.is_quaternion and self.errors else len(q.components)
            rows = AlikeRows(
                tuple(range(first, first + count)), tuple(range(place.start, place.stop))
            )
            first += count
            joins = [k for k, some in enumerate(found) if self._joins(some, rows)]
            if joins:
                found[joins[0]] += rows
            elif q.is_quaternion or self.is_whole(rows):
                found.append(rows)
            else:
                found += [
                    AlikeRows((row,), (own,)) for row, own in zip(rows.rows, rows.own, strict=True)
                ]
        return [rows for rows in found if self.spots(rows)]

    def _joins(self, some: AlikeRows, more: AlikeRows) -> bool:
        """Tell whether rows may be in one loop with others, none of them of an attitude."""
        if self.is_of_attitude(some) or self.is_of_attitude(more):
            return False
        fewest = min(self.cost(some), self.cost(more))
        return fewest >= ALIKE * self.cost(some + more) and self.is_whole(some + more)

    def asked(self, columns: Iterable[int]) -> set[int]:
        """Return the states, and the rest, that columns of the pattern are of."""
        more = len(self.system.columns) - len(self.pattern.columns)
        if self.errors is None:
            return {c + more for c in columns}
        first = self.errors.start
        parts = [
            range(first, first + 4) if 0 <= c - first < 3 else [c + (c > first)] for c in columns
        ]
        return {c for each in parts for c in each}
