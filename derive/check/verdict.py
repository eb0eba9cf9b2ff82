"""What a check found: one row, with the evidence in its sentence."""

from dataclasses import dataclass
from typing import Literal

Outcome = Literal["holds", "FAILS", "skipped"]


@dataclass(frozen=True)
class Verdict:
    """The outcome of one check of one function, and the figure or the reason."""

    scene: str
    function: str
    precision: str
    check: str
    outcome: Outcome
    says: str


JUDGED: dict[bool, Outcome] = {True: "holds", False: "FAILS"}
