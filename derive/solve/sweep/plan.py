"""How members of a sweep move, what is kept of each, and when: all that decides on their bits."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import ceil

from derive.scene.formula import symbols
from derive.solve.event import Event
from derive.solve.sweep.keep import COURSE, KeptColumn

ROUNDING = 1e-12
"""So that 1 s is ten steps of 0.1 s, and no short one more."""


@dataclass(frozen=True)
class SweepPlan:
    """How members move, and what is kept.

    length : s, the longest step        intervals : of a course
    answers : the function of every answer that is known along a motion
    turned : attitudes that are brought to length one at the start
    onto : functions that bring a start onto the constraints, one after the other
    """

    step: str
    length: float
    until: float
    intervals: int
    kept: tuple[KeptColumn, ...]
    stop: Event | None
    answers: Mapping[str, str]
    turned: tuple[str, ...] = ()
    onto: tuple[str, ...] = ()

    @cached_property
    def functions(self) -> tuple[str, ...]:
        """Return the functions that are called."""
        used = (*(k.component for k in self.kept), *(symbols(self.stop.left) if self.stop else ()))
        asked = (self.answers[n] for n in used if n in self.answers)
        return tuple(dict.fromkeys((*self.onto, self.step, *asked)))

    @cached_property
    def instants(self) -> tuple[float, ...]:
        """Return the instants of a course, from 0 to the end."""
        return tuple(self.until * k / self.intervals for k in range(self.intervals + 1))

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Return all instants at which something is kept, from 0 to the end."""
        own = self.instants if any(k.how == COURSE for k in self.kept) else (0.0, self.until)
        return tuple(sorted({*own, *(k.time for k in self.kept if k.how == "at")}))

    def parts(self) -> Iterator[tuple[float, int, float]]:
        """Yield of each time between marks its start, how many steps, and their length."""
        for start, end in zip(self.marks, self.marks[1:], strict=False):
            count = max(1, ceil((end - start) / self.length * (1 - ROUNDING)))
            yield start, count, (end - start) / count

    @property
    def steps(self) -> int:
        """Return how many steps a member takes that nothing ends."""
        return sum(count for _, count, _ in self.parts())
