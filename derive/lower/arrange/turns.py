"""Turns undone one by one along the axes in between, instead of by a matrix multiplied out.

A column that a turn about an axis has made is that turn of what it is where the angle is zero
(lecture step "turned_axes"): so the last turn is found and taken off, then the one before.
"""

from collections.abc import Iterator

from sympy import Expr, Integer, Matrix, cos, sin

from derive.lecture.turning import PLACE, turn_matrix
from derive.lower.arrange.column import NamedColumns

LONGEST = 300  # operations of a column that is multiplied out


def turns_one_by_one(column: Matrix, columns: NamedColumns) -> Matrix | None:
    """Return a column made by two or more turns as those turns one after another."""
    if sum(e.count_ops() for e in column) > LONGEST:
        return None
    turns: list[Matrix] = []
    inner = column
    while found := next(_last_turns(inner), None):
        turn, inner = found
        turns.append(turn)
    if len(turns) < 2:
        return None
    vector = inner
    for turn in reversed(turns):
        vector = turn * columns.column("turned", vector)
    return vector


def _last_turns(column: Matrix) -> Iterator[tuple[Matrix, Matrix]]:
    """Yield matrices of turns that may have made a column last, and what they have turned."""
    angles = sorted({e.args[0] for e in column.atoms(sin, cos)}, key=str)
    for angle in angles:
        inner = column.xreplace({sin(angle): Integer(0), cos(angle): Integer(1)})
        for axis in (a for a, k in PLACE.items() if not _turns(column[k], angle)):
            for turn in (turn_matrix(axis, angle), turn_matrix(axis, angle).T):
                if all(e.expand() == 0 for e in turn * inner - column):
                    yield turn, inner


def _turns(e: Expr, angle: Expr) -> bool:
    return bool(e.has(sin(angle), cos(angle)))
