"""What a machine says that cannot be meant, and what is hardly meant: sizes, ranges, frames."""

from collections.abc import Iterable, Iterator
from fractions import Fraction

from derive.scene.declaration import Moving, Parameter, SceneError
from derive.scene.escape import at_place, brief
from derive.scene.formula import Formula
from derive.scene.machine import INERTIAL, Force, Member, Scene, Spring
from derive.scene.safe import negative_somewhere, ranges_of, values_within

MANY_RADIANS = 20
"""More than three turns: an angle in degrees that was not converted looks so."""


def require_sizes(machine: Scene) -> None:
    """Refuse sizes that no body and no spring can have, anywhere on the declared ranges."""
    ranges = ranges_of(machine)
    for label, size in _sizes(machine):
        place = negative_somewhere(size, ranges)
        if place is not None:
            found = f"'{brief(size)}' is{at_place(place)}"
            raise SceneError(f"{label} must not be negative, but {found}")
    for body in machine.bodies:
        walls = values_within(_wall(body), ranges) if body.look == "tube" else []
        if walls and not any(walls):
            raise SceneError(f"body '{body.name}': outer must be more than inner, but is the same")


def doubts(machine: Scene) -> Iterator[str]:
    """Yield a sentence for everything in a machine that is hardly meant."""
    yield from _beyond(machine)
    yield from _idle_frames(machine)
    yield from in_degrees((*machine.coordinates, *machine.inputs, *machine.parameters))
    yield from _turns_in_degrees(machine)


def _beyond(machine: Scene) -> Iterator[str]:
    """Yield a sentence for every part of a state of small motion that is outside its range."""
    if not any("linearised" in answers for answers in machine.asked.values()):
        return
    ranges = ranges_of(machine)
    for m in (*machine.coordinates, *machine.speeds):
        if m.name in machine.about:
            found = values_within(machine.about[m.name], ranges)
            if found and not any(float(m.low) <= x <= float(m.high) for x in found):
                declared = f"[{float(m.low):g}, {float(m.high):g}]"
                yield (
                    f"linearised.{m.name} is {float(found[0]):.6g}, outside the range of "
                    f"'{m.name}', {declared}"
                )


def _sizes(machine: Scene) -> Iterator[tuple[str, Formula]]:
    """Yield every size that must not be negative, with what it is called."""
    for body in machine.bodies:
        lengths = body.lengths
        for name, length in lengths.items():
            yield f"body '{body.name}': {name.replace('_', ' ')}", length
        if body.look == "tube":
            yield f"body '{body.name}': outer - inner", _wall(body)
    for load in machine.loads:
        if isinstance(load, Spring):
            yield f"load '{load.name}': spring", load.stiffness
            yield f"load '{load.name}': damper", load.damping
            yield f"load '{load.name}': length", load.length


def _wall(tube: Member) -> Formula:
    """Return how thick the wall of a tube is."""
    return tube.lengths["outer"] - tube.lengths["inner"]


def _idle_frames(machine: Scene) -> Iterator[str]:
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


def in_degrees(scalars: Iterable[Moving | Parameter]) -> Iterator[str]:
    """Yield a sentence for every angle whose range or value looks as if it were in degrees."""
    for c in scalars:
        end = max(c.low, c.high, key=abs)
        if c.unit == "rad" and abs(end) >= MANY_RADIANS:
            says = f"'{c.name}' is" if c.low == c.high else f"the range of '{c.name}' goes to"
            yield f"{says} {float(end):g} rad; are degrees meant?"


def _turns_in_degrees(machine: Scene) -> Iterator[str]:
    """Yield a sentence for every turn by a formula that holds a number as of degrees."""
    turned = [(f"frame '{f.name}'", f.turned) for f in machine.frames]
    turned += [(f"body '{b.name}'", b.turned) for b in machine.bodies]
    for label, turns in turned:
        for turn in turns:
            alone = [n for n in _terms(turn.angle) if abs(n) >= MANY_RADIANS]
            if alone:
                says = f"turns about {turn.axis} through '{brief(turn.angle)}'"
                yield f"{label} {says}, and {float(alone[0]):g} is in rad; are degrees meant?"


def _terms(angle: Formula) -> Iterator[Fraction]:
    """Yield the numbers that are terms of a sum."""
    if angle.operator == "number":
        yield angle.number
    elif angle.operator in ("add", "sub", "neg"):
        for part in angle.operands:
            yield from _terms(part)
