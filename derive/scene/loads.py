"""The loads of a machine: forces and couples with unknowns, weights, springs, gravity gradients."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from derive.scene.declaration import SceneError, Triple
from derive.scene.formula import ZERO, Formula
from derive.scene.machine import (
    INERTIAL,
    Force,
    Frame,
    Gradient,
    Load,
    Member,
    Spring,
    Unknown,
    Weight,
)
from derive.scene.names import identifier, label
from derive.scene.numbers import check_unit
from derive.scene.scalars import Scalars
from derive.scene.table import Scope, Table, formula, keys, several, shown, table, triple, word
from derive.scene.unit import ACCELERATION, FORCE, LENGTH, MOMENT, NONE, Dimension, dimension

MARK = re.compile(r"\?([A-Za-z][A-Za-z0-9_]*)")
STIFFNESS, DAMPING, RATE_SQUARED = dimension("N/m"), dimension("N s/m"), dimension("1/s^2")
AXES = ("x", "y", "z")
MAIN = ("force", "couple", "gravity", "spring", "damper", "gravity_gradient")


@dataclass
class _Reader:
    """What loads are read with: scope, frames, bodies, and the unknowns found so far."""

    scalars: Scalars
    frames: tuple[Frame, ...]
    bodies: tuple[Member, ...]
    found: dict[str, Unknown] = field(default_factory=dict)
    units: dict[str, Dimension] = field(default_factory=dict)

    def frame(self, given: Table, key: str, default: str) -> str:
        """Return the frame that an entry names."""
        value = given.entries.get(key, default)
        return word(value, f"{given.label}.{key}", [f.name for f in self.frames])

    def body(self, given: Table, key: str) -> str:
        """Return the body that an entry names."""
        return word(given.entries[key], f"{given.label}.{key}", [b.name for b in self.bodies])

    def several(self, given: Table) -> tuple[str, ...]:
        """Return the bodies of an entry ``on``, all of them by default."""
        value = given.entries.get("on", [b.name for b in self.bodies])
        return several(value, f"{given.label}.on", [b.name for b in self.bodies])

    def place(self, given: Table, key: str) -> Triple:
        """Return a point, the origin of its frame by default."""
        value = given.entries.get(key, [0, 0, 0])
        return triple(value, f"{given.label}.{key}", self.scalars.places, LENGTH)

    def formula(self, value: object, label: str, unit: Dimension) -> Formula:
        """Return a formula of what is known and of unknowns."""
        scope = self.scalars.known
        plain = MARK.sub(r"\1", value) if isinstance(value, str) else value
        both = Scope(dict(scope.dimensions) | self.units, scope.others, scope.rule)
        return formula(plain, label, both, unit)


def read_loads(
    given: Table, scalars: Scalars, frames: tuple[Frame, ...], bodies: tuple[Member, ...]
) -> tuple[tuple[Load, ...], tuple[Unknown, ...]]:
    """Return the loads and the unknowns among their components."""
    reader = _Reader(scalars, frames, bodies)
    tables = [
        (label(name, "a load"), table(value, f"load '{name}'"))
        for name, value in given.entries.items()
    ]
    for key, unit, text in (("force", FORCE, "N"), ("couple", MOMENT, "N m")):
        for name, entry in tables:
            _note_unknowns(reader, name, entry, key, unit, text)
    loads = tuple(_load(reader, name, entry) for name, entry in tables)
    return loads, tuple(reader.found.values())


def _spread(entry: Table, key: str) -> object:
    """Return three components, of which ``"?hinge"`` is short for three unknowns."""
    value = entry.entries.get(key, [0, 0, 0])
    if isinstance(value, str) and MARK.fullmatch(value.strip()):
        return [f"{value.strip()}_{axis}" for axis in AXES]
    return value


def _note_unknowns(
    reader: _Reader, name: str, entry: Table, key: str, unit: Dimension, text: str
) -> None:
    parts = _spread(entry, key)
    for place, part in enumerate(parts if isinstance(parts, list) else []):
        for found in MARK.findall(part) if isinstance(part, str) else []:
            what = f"the {key} of load '{name}'"
            if found not in reader.found:
                meaning = f"{key} of {name}"
                if isinstance(entry.entries.get(key), str):
                    meaning += f" along {AXES[place]}"
                reader.found[found] = Unknown(identifier(found, what), text, name, meaning)
                reader.units[found] = unit


def _load(reader: _Reader, name: str, given: Table) -> Load:
    if "gravity" in given.entries:
        keys(given, ("gravity",), ("on", "along"))
        along = reader.frame(given, "along", INERTIAL)
        value = triple(given.entries["gravity"], f"{given.label}.gravity",
                       reader.scalars.known, ACCELERATION)  # fmt: skip
        return Weight(name, reader.several(given), along, value)
    if "gravity_gradient" in given.entries:
        return _gradient(reader, name, given)
    if "spring" in given.entries or "damper" in given.entries:
        return _spring(reader, name, given)
    if not any(key in given.entries for key in MAIN):
        raise SceneError(f"{given.label} needs one of {', '.join(MAIN)}")
    return _force(reader, name, given)


def _force(reader: _Reader, name: str, given: Table) -> Force:
    keys(given, ("on",), ("against", "frame", "at", "along", "force", "couple"))
    on = reader.body(given, "on")
    frame = reader.frame(given, "frame", next(b.frame for b in reader.bodies if b.name == on))
    against = reader.body(given, "against") if "against" in given.entries else ""
    if on == against:
        raise SceneError(f"{given.label} acts on '{on}' against itself")
    force, couple = (
        _three(reader, given, key, unit) for key, unit in (("force", FORCE), ("couple", MOMENT))
    )
    along = reader.frame(given, "along", frame)
    return Force(name, on, against, frame, reader.place(given, "at"), along, force, couple)


def _three(reader: _Reader, given: Table, key: str, unit: Dimension) -> Triple:
    parts = _spread(given, key)
    if not isinstance(parts, list) or len(parts) != 3:
        raise SceneError(f"{given.label}.{key} must be a list of 3, not {shown(parts)}")
    x, y, z = (
        reader.formula(part, f"{given.label}.{key}.{axis}", unit)
        for part, axis in zip(parts, AXES, strict=True)
    )
    return x, y, z


def _gradient(reader: _Reader, name: str, given: Table) -> Gradient:
    keys(given, ("gravity_gradient", "towards"), ("on", "along"))
    strength = given.entries["gravity_gradient"]
    scope = reader.scalars.known
    along = reader.frame(given, "along", INERTIAL)
    towards = triple(given.entries["towards"], f"{given.label}.towards", scope, NONE)
    values = dict.fromkeys(scope.dimensions, 0.0) | dict(reader.scalars.middle())
    check_unit(towards, f"{given.label}.towards", values)
    value = formula(strength, f"{given.label}.gravity_gradient", scope, RATE_SQUARED)
    return Gradient(name, reader.several(given), along, towards, value)


def _spring(reader: _Reader, name: str, given: Table) -> Spring:
    optional = ("spring", "damper", "length", "against", "frame", "at", "to", "to_frame")
    keys(given, ("on",), optional)
    on = reader.body(given, "on")
    against = reader.body(given, "against") if "against" in given.entries else ""
    if on == against:
        raise SceneError(f"{given.label} acts on '{on}' against itself")
    scope = reader.scalars.known

    def one(key: str, unit: Dimension) -> Formula:
        if key not in given.entries:
            return ZERO
        return formula(given.entries[key], f"{given.label}.{key}", scope, unit)

    default = next(b.frame for b in reader.bodies if b.name == on)
    frame = reader.frame(given, "frame", default)
    at, to = reader.place(given, "at"), reader.place(given, "to")
    to_frame = reader.frame(given, "to_frame", INERTIAL)
    stiffness, damping = one("spring", STIFFNESS), one("damper", DAMPING)
    return Spring(name, on, against, frame, at, to_frame, to, stiffness, damping,
                  one("length", LENGTH))  # fmt: skip


def unknown_units(unknowns: tuple[Unknown, ...]) -> Mapping[str, Dimension]:
    """Return the dimension of each unknown."""
    return {u.name: dimension(u.unit) for u in unknowns}
