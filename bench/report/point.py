"""One motion that was run: by whom, with which step or tolerance, what it cost, how it ended."""

from dataclasses import dataclass

from bench.motion.wrong import Wrong


@dataclass(frozen=True)
class Point:
    """A point of the work-precision plots.

    method : function of ours, or a peer's name     scene : ours only, else ""
    setting : "step" (s), "tolerance", or "" where there is none; ``value`` is its number
    radians : mean angle of a pass, |omega| at the start times duration over passes
    instructions : of the whole motion, None if they were not counted
    """

    method: str
    scene: str
    precision: str
    setting: str
    value: float
    passes: int
    radians: float
    instructions: float | None
    seconds: float
    wrong: Wrong

    @property
    def ours(self) -> bool:
        """Tell whether an emitted function made the motion."""
        return self.scene != ""


@dataclass(frozen=True)
class NotRun:
    """A method that was not run, and why."""

    method: str
    precision: str
    reason: str


@dataclass(frozen=True)
class Limits:
    """How much a run may take.

    finest : radians of a step, none finer      longest : s of one motion
    ratio  : from one step to the next finer    rounds : times a quick motion is run
    """

    finest: float
    longest: float
    ratio: float
    rounds: int


SMALL = Limits(finest=2.0**-8, longest=0.05, ratio=2.0, rounds=2)
FULL = Limits(finest=2.0**-13, longest=20.0, ratio=2.0**0.5, rounds=5)
