"""What a machine says that cannot be meant, and what is hardly meant: sizes, ranges, frames."""

from __future__ import annotations

from typing import TYPE_CHECKING

from derive.escape import at_place, brief
from derive.scene.declaration import SceneError
from derive.scene.machine import INERTIAL, Force, Spring
from derive.scene.safe import negative, ranges_of, values_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from derive.formula import Formula
    from derive.scene.declaration import Coordinate
    from derive.scene.machine import Machine, Moving

MANY_RADIANS = 20
"""More than three turns: an angle in degrees that was not converted looks so."""


def require_sizes(machine: Machine) -> None:
    """Refuse sizes that no body and no spring can have, anywhere on the declared ranges."""
    ranges = ranges_of(machine)
    for label, size in _sizes(machine):
        place = negative(size, ranges)
        if place is not None:
            found = f"'{brief(size)}' is{at_place(place)}"
            raise SceneError(f"{label} must not be negative, but {found}")


def beyond(machine: Machine) -> Iterator[str]:
    """Yield a sentence for every part of a state of small motion that is outside its range."""
    if not any("linearised" in answers for answers in machine.asked.values()):
        return
    ranges = ranges_of(machine)
    for m in (*machine.coordinates, *machine.speeds):
        if m.name in machine.about:
            found = values_of(machine.about[m.name], ranges)
            if found and not any(float(m.low) <= x <= float(m.high) for x in found):
                declared = f"[{float(m.low):g}, {float(m.high):g}]"
                yield (
                    f"linearised.{m.name} is {found[0]:.6g}, outside the range of '{m.name}', "
                    f"{declared}"
                )


def _sizes(machine: Machine) -> Iterator[tuple[str, Formula]]:
    """Yield every size that must not be negative, with what it is called."""
    for body in machine.bodies:
        lengths = body.lengths
        for name, length in lengths.items():
            yield f"body '{body.name}': {name.replace('_', ' ')}", length
        if body.look == "tube":
            yield f"body '{body.name}': outer - inner", lengths["outer"] - lengths["inner"]
    for load in machine.loads:
        if isinstance(load, Spring):
            yield f"load '{load.name}': spring", load.stiffness
            yield f"load '{load.name}': damper", load.damping
            yield f"load '{load.name}': length", load.length


def idle_frames(machine: Machine) -> Iterator[str]:
    """Yield a sentence for every frame that carries nothing and that nothing refers to."""
    used = {INERTIAL, machine.momentum.frame, *(f.parent for f in machine.frames)}
    used |= {body.frame for body in machine.bodies}
    for load in machine.loads:
        if isinstance(load, Spring):
            used |= {load.frame, load.to_frame}
        else:
            used |= {load.along} | ({load.frame} if isinstance(load, Force) else set())
    for frame in machine.frames:
        if frame.name not in used:
            yield f"frame '{frame.name}' carries nothing"


def in_degrees(coordinates: Iterable[Coordinate | Moving]) -> Iterator[str]:
    """Yield a sentence for every angle whose range looks as if it were in degrees."""
    for c in coordinates:
        end = max(c.low, c.high, key=abs)
        if c.unit == "rad" and abs(end) >= MANY_RADIANS:
            yield f"the range of '{c.name}' goes to {float(end):g} rad; are degrees meant?"
