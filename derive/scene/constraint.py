"""What must hold of a motion besides the joints that frames are made of: a formula, or points."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from derive.scene.declaration import AXES, Axis, Triple
from derive.scene.formula import ZERO, Formula, number


@dataclass(frozen=True)
class Meeting:
    """A point of a frame on one body that stays at a point of another, on axes of a frame.

    axes  : what the parts are called          directions : and where these point, along ``along``
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
    directions: tuple[Triple, ...]
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


def unit_along(axis: Axis) -> Triple:
    """Return the unit vector along an axis."""
    x, y, z = (number(Fraction(a == axis)) for a in AXES)
    return x, y, z


def distances(constraints: Iterable[Constraint]) -> Iterator[tuple[str, str]]:
    """Yield what is 0 while constraints hold, each with its words: of places, and of rates.

    >>> [name for name, _ in distances([Constraint("loop"), Constraint("blade", of_rates=True)])]
    ['distance_loop', 'distance_loop_dot', 'distance_blade_dot']
    """
    for one in constraints:
        for axis in one.meeting.axes if one.meeting else ("",):
            name, along = (f"distance_{one.name}_{axis}", f" along {axis}") if axis else (
                f"distance_{one.name}", "")  # fmt: skip
            if not one.of_rates:
                yield name, f"constraint {one.name}{along}"
            yield f"{name}_dot", f"the rate of constraint {one.name}{along}"
