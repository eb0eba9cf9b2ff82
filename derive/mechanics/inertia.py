"""What is said of unknowns that no balance holds: of a motion, that its inertia is 0."""

from collections.abc import Iterable, Sequence

from mpmath import mp
from sympy import Expr, Symbol

from derive.mechanics.balances import Balances
from derive.mechanics.box import ranges
from derive.mechanics.probe import DIGITS
from derive.mechanics.sweep import LEAST, Weakest, probe_at
from derive.mechanics.valued import Valued
from derive.scene import Scene, SceneError

NONE = "0, or nothing beside what else the balances hold"


def require_held(balances: Balances, unknowns: Iterable[Symbol]) -> None:
    """Refuse an unknown that no balance holds; of an acceleration it is said why."""
    held = {balances.unknowns[k] for row in balances.telling for k in row.holds}
    for name in sorted(balances.frames.sheet.label(u) for u in unknowns if u not in held):
        motion = _motion(balances.frames.machine, name)
        why = f": the inertia of all that moves with '{motion}' is {NONE}" if motion else ""
        raise SceneError(f"no balance holds '{name}', so it cannot be found{why}")


def require_told(balances: Balances, unknowns: Iterable[Symbol]) -> None:
    """Refuse an unknown that enforces what other constraints enforce, too."""
    told, label = balances.sides.held.told, balances.frames.sheet.label
    for name, condition in sorted((label(u), told[u]) for u in unknowns if u in told):
        rule = "says nothing that the others do not, so any value will do"
        raise SceneError(f"'{name}' cannot be told: constraint '{condition}' {rule}")


def _motion(machine: Scene, name: str) -> str:
    """Return what is free and has this highest rate, "" if nothing has."""
    return next((m.name for m in machine.moving if m.free and m.unknown == name), "")


def vanishing(
    balances: Balances, unknowns: Sequence[Symbol], entries: list[list[Expr]], worst: Weakest
) -> str:
    """Return words on an unknown that no balance holds at a place, "" if each is held.

    entries : what the balances that were chosen multiply the unknowns by, a row a balance
    """
    words, sheet = balances.frames.words, balances.frames.sheet
    valued = Valued(balances.sides, probe_at(words, worst.place, sheet.definitions))
    for column, u in enumerate(unknowns):
        if u in balances.unknowns and not _held(balances, valued, balances.unknowns.index(u)):
            motion = _motion(balances.frames.machine, sheet.label(u))
            of = [row[column] for row in entries]
            held = {s for e in (*of, *sheet.needed(of).values()) for s in e.free_symbols}
            each = ranges(words)
            names = [n for s, n in zip(each.symbols, each.names, strict=True) if s in held]
            there = Weakest(worst.least, {n: worst.place[n] for n in names})
            if motion:
                return f"the inertia of all that moves with '{motion}' vanishes {there.where}"
            return f"no balance holds '{sheet.label(u)}' {there.where}, so it cannot be found there"
    return ""


def _held(balances: Balances, valued: Valued, k: int) -> bool:
    """Tell whether some balance holds an unknown at a place as it does at a trial point."""
    with mp.workdps(DIGITS):
        pairs = (
            (balances.at(row, valued)[1 + k], row.values[0][1 + k])
            for row in balances.rows
            if k in row.holds
        )
        return any(abs(there) > LEAST * abs(usual) for there, usual in pairs)
