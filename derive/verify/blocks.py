"""The order in which equations are solved: the smallest groups that stand on earlier ones.

Every equation is matched with one unknown that it uses; equations that need each other's unknowns
form a block. In block order each term is made of values already known, and its size can be told.
"""

from collections.abc import Sequence
from typing import TypeAlias

Group: TypeAlias = tuple[tuple[int, ...], tuple[int, ...]]


def in_order(uses: Sequence[set[int]]) -> list[Group]:
    """Return (equations, unknowns) of each block; ``uses`` are the unknowns of each equation.

    >>> in_order([{0, 1}, {0}, {1, 2, 3}, {2, 3}])
    [((1,), (0,)), ((0,), (1,)), ((2, 3), (2, 3))]
    """
    owner = _matched(uses)
    own = {row: unknown for unknown, row in owner.items()}
    reach = [_reached(row, uses, owner) for row in range(len(uses))]
    groups = {tuple(r for r in sorted(reach[row]) if row in reach[r]) for row in range(len(uses))}
    ordered = sorted(groups, key=lambda rows: (len(reach[rows[0]]), rows))
    return [(rows, tuple(sorted(own[row] for row in rows))) for rows in ordered]


def _matched(uses: Sequence[set[int]]) -> dict[int, int]:
    """Return for every unknown the equation that is to yield it."""
    owner: dict[int, int] = {}

    def placed(row: int, tried: set[int]) -> bool:
        for unknown in sorted(uses[row] - tried):
            tried.add(unknown)
            if unknown not in owner or placed(owner[unknown], tried):
                owner[unknown] = row
                return True
        return False

    for row in range(len(uses)):
        if not placed(row, set()):
            raise ArithmeticError(f"equation {row} fixes no unknown that others leave open")
    return owner


def _reached(start: int, uses: Sequence[set[int]], owner: dict[int, int]) -> set[int]:
    """Return the equations that must be solved with or before ``start``."""
    reached, waiting = {start}, [start]
    while waiting:
        for unknown in uses[waiting.pop()]:
            row = owner[unknown]
            if row not in reached:
                reached.add(row)
                waiting.append(row)
    return reached
