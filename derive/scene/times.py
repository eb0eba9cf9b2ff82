"""The times of a scene, table ``motion``: the length of a step, and how long a flow goes on."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from derive.scene.declaration import Given
from derive.scene.table import Table, interval, keys, table
from derive.scene.wanted import moves

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

TIMES = {
    "time_step": (Fraction(0), Fraction(1, 100)),
    "time": (Fraction(0), Fraction(10)),
}
"""Ranges in s where the scene gives none: of a step, and of the time that a flow goes on for."""


def read_time(given: Table, name: str) -> Given:
    """Return the range of a time in s; below zero it is motion backwards."""
    if name not in given.entries:
        return Given(*TIMES[name], None)
    inner = table(given.entries[name], f"motion.{name}")
    keys(inner, ("range",), ())
    return Given(*interval(inner.entries["range"], f"motion.{name}.range"), None)


def idle_times(motion: Iterable[str], wanted: Iterable[str]) -> Iterator[str]:
    """Yield a sentence for each time of a scene's table ``motion`` that nothing wanted takes."""
    moving = [name for name in wanted if moves(name)]
    flows = [name for name in moving if name.startswith("flow_")]
    takers = {"time": flows, "time_step": [name for name in moving if name not in flows]}
    for time in motion:
        if not takers[time]:
            yield f"motion.{time} is given, but nothing that is wanted takes it"
