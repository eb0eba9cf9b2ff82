"""Derivatives of the classic step in loops: each row goes back through the four stages.

Stages keep A and B, the rates' Jacobian by the states and by the rest. A row s of derivatives by
the state after a step of the length h begins with n = 0, and from the last stage to the first

    m -> (1, 2, 2, 1) h s / 6 + (1/2, 1/2, 1) h n,    n -> m A.

It ends as s + sum n by the state and sum m B by the rest. AlikeRows that do alike are one loop.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from derive.motion.runge_kutta.compact_rows import AlikeRows, CarriedWay, KeptSlopes
from derive.motion.runge_kutta.matrices import (
    Matrix,
    NumberRow,
    identity,
    lifted,
    minus,
    product,
    tangent_matrix,
    times,
    transposed,
)
from derive.motion.runge_kutta.system import slopes_of
from derive.program.indexed import Arrays, Assign, Element, Index, Integers, Loop, Same, element_at
from derive.program.program import Operand, Program
from derive.program.recorded import called, needed
from derive.program.tape import Number, Tape, number

STAGES = 4


@dataclass(frozen=True)
class GoingBack:
    """How rows go back: on a tape, through what stages keep, and columns of B by row."""

    tape: Tape
    way: CarriedWay
    kept: KeptSlopes
    still: Mapping[int, Mapping[int, Number]]

    def read(self, place: Element | Same) -> Number:
        """Record that a place of an array is read."""
        name = self.tape.fresh()
        self.tape.ops.append(Assign(name, place, makes="constant"))
        return Number(self.tape, name)

    def fresh(self, of: Iterable[int]) -> dict[int, Number]:
        """Return numbers that a loop carries."""
        return {k: Number(self.tape, self.tape.fresh()) for k in sorted(of)}


def carried_derivatives(
    tape: Tape, way: CarriedWay, kept: KeptSlopes, after: NumberRow, scale: Number | None
) -> list[Operand]:
    """Record the loops over rows; return where the nonzeros of the step's Jacobian are.

    scale : what makes the attitude after the step of length one, None if there is none
    """
    plain = dict(zip(way.plain, _called(tape, way.step, way.plain.values()), strict=True))
    slopes = slopes_of(way.system)
    still = {
        column: dict(zip(rows, _called(tape, slopes, rows.values()), strict=True))
        for column, rows in way.still.items()
    }
    if scale is not None:
        _seeds(tape, times(scale, _unscaled(after[way.system.quaternion or slice(0)], way)))
    for k, rows in enumerate(way.alike()):
        _loop(GoingBack(tape, way, kept, still), rows, f"apart_{k}")
    entries = range(len(way.pattern.row))
    return [plain[k].operand if k in plain else f"jacobian[{k}]" for k in entries]


def _called(tape: Tape, program: Program, results: Iterable[Operand]) -> list[Number]:
    """Return results of a program that rest on no state."""
    wanted = tuple(results)
    cut = replace(program, ops=needed(program.ops, wanted), results=wanted)
    return called(tape, cut, {c: tape.input(c) for q in cut.inputs for c in q.components})


def _unscaled(q: NumberRow, way: CarriedWay) -> Matrix:
    """Return what an attitude's rows begin as: its change on the sphere, or twice its errors."""
    if way.errors:
        return times(2, transposed(tangent_matrix(q)))
    return minus(identity(4), product([[x] for x in q], [q]))


def _seeds(tape: Tape, rows: Matrix) -> None:
    tape.ops.append(Arrays((("seeds", (len(rows), 4)),)))
    for i, row in enumerate(rows):
        tape.ops += [Assign(element_at("seeds", i, k), x.operand) for k, x in enumerate(row)]


def _loop(back: GoingBack, rows: AlikeRows, table: str) -> None:
    """Record how some rows are carried back, in a loop if they are several."""
    tape, spots = back.tape, back.way.spots(rows)
    if len(rows.rows) == 1:
        _row(back, rows, [Index(plus=k) for (k,) in spots.values()])
        return
    tables: dict[tuple[int, ...], str] = {tuple(range(len(rows.rows))): ""}
    targets = list[Index]()
    for first, *others in spots.values():
        apart = (0, *(k - first for k in others))
        if apart not in tables:
            tables[apart] = f"{table}_{len(tables)}"
            tape.ops.append(Integers(tables[apart], apart))
        name = tables[apart]
        targets.append(Index("row", 0, name, first) if name else Index("row", first))
    with tape.within() as body:
        _row(back, rows, targets)
    tape.ops.append(Loop("row", Index(), Index(plus=len(rows.rows)), tuple(body)))


