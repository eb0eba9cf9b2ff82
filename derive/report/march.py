"""States taken through time by a step of a scene: many at once, in so many steps of one length."""

from dataclasses import dataclass

import numpy as np

from derive.library.library import Library
from derive.motion.runge_kutta.system import FLOW
from derive.program.program import Program
from derive.report.driver import Driver, Storage
from derive.report.states import Begun, as_storage
from derive.verify.operators import Column


@dataclass(frozen=True)
class March:
    """States on their way: rows of the step's arguments, and the step that moves them on."""

    driver: Driver
    program: Program
    at: Storage
    into: Storage

    def on(self, count: int) -> None:
        """Take ``count`` steps."""
        self.driver.call(self.program, self.at, self.into, count)

    def state(self) -> Column:
        """Return the state: (components, states), in double."""
        states = self.driver.library.vocabulary.states
        held = self.into if self.program.name == FLOW else self.at
        names = [f"{q.name}_next" if self.program.name == FLOW else q.name for q in states]
        with np.errstate(all="ignore"):
            return np.concatenate([held[name].T for name in names]).astype(np.float64)


def march(driver: Driver, name: str, start: Begun, length: float) -> March:
    """Return states at their beginning, to be moved by steps of ``length`` s."""
    library, dtype = driver.library, driver.precision.dtype
    program = library[name]
    at = driver.with_constants(as_storage(start, library.vocabulary.given(), driver.precision))
    at |= {time: np.full((1, 1), length, dtype) for time in ("time_step", "time")}
    plan = plan_of(library, name)
    if plan is not None:
        made = driver.room(plan, len(start))
        driver.call(plan, at, made)
        at |= made
    for q in program.inputs:
        if q.role == "remainder":
            at[q.name] = np.zeros((len(start), len(q.components)), dtype)
    return March(driver, program, at, driver.over(program, at) if name != FLOW
                 else driver.room(program, len(start)))  # fmt: skip


def plan_of(library: Library, name: str) -> Program | None:
    """Return the function that plans a step, None if it needs no plan."""
    wanted = f"plan_{name.removeprefix('step_')}"
    return next((p for p in library.motions if p.name == wanted), None)


def ended(driver: Driver, name: str, start: Begun, time: float, count: int) -> Column:
    """Return where states end after ``time``, in ``count`` steps: (components, states)."""
    states = march(driver, name, start, time / count)
    states.on(count)
    return states.state()
