"""Balances that nothing can satisfy, whatever the unknowns are."""

from collections.abc import Sequence
from random import Random
from typing import Any

from mpmath import mp, mpf
from numpy.typing import NDArray

from derive.mechanics.balance import ValuedBalance
from derive.mechanics.balances import Balances
from derive.mechanics.choice import MOST_TOLD
from derive.mechanics.probe import DIGITS, NOTHING, PROBES, SEED

AT_ONCE = 32  # balances that are looked at together: a chance combination vanishes if each does
CLEAR = mpf(10) ** -1000  # of a row of size one: elimination of 1500 digits leaves far less


def unbalanced(
    balances: Balances, still: frozenset[int] = frozenset()
) -> tuple[ValuedBalance, ...]:
    """Return the balances that hold no unknown but ``still`` ones and yet do not vanish."""
    found = [row for row in balances.rows if row.holds <= still and _leaves_something(row)]
    return tuple(
        sorted(
            found,
            key=lambda row: (
                len(row.balance.bodies),
                len(row.holds),
                balances.carried_vectors(row.balance),
            ),
        )
    )


def _leaves_something(row: ValuedBalance) -> bool:
    return all(abs(values[0]) > NOTHING * max(map(abs, values)) for values in row.values[:PROBES])


def contradiction(balances: Balances) -> str:
    """Return a sentence on balances that nothing can satisfy, or nothing if there are none."""
    telling = balances.telling if balances.held else balances.spanning
    if not all(_contradicted(telling, point) for point in range(PROBES)):
        return ""
    if idle := idle_enforcer(balances):
        return idle
    rows = unbalanced(balances)
    if rows:
        return (f"the {rows[0].balance} does not vanish and holds no unknown: "
                "declare a load with an unknown there, or leave a motion free")  # fmt: skip
    together = _least(_contradicted(balances.rows, 0), 0)
    told = " and ".join(f"the {row.balance}" for row in together[:MOST_TOLD])
    more = f" and {len(together) - MOST_TOLD} more" if len(together) > MOST_TOLD else ""
    return (f"{told}{more} contradict each other, whatever their unknowns are: "
            "declare a load with an unknown more, or leave a motion free")  # fmt: skip


def idle_enforcer(balances: Balances) -> str:
    """Return a sentence on a load that is said to enforce a constraint and cannot, "" if none is.

    Where another load has the power for it, the equations stand; the scene does not say them.
    """
    machine, label = balances.frames.machine, balances.frames.sheet.label
    of = {u.name: u.load for u in machine.unknowns}
    powers = [row for row in balances.enforced if row.balance.kind == "virtual power"]
    working = {of.get(label(balances.unknowns[k])) for row in powers for k in row.holds}
    for one in machine.constraints:
        if one.load and one.load not in working:
            rule = "has no power on any motion that the frames allow"
            return f"load '{one.load}' cannot enforce constraint '{one.name}': it {rule}"
    return ""


def _least(rows: Sequence[ValuedBalance], point: int) -> Sequence[ValuedBalance]:
    """Return those of contradictory balances without any of which the others can be satisfied."""
    for row in rows:
        fewer = [other for other in rows if other is not row]
        if _contradicted(fewer, point):
            rows = fewer
    return rows


def _contradicted(rows: Sequence[ValuedBalance], point: int) -> list[ValuedBalance]:
    """Return the first balance that those before it leave no solution for, and those, at a point.

    Nothing comes back if all balances can be satisfied.
    """
    kept: list[tuple[int, NDArray[Any]]] = []
    before: list[ValuedBalance] = []
    random = Random(SEED)  # noqa: S311 (weights, no secret)
    with mp.workdps(DIGITS):
        scaled = [row.values[point] * (1 / max(map(abs, row.values[point]))) for row in rows]
        for first in range(0, len(rows), AT_ONCE):
            some = range(first, min(first + AT_ONCE, len(rows)))
            together = sum(random.uniform(1, 2) * scaled[n] for n in some)
            if max(map(abs, _beside(together, kept))) <= CLEAR:
                continue
            for n in some:
                left = _beside(scaled[n], kept)
                free = max(range(1, len(left)), key=lambda k: abs(left[k]), default=0)
                if free and abs(left[free]) > CLEAR:
                    kept.append((free, left / left[free]))
                    before.append(rows[n])
                elif abs(left[0]) > CLEAR:
                    return [*before, rows[n]]
    return []


def _beside(row: NDArray[Any], kept: Sequence[tuple[int, NDArray[Any]]]) -> NDArray[Any]:
    """Return what is left of a row where others, each by its pivot, are taken out of it."""
    for pivot, other in kept:
        if row[pivot]:
            row = row - other * row[pivot]
    return row
