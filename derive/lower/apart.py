"""Sets put into groups that share nothing with each other."""

from collections.abc import Hashable, Sequence
from collections.abc import Set as AbstractSet


def apart(sets: Sequence[AbstractSet[Hashable]]) -> list[tuple[int, ...]]:
    """Return the places of sets in groups: those are together that share an element with others.

    >>> apart([{1}, {2, 3}, {1, 4}, {4}])
    [(0, 2, 3), (1,)]
    """
    groups: list[tuple[set[Hashable], tuple[int, ...]]] = []
    for place, own in enumerate(sets):
        near = [group for group in groups if group[0] & own]
        groups = [group for group in groups if group not in near]
        places = sorted([place, *(k for _, each in near for k in each)])
        groups.append((set(own).union(*(held for held, _ in near)), tuple(places)))
    return sorted(places for _, places in groups)
