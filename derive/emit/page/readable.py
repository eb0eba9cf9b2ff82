"""A function's equations as a reader wants them, in SymPy, before anything prints them.

Every line is arranged so that what it determines stands on the left. What the equations name in
between is put in where it is short; elsewhere it has a line of its own.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from sympy import Add, Expr, Symbol, cos, preorder_traversal, sin

from derive.lecture.turning import reduced
from derive.lower.arrange.matching import matched

OF_BALANCES = ("mass_centre_motion", "general_form", "moving_point_form", "any_point_form")
OF_MOTION = (
    *("angular_velocities_add", "velocity_of_particle", "velocity_seen_from_axes"),
    *("acceleration_seen_from_axes", "transport_theorem"),
)
"""Steps by which balances stand, and what they name in between."""
LONGEST, SHORT = 45, 12
"""Operations of an equation that is shown whole, and of a part put into one that is longer."""
Determined = tuple[Symbol, Expr, Expr]  # what it determines, left side, right side


@dataclass(frozen=True)
class Readable:
    """A function's equations as a reader wants them.

    groups  : named quantities, balances, answers, each with the lecture steps that they come from;
              what has no step is a definition of the scene's
    found   : the answer that an unknown is
    named   : quantities that have a line, all others put into them, into rows and into answers
    """

    groups: tuple[tuple[tuple[str, ...], tuple[Determined, ...]], ...]
    found: Mapping[Symbol, Symbol]
    named: Mapping[Symbol, Expr]
    rows: tuple[Expr, ...]
    answers: Mapping[Symbol, Expr]


def readable(
    definitions: Mapping[Symbol, Expr], rows: Sequence[Expr], answers: Mapping[Symbol, Expr],
    unknowns: Sequence[Symbol], steps: Sequence[str], loads: frozenset[Symbol],
) -> Readable:  # fmt: skip
    """Return a problem's equations with named quantities where short ones would not do, balances by
    what they determine, answers.

    loads : forces and moments that are given
    """
    named, rows, answers = _put_together(definitions, rows, answers)
    lines: list[Determined] = [(s, s, value) for s, value in named.items()]
    found = {value: s for s, value in reversed([*answers.items()]) if value in unknowns}
    each = _balanced(unknowns, rows, loads)
    balanced = [(found.get(u, u), *sides) for u, *sides in each]
    given = [(s, s, value) for s, value in answers.items() if s not in found.values()]
    of_named = tuple(s for s in steps if s in OF_MOTION) if lines else ()
    of_rows = tuple(s for s in steps if s in (*OF_BALANCES, *OF_MOTION)) if rows else ()
    of_rows = tuple(s for s in of_rows if s not in of_named)
    others = tuple(s for s in steps if s not in (*of_named, *of_rows))
    groups = ((of_named, lines), (of_rows, balanced), (others, given))
    made = tuple((own, tuple(each)) for own, each in groups)
    return Readable(made, found, named, tuple(rows), answers)


def _put_together(
    definitions: Mapping[Symbol, Expr], every: Sequence[Expr], ends: Mapping[Symbol, Expr]
) -> tuple[dict[Symbol, Expr], list[Expr], dict[Symbol, Expr]]:
    """Return the named quantities that keep a line, rows, and answers, with all else put in."""
    whole: dict[Expr, Expr] = {}
    short: dict[Expr, Expr] = {}
    named: dict[Symbol, Expr] = {}
    for symbol, value in definitions.items():
        full, part = _plainer(value.xreplace(short | whole)), _plainer(value.xreplace(short))
        if full.count_ops() <= LONGEST:
            whole[symbol] = full
        if part.count_ops() <= SHORT:
            short[symbol] = part
        else:
            named[symbol] = part

    def shown(value: Expr) -> Expr:
        """Return a value as its line shows it; no line says only that it equals another."""
        terms = Add.make_args(value)
        if len(terms) <= 2:
            value = value.xreplace({s: n for s, n in named.items() if s in terms or -s in terms})
        full = _plainer(value.xreplace(short | whole))
        return full if full.count_ops() <= LONGEST else value.xreplace(short)

    rows = [shown(row) for row in every]
    answers = {s: shown(value) for s, value in ends.items()}
    return _read(named, [*rows, *answers.values()]), rows, answers


def _read(named: dict[Symbol, Expr], ends: Iterable[Expr]) -> dict[Symbol, Expr]:
    """Return the named quantities that other lines speak of, in their order."""
    read = {s for e in ends for s in e.free_symbols}
    kept: dict[Symbol, Expr] = {}
    for symbol, value in reversed(named.items()):
        if symbol in read:
            kept[symbol] = value
            read |= value.free_symbols
    return dict(reversed(kept.items()))


def _plainer(value: Expr) -> Expr:
    """Return a value as it is, or multiplied out with sin^2 = 1 - cos^2 if that is shorter."""
    if not value.has(sin, cos) or _is_flat(value) or value.count_ops() > 4 * LONGEST:
        return value
    return min(value, reduced(value, value.count_ops()), key=lambda e: e.count_ops())


def _is_flat(value: Expr) -> bool:
    """Tell whether nothing in a value can be multiplied out, and no sine is squared."""
    return not any(
        any(f.is_Add for f in e.args)
        if e.is_Mul
        else e.is_Pow and (e.base.is_Add or e.base.func is sin)
        for e in preorder_traversal(value)
    )


def _balanced(
    unknowns: Sequence[Symbol], rows: Sequence[Expr], loads: frozenset[Symbol]
) -> Iterator[Determined]:
    """Yield each unknown with the row that determines it."""
    holds = [frozenset(k for k, u in enumerate(unknowns) if u in r.free_symbols) for r in rows]
    straight = all(k in own for k, own in enumerate(holds))
    places = {k: k for k in range(len(rows))} if straight else matched(holds)
    for k, place in sorted(places.items()):
        yield (unknowns[k], *arranged(rows[place], unknowns[k], unknowns, loads))


def arranged(
    row: Expr, unknown: Symbol, unknowns: Iterable[Symbol], loads: frozenset[Symbol]
) -> tuple[Expr, Expr]:
    """Return left and right of ``row = 0``.

    On the left stands the unknown itself if it is determined outright, else the load that the line
    balances, else every term that holds an unknown.
    """
    terms, held = Add.make_args(row), row.free_symbols & set(unknowns)
    for symbol in [unknown] * (held == {unknown}) + sorted(loads & row.free_symbols, key=str):
        for sign in (1, -1):
            if sign * symbol in terms:
                return symbol, -sign * (row - sign * symbol)
    left = Add(*(term for term in terms if term.free_symbols & held))
    return left, left - row
