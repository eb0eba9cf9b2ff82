"""The classic Runge-Kutta step as a loop over its stages: small instead of fast.

One stage stands there once and is done four times: the rates k, and with them their Jacobian.
From a state y a step of the length h has

    now -> y + (1/2, 1/2, 1) h k,    after = y + h (k1 + 2 k2 + 2 k3 + k4) / 6,

where h / 6 comes last, so that rates that are all but nothing are rounded once. Its derivatives go
back through what the stages have kept (``compact_slopes``).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from derive.motion.attitude.quaternion import norm_squared
from derive.motion.runge_kutta.compact_rows import CarriedWay, KeptSlopes
from derive.motion.runge_kutta.compact_slopes import STAGES, carried_derivatives
from derive.motion.runge_kutta.system import System, rates_at, slopes_at, tape_for
from derive.program.indexed import Arrays, Assign, Element, Index, Loop, Row, Term, element_at
from derive.program.operations import sqrt
from derive.program.program import Line, Op, Operand, Program
from derive.program.recorded import needed
from derive.program.tape import Tape, number


def compact(system: System, step: Program) -> Program:
    """Return ``step``, a classic step of ``system``, in loops; by its length too, as it is."""
    if system.column:
        return step
    tape, way = tape_for(system), CarriedWay(system, step)
    kept = _stages(tape, way)
    after, scale = [tape.input(f"now[{k}]") for k in range(len(system.names))], None
    if (attitude := system.quaternion) is not None:
        scale = 1 / sqrt(norm_squared(after[attitude]))
        after[attitude] = [x * scale for x in after[attitude]]
    entries = carried_derivatives(tape, way, kept, after, scale) if kept else []
    results = (*(x.operand for x in after), *entries)
    return replace(step, ops=needed(tape.ops, results), results=results, unrolled=step)


def _stages(tape: Tape, way: CarriedWay) -> KeptSlopes | None:
    """Record the loop over the stages: ``now`` is the state after it. Return what stages keep."""
    names, (h,) = way.system.names, (tape.input(c) for c in way.system.step.components)
    half, third, sixth = ((h * Fraction(1, k)).operand for k in (2, 3, 6))
    tape.ops.append(Row("parts", (half, half, h.operand, h.operand)))
    tape.ops.append(Row("times", tuple(Fraction(k) for k in (1, 2, 2, 1))))
    if way.system.slopes is not None:
        tape.ops.append(Row("weights", (sixth, third, third, sixth)))
    arrays = ("start", "now", "sum", "rates")
    tape.ops.append(Arrays(tuple((name, (len(names),)) for name in arrays)))
    tape.ops += [Assign(f"start[{k}]", name) for k, name in enumerate(names)]
    start, now, total, rate = (element_at(name, "i") for name in arrays)
    states = Index(), Index(plus=len(names))
    tape.ops.append(Loop("i", *states, (Assign(now, start), Assign(total, Fraction(0)))))
    with tape.within() as body:
        stored, kept = _rates(tape, way, body)
    if kept:
        tape.ops.append(Arrays((("slopes", (STAGES, len(kept.values))),)))
    onward = (
        Assign(total, Term("mul", (element_at("times", "stage"), rate)), "add"),
        Assign(now, Term("add", (start, Term("mul", (element_at("parts", "stage"), rate))))),
    )
    lines = (*_stored_soon(body, stored), Loop("i", *states, onward))
    tape.ops.append(Loop("stage", Index(), Index(plus=STAGES), lines))
    moved = Term("add", (start, Term("mul", (sixth, total))))
    tape.ops.append(Loop("i", *states, (Assign(now, moved),)))
    return kept


StoredValues = Sequence[tuple[Element, Operand]]


def _rates(
    tape: Tape, way: CarriedWay, ops: Sequence[Line]
) -> tuple[StoredValues, KeptSlopes | None]:
    """Record what a stage works out, as ``ops``; return what it stores, and keeps."""
    system, kept = way.system, None
    now = [tape.input(f"now[{k}]") for k in range(len(system.names))]
    if system.slopes is None:
        rates = rates_at(tape, system, now, number(1))
    else:
        rates, slopes = slopes_at(tape, system, now, number(1))
        kept = way.kept(slopes, ops)
    stored = [(element_at("rates", k), x.operand) for k, x in enumerate(rates)]
    values = kept.values if kept else ()
    return [*stored, *((element_at("slopes", "stage", k), x) for k, x in enumerate(values))], kept


def _stored_soon(ops: Sequence[Line], stored: StoredValues) -> Iterator[Line]:
    """Yield operations, what is stored as soon as it is there."""
    made = {op.result for op in ops if isinstance(op, Op)}
    yield from (Assign(place, value) for place, value in stored if value not in made)
    for line in needed(ops, [value for _, value in stored]):
        yield line
        own = line.result if isinstance(line, Op) else None
        yield from (Assign(place, value) for place, value in stored if value == own)
