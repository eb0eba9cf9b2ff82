"""What must hold of a motion besides the joints that frames are made of: a formula, or points."""

from dataclasses import dataclass
from typing import Literal

from derive.scene.declaration import Axis, Triple
from derive.scene.formula import ZERO, Formula


@dataclass(frozen=True)
class Meeting:
    """A point of a frame on one body that stays at a point of another, on axes of a frame.

    equal : the places of the points, or the velocities of the bodies' particles there
    """

    on: str
    frame: str
    at: Triple
    against: str
    to_frame: str
    to: Triple
    along: str
    axes: tuple[Axis, ...]
    equal: Literal["places", "velocities"]


@dataclass(frozen=True)
class Constraint:
    """A formula that stays zero, of places or of rates, or a meeting; and what enforces it.

    load     : of the scene, that enforces it, its own name where the scene names none
    factor   : the unknown that its rate is multiplied by, "" if a load enforces it
    of_rates : whether what stays zero is of rates
    """

    name: str
    zero: Formula = ZERO
    meeting: Meeting | None = None
    load: str = ""
    factor: str = ""
    of_rates: bool = False
