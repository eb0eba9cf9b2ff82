"""Reactions beside accelerations: by balances of all outboard, once more, with motion known.

Where accelerations are found by the links alone, each reaction follows from a balance that holds no
other. It is written with accelerations as what is given, so that no coefficient of theirs is made.
"""

from collections.abc import Mapping
from dataclasses import replace

from sympy import Expr, Symbol

from derive.mechanics.balance import ValuedBalance
from derive.mechanics.balances import Balances
from derive.mechanics.frames import Frames
from derive.mechanics.outboard import Outboard, held_beyond, needed_by, outboard


def reactions(
    balances: Balances, moved: frozenset[Symbol], sought: frozenset[Symbol]
) -> Mapping[Symbol, Expr] | None:
    """Return reactions and what is on the way to them, by what moves; None if others are needed."""
    if not sought:
        return {}
    of, every = outboard(balances), balances.unknowns
    known = {k for k, u in enumerate(every) if u in moved}
    names = sorted(sought, key=str)
    rows = [_telling(of, every.index(u), known) for u in names]
    if any(row is None for row in rows):
        return None
    words = balances.frames.words
    sheet = replace(words.sheet, unknowns=words.sheet.unknowns - moved, definitions={}, labels={},
                    parts={}, because={}, rates=dict(words.sheet.rates))  # fmt: skip
    given = Balances(Frames(balances.frames.machine, replace(words, sheet=sheet)))
    place = {u: k for k, u in enumerate(given.unknowns)}
    held = {frame: frozenset(place[every[k]] for k in own if every[k] in place)
            for frame, own in held_beyond(of).items()}  # fmt: skip
    found: dict[Symbol, Expr] = {}
    chosen = [row for row in rows if row is not None]
    for u, e in zip(names, needed_by(given, chosen, held, of), strict=True):
        rest, slopes = sheet.split(e)
        if not slopes[u].is_Number:
            return None
        found[u] = -rest / slopes[u]
    return {**sheet.needed(found.values()), **found}


def _telling(of: Outboard, place: int, known: set[int]) -> ValuedBalance | None:
    """Return the plainest balance that holds no reaction but one, None if there is none."""
    rows = (row for row in of if row.holds - known == {place})
    return min(rows, key=lambda row: (row.balance.point is not None, len(row.balance.bodies)),
               default=None)  # fmt: skip
