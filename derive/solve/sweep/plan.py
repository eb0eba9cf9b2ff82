"""How members of a sweep move, what is kept of each, and when: all that decides on their bits.

All steps are as long as each other, whatever is kept: where an instant lies within a step, a part
of that step is taken aside.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import floor

from derive.scene.formula import symbols
from derive.solve.event import Event
from derive.solve.simulation import ROUNDING, steps_until
from derive.solve.sweep.keep import COURSE, EXTREMES, KeptColumn


@dataclass(frozen=True)
class SweepPlan:
    """How members move, and what is kept.

    length : s, the longest step        intervals : of a course
    answers : the function of every answer that is known along a motion
    turned : attitudes that are brought to length one at the start
    onto : functions that bring a start onto the constraints, one after the other
    near : parts of its declared range by which a component is moved at most, so that they hold
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
    near: float = 0.0

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
    def marks(self) -> Mapping[int, tuple[tuple[float, float], ...]]:
        """Return the instants at which something is kept, by the step that they lie in or end.

        Of each stands the instant, and how long a part of the step is until then, 0 if it ends it;
        the start is that of a step 0 that nobody takes.
        """
        courses = self.instants if any(k.how == COURSE for k in self.kept) else ()
        found = defaultdict[int, list[tuple[float, float]]](list)
        for time in sorted({*courses, *(k.time for k in self.kept if k.how == "at")}):
            place = time / self.until * self.steps
            whole = round(place)
            if abs(place - whole) <= ROUNDING * self.steps:
                found[whole].append((time, 0.0))
            else:
                found[floor(place) + 1].append((time, time - floor(place) * self.seconds))
        return {number: tuple(each) for number, each in found.items()}

    @property
    def looked(self) -> Sequence[int]:
        """Return the steps after which members are looked at, the last among them."""
        if self.stop or any(k.how in EXTREMES for k in self.kept):
            return range(1, self.steps + 1)
        return sorted({*self.marks, self.steps} - {0})

    @cached_property
    def steps(self) -> int:
        """Return how many steps a member takes that nothing ends."""
        return steps_until(self.until, self.length)

    @property
    def seconds(self) -> float:
        """Return how long each step is."""
        return self.until / self.steps
