"""The loads of a machine: forces and couples with unknowns, weights, springs, gravity gradients."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from derive.scene.declaration import AXES, SceneError, Triple
from derive.scene.entries import CENTRE_OF_FIELD, FORCE, GRADIENT, SPRING, WEIGHT
from derive.scene.entry import Entry, Reading, entries_of
from derive.scene.formula import Formula, FormulaError, number
from derive.scene.machine import Force, Frame, Gradient, Load, Member, Spring, Unknown, Weight
from derive.scene.names import identifier, label
from derive.scene.numbers import check_unit, ends_of, middle
from derive.scene.scalars import Scalars
from derive.scene.scope import formula, triple
from derive.scene.table import Table, keys, table
from derive.scene.unit import Dimension, dimension

MARK = re.compile(r"\?([A-Za-z][A-Za-z0-9_]*)")
UNKNOWNS = {"force": "N", "couple": "N m"}
"""Entries that may hold unknowns, and their unit."""
MAIN: Mapping[str, tuple[Entry, ...]] = {
    "gravity": WEIGHT,
    "gravity_gradient": GRADIENT,
    "spring": SPRING,
    "damper": SPRING,
    "force": FORCE,
    "couple": FORCE,
}
"""What tells loads apart, and what each may say."""


@dataclass
class _Reader:
    """What loads are read with: scalars, bodies, and the unknowns found so far."""

    scalars: Scalars
    bodies: tuple[Member, ...]
    by: Reading
    found: dict[str, Unknown] = field(default_factory=dict)

    def carrier(self, body: str) -> str:
        """Return the frame of a body."""
        return next(b.frame for b in self.bodies if b.name == body)


def read_loads(
    given: Table, scalars: Scalars, frames: tuple[Frame, ...], bodies: tuple[Member, ...]
) -> tuple[tuple[Load, ...], tuple[Unknown, ...]]:
    """Return the loads and the unknowns among their components."""
    names = {"frame": tuple(f.name for f in frames), "body": tuple(b.name for b in bodies)}
    reader = _Reader(scalars, bodies, Reading(scalars.scopes, names))
    tables = [
        (label(name, "a load"), table(value, f"load '{name}'"))
        for name, value in given.entries.items()
    ]
    for key in UNKNOWNS:
        for name, entry in tables:
            _note_unknowns(reader, name, entry, key)
    loads = tuple(_load(reader, name, entry) for name, entry in tables)
    return loads, tuple(reader.found.values())


def _spread(entry: Table, key: str) -> object:
    """Return three components, of which ``"?hinge"`` is short for three unknowns."""
    value = entry.entries.get(key, [0, 0, 0])
    if isinstance(value, str) and MARK.fullmatch(value.strip()):
        return [f"{value.strip()}_{axis}" for axis in AXES]
    return value


def _note_unknowns(reader: _Reader, name: str, entry: Table, key: str) -> None:
    parts = _spread(entry, key)
    for part in parts if isinstance(parts, list) else []:
        for found in MARK.findall(part) if isinstance(part, str) else []:
            what = f"the {key} of load '{name}'"
            if found not in reader.found:
                reader.found[found] = Unknown(identifier(found, what), UNKNOWNS[key], name)


def _load(reader: _Reader, name: str, given: Table) -> Load:
    rows = next((rows for key, rows in MAIN.items() if key in given.entries), None)
    if rows is None:
        keys(given, (), dict.fromkeys(row.key for rows in MAIN.values() for row in rows))
        raise SceneError(f"{given.label} needs one of {', '.join(MAIN)}")
    on = given.entries.get("on")
    if isinstance(on, str) and on == given.entries.get("against"):
        raise SceneError(f"{given.label} acts on '{on}' against itself")
    said = entries_of(given, rows, reader.by)
    if rows is WEIGHT or rows is GRADIENT:
        every = said["on"] or reader.by.names["body"]
        if rows is WEIGHT:
            return Weight(name, every, said["along"], said["gravity"])
        ranges = ends_of((*reader.scalars.parameters, *reader.scalars.moving))
        values = {**dict.fromkeys(reader.scalars.known.dimensions, 0.0), **middle(ranges)}
        check_unit(said["towards"], given.of("towards"), values)
        return Gradient(name, every, said["along"], said["towards"], _strength(reader, given))
    frame, against = said["frame"] or reader.carrier(said["on"]), said["against"] or ""
    if rows is SPRING:
        return Spring(name, said["on"], against, frame, said["at"], said["to_frame"], said["to"],
                      said["spring"], said["damper"], said["length"])  # fmt: skip
    force, couple = (_three(reader, given, key) for key in UNKNOWNS)
    along = said["along"] or frame
    return Force(name, said["on"], against, frame, said["at"], along, force, couple)


def _strength(reader: _Reader, given: Table) -> Formula:
    """Return what a gravity gradient multiplies: a formula, or that of a centre or of an orbit."""
    value, label = given.entries["gravity_gradient"], given.of("gravity_gradient")
    if not isinstance(value, dict):
        return formula(value, label, reader.scalars.known, dimension("1/s^2"))
    said = entries_of(Table(label, value), CENTRE_OF_FIELD, reader.by)
    mu, distance, rate = (said[row.key] for row in CENTRE_OF_FIELD)
    said_of = [one is not None for one in (mu, distance, rate)]
    if said_of not in ([True, True, False], [False, False, True]):
        raise SceneError(f"{label} needs mu and distance, or orbital_rate alone")
    try:
        strength: Formula = rate**2 if mu is None else mu / distance**3
    except FormulaError as error:
        raise SceneError(f"{label}: 3*mu/distance^3 {error}") from None
    return number(3) * strength


def _three(reader: _Reader, given: Table, key: str) -> Triple:
    """Return three formulas of what is known and of unknowns."""
    parts, known = _spread(given, key), reader.scalars.known
    units = unknown_units(tuple(reader.found.values()))
    both = replace(known, dimensions={**known.dimensions, **units})
    if isinstance(parts, list):
        parts = [MARK.sub(r"\1", part) if isinstance(part, str) else part for part in parts]
    return triple(parts, given.of(key), both, dimension(UNKNOWNS[key]))


def unknown_units(unknowns: tuple[Unknown, ...]) -> Mapping[str, Dimension]:
    """Return the dimension of each unknown."""
    return {u.name: dimension(u.unit) for u in unknowns}
