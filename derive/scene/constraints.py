"""The table of constraints: formulas that stay zero, points that meet, and what enforces them."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from derive.scene.constraint import Constraint, Meeting, unit_along
from derive.scene.declaration import AXES, Input, Moving, SceneError
from derive.scene.entries import CONSTRAINT
from derive.scene.entry import Reading, entries_of
from derive.scene.escape import brief
from derive.scene.formula import ZERO, symbol, symbols
from derive.scene.machine import INERTIAL, Force, Frame, Load, Member, Scene, Unknown
from derive.scene.names import identifier
from derive.scene.scalars import Scalars
from derive.scene.scope import measured
from derive.scene.table import Table, one_of, shown, table
from derive.scene.unit import NONE, dimension, spelled, unit_ratio

Loaded = tuple[tuple[Load, ...], tuple[Unknown, ...]]
Enforced = tuple[tuple[Constraint, ...], tuple[Load, ...], tuple[Unknown, ...]]
OF_POINTS = ("on", "frame", "at", "against", "to_frame", "to", "along", "axes", "equal")


def read_constraints(
    given: Table, scalars: Scalars, frames: tuple[Frame, ...], bodies: tuple[Member, ...],
    acting: Loaded,
) -> Enforced:  # fmt: skip
    """Return the constraints, and loads and unknowns with those that enforce them."""
    names = {"frame": tuple(f.name for f in frames), "body": tuple(b.name for b in bodies)}
    by, carriers = Reading(scalars.scopes, names), {b.name: b.frame for b in bodies}
    found, (loads, unknowns) = list[Constraint](), acting
    for key, value in given.entries.items():
        name = identifier(key, "a constraint")
        one = table(value, f"constraint '{name}'")
        said = entries_of(one, CONSTRAINT, by)
        if any(load.name == name for load in loads) and said["load"] is None:
            rule = f"is called as a load is; say load = '{name}' if that enforces it"
            raise SceneError(f"{one.label} {rule}")
        load = said["load"] or name
        if said["load"] is not None:
            one_of(load, one.of("load"), tuple(own.name for own in loads))
            if all(u.load != load for u in unknowns):
                raise SceneError(f"{one.of('load')}: load '{load}' has no unknown, as '?N'")
        if said["zero"] is not None:
            made = _formula(one, said, name, scalars)
            ours: tuple[Unknown, ...] = () if said["load"] else (made[1],)
            factor = "" if said["load"] else name
            found.append(Constraint(name, made[0], None, load, factor, made[2]))
        else:
            meeting = _meeting(one, said, carriers)
            pair = () if said["load"] else _enforcing(name, meeting)
            loads, ours = (*loads, *(p for p, _ in pair)), tuple(u for _, us in pair for u in us)
            of_rates = meeting.equal == "velocities"
            found.append(Constraint(name, ZERO, meeting, load, "", of_rates))
        unknowns = (*unknowns, *ours)
    return tuple(found), loads, unknowns


def _formula(one: Table, said: Mapping[str, Any], name: str, scalars: Scalars) -> Any:
    """Return what stays zero, the unknown that enforces it, and whether it is of rates."""
    if extra := [key for key in OF_POINTS if key in one.entries]:
        raise SceneError(f"{one.label} is a formula by zero, so it has no '{extra[0]}'")
    read, unit = measured(said["zero"], one.of("zero"), scalars.motions)
    rates = {c.rate.name for c in scalars.coordinates if isinstance(c.rate, Input)}
    moving = rates | {s.name for s in scalars.speeds}
    places = {c.name for c in scalars.coordinates}
    used = set(symbols(read))
    if not used & (moving | places):
        raise SceneError(f"{one.of('zero')} = '{brief(read)}' holds nothing that moves")
    of_rates = bool(used & moving)
    power = dimension("W" if of_rates else "J")
    return read, Unknown(name, spelled(unit_ratio(power, unit or NONE)), name), of_rates


def _meeting(one: Table, said: Mapping[str, Any], carriers: Mapping[str, str]) -> Meeting:
    if said["on"] is None:
        rule = "needs zero = 'formula', or on, a body, whose point meets another"
        raise SceneError(f"{one.label} {rule}")
    if said["on"] == said["against"]:
        raise SceneError(f"{one.label} holds '{said['on']}' against itself")
    against = said["against"] or ""
    frame = said["frame"] or carriers[said["on"]]
    other = said["to_frame"] or (carriers[against] if against else INERTIAL)
    axes = _axes(one, said["axes"])
    directions = tuple(map(unit_along, axes))
    return Meeting(said["on"], frame, said["at"], against, other, said["to"], said["along"],
                   axes, directions, said["equal"])  # fmt: skip


def _axes(one: Table, value: object) -> Any:
    if value is None:
        return AXES
    known = isinstance(value, list) and value and all(axis in AXES for axis in value)
    if not known or len({*value}) < len(value):  # type: ignore[misc, arg-type]
        rule = "must be a list of different ones of x, y and z"
        raise SceneError(f"{one.of('axes')} {rule}, not {shown(value)}")
    return tuple(axis for axis in AXES if axis in value)  # type: ignore[operator]


def with_dependent(given: Table, scalars: Scalars) -> Scalars:
    """Return the scalars, those marked that constraints name as dependent."""
    said = [(name, table(value, f"constraint '{name}'")) for name, value in given.entries.items()]
    named = [who for _, one in said for who in _dependent(one, scalars)]
    if twice := [who for who in dict.fromkeys(named) if named.count(who) > 1]:
        raise SceneError(f"'{twice[0]}' is dependent by two constraints; it follows by one")

    def marked(each: tuple[Moving, ...]) -> tuple[Moving, ...]:
        return tuple(replace(m, dependent=m.name in named) for m in each)

    return replace(scalars, coordinates=marked(scalars.coordinates), speeds=marked(scalars.speeds))


def _dependent(one: Table, scalars: Scalars) -> tuple[str, ...]:
    value = one.entries.get("dependent", ())
    if value == ():
        return ()
    free = tuple(m.name for m in (*scalars.coordinates, *scalars.speeds) if m.free)
    if not isinstance(value, list) or not value:
        rule = "must be a list of free coordinates or speeds such as ['q']"
        raise SceneError(f"{one.of('dependent')} {rule}, not {shown(value)}")
    return tuple(one_of(name, one.of("dependent"), free) for name in value)


def _enforcing(name: str, meeting: Meeting) -> tuple[tuple[Force, tuple[Unknown, ...]]]:
    """Return the pair of forces at the meeting points, and its unknowns."""
    zeros = (ZERO, ZERO, ZERO)
    parts = {axis: f"{name}_{axis}" for axis in meeting.axes}
    x, y, z = (symbol(parts[axis]) if axis in parts else ZERO for axis in AXES)
    load = Force(name, meeting.on, meeting.against, meeting.frame, meeting.at, meeting.along,
                 (x, y, z), zeros, (meeting.to_frame, meeting.to))  # fmt: skip
    each = (identifier(part, f"the force of constraint '{name}'") for part in parts.values())
    return ((load, tuple(Unknown(part, "N", name) for part in each)),)


def body_turning_with(machine: Scene, frame: str) -> str:
    """Return the body that the axes of a frame turn with, "" if it is none, or the inertial one."""
    root = _root(machine, frame)
    if root == INERTIAL:
        return INERTIAL
    own = [b for b in machine.bodies if _root(machine, b.frame) == root]
    spins = {b.name for b in own if b.spin or b.axial_speed or b.angular_velocity}
    return next((b.name for b in own if b.name not in spins), "")


def _root(machine: Scene, name: str) -> str:
    """Return the first frame on the way to the inertial one that turns in its parent."""
    each = {f.name: f for f in machine.frames}
    moving = {m.name for m in (*machine.coordinates, *machine.speeds, *machine.inputs)}
    while name != INERTIAL:
        frame = each[name]
        angles = {s for turn in frame.turned for s in symbols(turn.angle)}
        if angles & moving or frame.angular_velocity is not None:
            break
        name = frame.parent
    return name
