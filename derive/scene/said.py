"""What a scene is made of, in sentences: its frames, its bodies, what acts on them."""

from collections.abc import Iterable, Sequence

from derive.scene.constraint import Constraint
from derive.scene.declaration import Turning
from derive.scene.formula import ZERO, Formula, substitute, symbols
from derive.scene.machine import (
    INERTIAL,
    Force,
    Frame,
    Gradient,
    Load,
    Member,
    Scene,
    Spring,
    Weight,
)


def said(machine: Scene) -> tuple[str, ...]:
    """Return what a scene is made of, one sentence each."""
    found = [_frame(f) for f in machine.frames if f.name != INERTIAL]
    found += [_body(b) for b in machine.bodies]
    found += [_load(load) for load in machine.loads if not is_hidden(load.name)]
    found += [_constraint(one) for one in machine.constraints]
    welds = [f for f in machine.loads if isinstance(f, Force) and is_hidden(f.name)]
    found += [f"Body {f.on} is fixed to {f.against}, both in {f.frame}." for f in welds]
    return (*found, *([f"Source: {machine.source}."] if machine.source else []))


def potential_said(machine: Scene) -> str:
    """Return how the potential energy is counted, and where it is zero; "" if there is none."""
    weight = (
        "-m g . r_G of each weight, r_G from the inertial origin to the mass centre (from that of "
        "a frame which carries it, where of this only the motion is given)"
    )
    spring = "k (d - d_0)^2/2 of each spring, d the distance of its ends and d_0 that at rest"
    kinds = ((Weight, weight), (Spring, spring))
    parts = [says for kind, says in kinds if any(isinstance(load, kind) for load in machine.loads)]
    return f"The potential energy is the sum of {', and of '.join(parts)}." if parts else ""


def is_hidden(name: str) -> bool:
    """Tell whether a name is of a load that the scene does not speak of, as of what holds a body.

    Such a name says so in words, which no scene can write: "bearing of wheel 1, x".
    """
    return not name.isidentifier()


def without_hidden(formulas: Iterable[Formula]) -> tuple[Formula, ...]:
    """Return the components of a load without what the scene does not speak of."""
    each = tuple(formulas)
    hidden = {name: ZERO for f in each for name in symbols(f) if is_hidden(name)}
    return tuple(substitute(f, hidden) for f in each)


def _column(formulas: Sequence[Formula]) -> str:
    return f"({', '.join(map(str, formulas))})"


def _turns(turns: Sequence[Turning]) -> str:
    return ", then ".join(f"about {t.axis} by {t.angle}" for t in turns)


def _frame(frame: Frame) -> str:
    start = f"Frame {frame.name} is carried by {frame.parent}"
    if frame.angular_velocity is not None:
        start += f" and turns in it with {_column(frame.angular_velocity)} along its own axes"
    if frame.attitude:
        start += ", its attitude a unit quaternion, scalar first"
    if frame.turned:
        start += f" and turned from it {_turns(frame.turned)}"
    if any(f != ZERO for f in frame.origin):
        start += f"; its origin lies at {_column(frame.origin)}"
    if frame.rolls is not None:
        start += (
            f"; it moves so that {frame.rolls.body} rolls on its point {_column(frame.rolls.at)}"
        )
    for name, value in (("velocity", frame.velocity), ("acceleration", frame.acceleration)):
        if value is not None and not any(f != ZERO for f in value):
            rests = name == "velocity" and frame.acceleration is None
            start += "; its origin is taken to be at rest" if rests else ""
        elif value is not None:
            start += f"; its origin has the {name} {_column(value)}"
    return start + "."


def _body(body: Member) -> str:
    says = f"Body {body.name}{f', a {body.look},' if body.look else ''} is carried by {body.frame}"
    says += "" if body.look else _inertia(body)
    if body.turned:
        says += f", turned from it {_turns(body.turned)}"
    if any(f != ZERO for f in body.centre):
        says += f", its mass centre at {_column(body.centre)}"
    if body.spin is not None:
        says += f", and spins about its {body.axis} axis at {body.spin} relative to it"
    if body.axial_speed is not None:
        says += f", and has the angular velocity {body.axial_speed} along its {body.axis} axis"
    if body.angular_velocity is not None:
        says += f", and turns relative to it with {_column(body.angular_velocity)}"
    return says + "."


def _inertia(body: Member) -> str:
    """Return what is known of the moments of inertia of a body without a shape."""
    if None in body.inertia:
        return ""
    if any(f != ZERO for f in body.inertia[3:]):
        return ", with a full inertia tensor"
    x, y, z = body.inertia[:3]
    if x == y == z:
        return ", with three equal moments of inertia"
    axis = "z" if x == y else "y" if x == z else "x" if y == z else ""
    if not axis:
        return ", its principal axes those of the frame"
    thin = body.inertia["xyz".index(axis)] == ZERO
    return f", a thin rod along its {axis} axis" if thin else f", symmetrical about its {axis} axis"


def _load(load: Load) -> str:
    if isinstance(load, Force):
        return f"Load {load.name}: {_force(load)}."
    if isinstance(load, Spring):
        return f"Load {load.name}: {_spring(load)}."
    if isinstance(load, Gradient):
        towards = f"towards {_column(load.towards)} along {load.along}"
        on = ", ".join(load.on)
        return f"Load {load.name}: the gravity gradient {load.strength} {towards}, on {on}."
    where = f"along {load.along}, on {', '.join(load.on)}"
    return f"Load {load.name}: gravity {_column(load.gravity)} {where}."


def _constraint(one: Constraint) -> str:
    """Return what a constraint asks for, and what enforces it."""
    by = f"the generalized force {one.factor}" if one.factor else f"the load {one.load}"
    if one.meeting is None:
        return f"Constraint {one.name}: {one.zero} stays 0, enforced by {by}."
    own = one.meeting
    what = "stays at" if own.equal == "places" else f"of {own.on} has the velocity of"
    there = f"{_column(own.to)} of {own.to_frame}"
    there += f" on {own.against}" if own.against else ""
    axes = ", ".join(own.axes)
    here = f"the point {_column(own.at)} of {own.frame}"
    return f"Constraint {one.name}: {here} {what} {there}, on {axes} of {own.along}, by {by}."


def _spring(load: Spring) -> str:
    """Return how stiff a spring is, how long at rest, and between which points."""
    parts = [f"a spring of stiffness {load.stiffness}"] if load.stiffness != ZERO else []
    parts += [f"length {load.length} at rest"] if parts and load.length != ZERO else []
    parts += [f"a damper {load.damping}"] if load.damping != ZERO else []
    ends = f"from {_column(load.at)} of {load.frame} to {_column(load.to)} of {load.to_frame}"
    return f"{' and '.join(parts)}, {ends}, on {load.on}{_against(load)}"


def _against(load: Spring | Force) -> str:
    return f", and the opposite on {load.against}" if load.against else ""


def _force(load: Force) -> str:
    """Return what a load is; what the scene does not speak of is only said to be there."""
    values = (("force", load.force), ("couple", load.couple))
    parts = [f"the {kind} {_column(without_hidden(value))}" for kind, value in values
             if any(f != ZERO for f in without_hidden(value))]  # fmt: skip
    if parts:
        parts[-1] += f" along {load.along} at {_column(load.at)} of {load.frame}"
    if any(without_hidden(value) != tuple(value) for _, value in values):
        parts.append("what else acts there and is not asked about")
    return f"{' and '.join(parts)}, on {load.on}{_against(load)}"
