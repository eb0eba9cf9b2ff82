"""Where components of members stand in arrays, and lines of C within braces."""

from collections.abc import Sequence


def behind_first(place: int) -> str:
    """Return what is added to an array's address for one of its components."""
    return "" if place == 0 else " + stride" if place == 1 else f" + {place} * stride"


def at_member(place: int) -> str:
    """Return the index of a component of member k."""
    return "k_" if place == 0 else f"k_{behind_first(place)}"


def within_braces(lines: Sequence[str]) -> list[str]:
    """Return lines within braces."""
    return [f"    {line}" for line in lines]


def braced(head: str, lines: Sequence[str]) -> str:
    """Return a function by its declaration and its lines."""
    return "\n".join([head, "{", *within_braces(lines), "}"])
