"""The classic Runge-Kutta step as loops over its stages and columns: small instead of fast.

Rates and the nonzeros of their Jacobian are worked out in one place, four times. Then one column
of derivatives after the other is carried forward through the stages, by a table of the pattern.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from derive.motion.runge_kutta.system import System, pattern_of
from derive.program.indexed import (
    Arrays,
    Assign,
    Element,
    Index,
    IndexedOperand,
    Integers,
    Loop,
    Row,
    Same,
    Term,
)
from derive.program.program import Line, Operand, Program, Sparsity
from derive.program.recorded import renamed

WEIGHTS = (1, 2, 2, 1)
SIXTH = Fraction(1, 6)
ZERO, ONE = Fraction(0), Fraction(1)


@dataclass(frozen=True)
class Carried:
    """The derivatives that are carried: pattern of the rates' Jacobian and of the step's.

    first : which of the rates' columns the first of the step's is
    """

    rates: Sparsity
    step: Sparsity
    first: int


def compact(system: System, step: Program) -> Program:
    """Return ``step``, a classic step of ``system``, in loops; of a tangent space as it is."""
    columns, rate = None, system.rate
    if step.sparsity:
        own = step.sparsity["jacobian"]
        if not {*own.columns} <= {*pattern_of(system).columns}:
            return step
        columns = Carried(pattern_of(system), own, system.columns.index(own.columns[0]))
        rate = system.slopes or rate
    starts = [place.start for place in system.quaternions]
    attitude = range(starts[0], starts[0] + 4) if starts else None
    lines = (
        *_stages(system.names, rate, columns, step),
        *(_unit(attitude) if attitude else ()),
        *(_columns(len(system.names), columns, attitude) if columns else ()),
    )
    ends = [f"after[{k}]" for k in range(len(system.names))]
    entries = [f"jacobian[{k}]" for k in range(len(columns.step.row) if columns else 0)]
    return replace(step, ops=lines, results=(*ends, *entries), unrolled=step)


def _at(array: str, *counters: str) -> Element:
    return Element(array, tuple(Index(counter) for counter in counters))


def _times(a: IndexedOperand, b: IndexedOperand) -> Term:
    return Term("mul", (a, b))


def _plus(a: IndexedOperand, b: IndexedOperand) -> Term:
    return Term("add", (a, b))


def _each(counter: str, places: range, *body: Line) -> Loop:
    return Loop(counter, Index(plus=places.start), Index(plus=places.stop), body)


def _stages(
    names: Sequence[str], rate: Program, columns: Carried | None, step: Program
) -> Iterator[Line]:
    """Yield what works out the state after the step, before its attitude has length one."""
    states = range(len(names))
    if columns is not None:
        yield Integers("rates_colind", columns.rates.colind)
        yield Integers("rates_row", columns.rates.row)
        yield Integers("step_colind", columns.step.colind)
        yield Integers("step_row", columns.step.row)
    yield Row("weights", tuple(map(Fraction, WEIGHTS)))
    yield Assign("half", _times(Fraction(1, 2), "time_step"), makes="constant")
    yield Assign("sixth", _times(SIXTH, "time_step"), makes="constant")
    yield Row("parts", ("half", "half", "time_step", "time_step"))
    yield Arrays(tuple((name, (len(names),)) for name in ("start", "now", "after", "rates")))
    if columns is not None:
        yield Arrays((("slopes", (len(WEIGHTS), len(columns.rates.row))),))
    yield from (Assign(f"start[{k}]", name) for k, name in enumerate(names))
    yield _each(
        "i", states, Assign(_at("now", "i"), _at("start", "i")), Assign(_at("after", "i"), ZERO)
    )
    here, change = _at("after", "i"), _at("rates", "i")
    yield _each(
        "stage",
        range(len(WEIGHTS)),
        *_rates(names, rate, step),
        _each(
            "i",
            states,
            Assign(here, _times(_at("weights", "stage"), change), "add"),
            Assign(
                _at("now", "i"), _plus(_at("start", "i"), _times(_at("parts", "stage"), change))
            ),
        ),
    )
    yield _each("i", states, Assign(here, _plus(_at("start", "i"), _times("sixth", here))))


def _rates(names: Sequence[str], rate: Program, step: Program) -> Iterator[Line]:
    """Yield what works out the rates at ``now``, and the nonzeros of their Jacobian."""
    now = {name: f"now[{k}]" for k, name in enumerate(names)}
    arrays = {c for q in step.inputs if q.shape and q.role != "constants" for c in q.components}
    yield from renamed(rate.ops, now)
    held = {r: f"{r}_in" for r in rate.results if isinstance(r, str) and r in arrays | set(now)}
    yield from (Assign(own, now.get(r, r), makes="constant") for r, own in held.items())

    def result(r: Operand) -> Operand:
        return held.get(r, r) if isinstance(r, str) else r

    for k, r in enumerate(rate.results):
        place = Element("slopes", (Index("stage"), Index(plus=k - len(names))))
        yield Assign(f"rates[{k}]" if k < len(names) else place, result(r))


def _unit(attitude: range) -> Iterator[Line]:
    """Yield what makes the attitude of length one."""
    q = _at("after", "i")
    yield Assign("squared", ZERO, makes="variable")
    yield _each("i", attitude, Assign("squared", _times(q, q), "add"))
    yield Assign("scale", Term("div", (ONE, Term("sqrt", ("squared",)))), makes="constant")
    yield _each("i", attitude, Assign(q, _times(q, "scale")))


def _columns(n: int, columns: Carried, attitude: range | None) -> Iterator[Line]:
    """Yield the loop over the columns of derivatives."""
    every, first = len(columns.rates.columns), columns.first
    own, place = Same(Index("i"), Index("column")), Index("column", -first)
    states, total, change = range(n), _at("total", "i"), _at("change", "i")
    product = _times(_at("slopes", "stage", "entry"), _at("moved", "k"))
    row = Element("change", (Index("entry", table="rates_row"),))
    entries = Loop(
        "entry",
        Index("k", table="rates_colind"),
        Index("k", 1, "rates_colind"),
        (Assign(row, product, "add"),),
    )
    stage = (
        _each("i", states, Assign(change, ZERO)),
        _each("k", range(every), entries),
        _each(
            "i",
            states,
            Assign(total, _times(_at("weights", "stage"), change), "add"),
            Assign(_at("moved", "i"), _plus(own, _times(_at("parts", "stage"), change))),
        ),
    )
    stored = Element("total", (Index("entry", table="step_row"),))
    yield _each(
        "column",
        range(first, first + len(columns.step.columns)),
        Arrays((("moved", (every,)), ("change", (n,)), ("total", (n,)))),
        _each("i", range(every), Assign(_at("moved", "i"), own)),
        _each("i", states, Assign(total, ZERO)),
        _each("stage", range(len(WEIGHTS)), *stage),
        _each("i", states, Assign(total, _plus(own, _times("sixth", total)))),
        *(_on_the_sphere(attitude) if attitude else ()),
        Loop(
            "entry",
            Index(place.counter, place.plus, "step_colind"),
            Index(place.counter, place.plus + 1, "step_colind"),
            (Assign(_at("jacobian", "entry"), stored),),
        ),
    )


def _on_the_sphere(attitude: range) -> Iterator[Line]:
    """Yield what takes from a column what would change the attitude's length."""
    q, total = _at("after", "i"), _at("total", "i")
    yield Assign("along", ZERO, makes="variable")
    yield _each(
        "i",
        attitude,
        Assign(total, _times(total, "scale")),
        Assign("along", _times(q, total), "add"),
    )
    yield _each("i", attitude, Assign(total, _times(q, "along"), "sub"))