def _row(back: GoingBack, rows: AlikeRows, targets: Sequence[Index]) -> None:
    """Record how a row is carried back, and where what it ends as is put."""
    way, spots = back.way, [*back.way.spots(rows)]
    asked = way.asked(spots)
    seeds = _seeds_of(back, rows, asked)
    totals, sums = _carried(back, rows, seeds, asked)
    full = [seeds.get(c, number(0)) for c in range(len(way.system.columns))]
    for c, total in totals.items():
        full[c] = full[c] + total
    for c in asked & back.still.keys():
        for k, x in back.still[c].items():
            if k in sums:
                full[c] = full[c] + sums[k] * x
    if way.errors:
        places = range(way.errors.start, way.errors.stop)
        start = [back.tape.input(f"start[{k}]") for k in places]  # the input may be stored over
        (full,) = lifted(start, way.errors, [full])
    ends = full[len(full) - len(way.pattern.columns) :]
    for column, target in zip(spots, targets, strict=True):
        back.tape.ops.append(Assign(Element("jacobian", (target,)), ends[column].operand))


NumbersByPlace = dict[int, Number]


def _carried(
    back: GoingBack, rows: AlikeRows, seeds: NumbersByPlace, asked: set[int]
) -> tuple[NumbersByPlace, NumbersByPlace]:
    """Record the loop over the stages; return the sums of n, and those of m that B needs."""
    tape, way, reached = back.tape, back.way, back.way.reached(rows.own)
    n = back.fresh(reached & way.reads.keys())
    totals = back.fresh(reached & asked - back.still.keys())
    used = {k for c in asked & back.still.keys() for k in back.still[c]}
    sums = back.fresh(used & {*seeds, *n})
    with tape.within() as stage:
        weight, part = (back.read(element_at(name, "stage")) for name in ("weights", "parts"))
        m = {
            k: n.get(k, number(0)) * part + seeds.get(k, number(0)) * weight
            for k in sorted({*n, *seeds} & way.reads.keys())
        }
        gains = _gains(back, m, {*n, *totals})
        then = [*(gains[k] for k in n), *(x + gains[k] for k, x in totals.items())]
        then += [x + m[k] for k, x in sums.items()]
    carried = tuple(str(x.operand) for each in (n, totals, sums) for x in each.values())
    start, after = (Fraction(0),) * len(carried), tuple(x.operand for x in then)
    turns = Index(plus=STAGES - 1), Index(plus=-1), tuple(stage)
    tape.ops.append(Loop("stage", *turns, -1, carried=carried, start=start, then=after))
    return totals, sums


def _seeds_of(back: GoingBack, rows: AlikeRows, asked: set[int]) -> NumbersByPlace:
    """Return what a row begins as, by the states that it is used by."""
    used = [(k, own) for k, own in enumerate(rows.own) if own in back.way.reads or own in asked]
    if back.way.is_of_attitude(rows):
        return {own: back.read(element_at("seeds", "row", k)) for k, own in used}
    if len(rows.rows) == 1:
        return {own: number(1) for _, own in used}
    return {own: back.read(Same(Index("row"), Index(plus=k))) for k, own in used}


def _gains(back: GoingBack, m: NumbersByPlace, wanted: Iterable[int]) -> NumbersByPlace:
    """Return the product of a row with the entries of A and B that a stage has kept."""
    values: NumbersByPlace = {}
    gains = dict.fromkeys(sorted(wanted), number(0))
    for (row, column), (factor, k) in back.kept.entries.items():
        if row not in m or column not in gains:
            continue
        if k is None:
            gains[column] = gains[column] + m[row] * factor
            continue
        if k not in values:
            values[k] = back.read(element_at("slopes", "stage", k))
        term = m[row] * values[k]
        gains[column] = gains[column] + term if factor > 0 else gains[column] - term
    return gains
