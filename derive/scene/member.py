"""A body of a machine: kind or shape read into its inertia about its own mass centre.

What the user does not know stays None; whether an answer needs it is found later.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, cast

from derive.scene.body import AXES, KINDS, lengths, read_body
from derive.scene.declaration import Axis, SceneError, Sextuple, Triple
from derive.scene.formula import ZERO, Formula, number
from derive.scene.machine import Entries, Frame, Member, Turning
from derive.scene.numbers import check_member, positive
from derive.scene.scalars import Scalars, turnings
from derive.scene.shape import CONE_CENTRE, SHAPES, about_axis, box, diagonal, moved
from derive.scene.symbols import Symbols, constants
from derive.scene.table import Table, formula, keys, shown, triple, word
from derive.scene.unit import ANGULAR_VELOCITY, INERTIA, LENGTH, MASS, Dimension

if TYPE_CHECKING:
    from collections.abc import Mapping

OWN = ("frame", "turned", "spin", "axial_speed", "angular_velocity", "about", "centre")
MORE_SHAPES: Mapping[str, tuple[str, ...]] = {
    "point": (),
    "plate": ("lengths", "axis"),
    "tube": ("inner", "outer", "length", "axis"),
    "blades": ("number", "length", "axis"),
}
"""Shapes beside those of a single body, and what each must say besides its mass."""
NEXT: Mapping[str, Axis] = {"x": "y", "y": "z", "z": "x"}


@dataclass(frozen=True)
class _Substance:
    """Mass and inertia about the mass centre, the axis of symmetry, and the shape."""

    mass: Formula | None
    inertia: Entries
    axis: Axis | None
    look: str
    offset: Triple = (ZERO, ZERO, ZERO)


def read_member(name: str, given: Table, frames: tuple[Frame, ...], scalars: Scalars) -> Member:
    """Return a body of the machine."""
    entries, fixed = given.entries, Symbols(scalars.parameters, (), (), ())
    if "frame" not in entries:
        raise SceneError(f"{given.label} needs 'frame'")
    frame = word(entries["frame"], f"{given.label}.frame", [f.name for f in frames])
    scope = constants(fixed)
    made = _substance(given, fixed)
    centre: Triple = (ZERO, ZERO, ZERO)
    if "centre" in entries:
        centre = triple(entries["centre"], f"{given.label}.centre", scope, LENGTH)
    centre, made = _about(given, centre, made, fixed)
    check_member(given.label, made.inertia, scalars.parameters)
    turned: tuple[Turning, ...] = ()
    if "turned" in entries:
        turned = turnings(entries["turned"], f"{given.label}.turned", scalars.places)
    spins = _spins(given, made, scalars)
    relative = _angular_velocity(given, centre, made, scalars)
    return Member(
        name, frame, made.mass, made.inertia, centre, made.axis, turned,
        spins.get("spin"), spins.get("axial_speed"), relative, made.look, lengths(given, scope),
    )  # fmt: skip


def _spins(given: Table, made: _Substance, scalars: Scalars) -> dict[str, Formula]:
    """Return how a body turns about its own axis: its spin or its axial speed, or neither."""
    spins = {
        key: formula(given.entries[key], f"{given.label}.{key}", scalars.motions, ANGULAR_VELOCITY)
        for key in ("spin", "axial_speed")
        if key in given.entries
    }
    if len(spins) == 2:
        raise SceneError(f"{given.label} has both spin and axial_speed; give one of them")
    if spins and made.axis is None:
        rule = "turns about its own axis, so it must be axisymmetric and name its axis"
        raise SceneError(f"{given.label} {rule}; or give the angle by turned")
    return spins


def _angular_velocity(
    given: Table, centre: Triple, made: _Substance, scalars: Scalars
) -> Triple | None:
    """Return how a ball turns in its frame; any other body would not look the same."""
    if "angular_velocity" not in given.entries:
        return None
    xx, yy, zz, *products = made.inertia
    alike = xx == yy == zz and all(f == ZERO for f in (*products, *centre))
    if not alike or "turned" in given.entries:
        rule = "needs three equal moments and its mass centre at the frame's origin"
        raise SceneError(
            f"{given.label}: angular_velocity {rule}; or carry it by a frame of its own"
        )
    label = f"{given.label}.angular_velocity"
    return triple(given.entries["angular_velocity"], label, scalars.motions, ANGULAR_VELOCITY)


def _about(
    given: Table, centre: Triple, made: _Substance, fixed: Symbols
) -> tuple[Triple, _Substance]:
    """Return the mass centre and the inertia about it; ``about`` says what they are given by."""
    about = word(given.entries.get("about", "centre"), f"{given.label}.about",
                 ("centre", "origin", "apex"))  # fmt: skip
    if about == "apex":
        if made.look != "cone" or "centre" in given.entries:
            raise SceneError(f"{given.label}: about = 'apex' is for a cone without a centre")
        height = formula(given.entries["height"], f"{given.label}.height", constants(fixed), LENGTH)
        distance = number(CONE_CENTRE) * height
        x, y, z = (distance if axis == made.axis else ZERO for axis in AXES)
        return (x, y, z), made
    if about == "origin":
        if made.mass is None or None in made.inertia or "turned" in given.entries:
            rule = "about = 'origin' needs mass and whole inertia, along the frame's axes"
            raise SceneError(f"{given.label}: {rule}")
        inertia = moved(cast("Sextuple", made.inertia), -made.mass, centre)
        return centre, replace(made, inertia=inertia)
    x, y, z = (a + b if b != ZERO else a for a, b in zip(centre, made.offset, strict=True))
    return (x, y, z), made


def _substance(given: Table, fixed: Symbols) -> _Substance:
    entries = given.entries
    if "shape" in entries and "kind" in entries:
        raise SceneError(f"{given.label} has both a kind and a shape; give one of them")
    if "shape" in entries:
        shape = word(entries["shape"], f"{given.label}.shape", (*SHAPES, *MORE_SHAPES))
        if shape in MORE_SHAPES:
            return _more(given, shape, fixed)
        return _of_one_body(given, fixed, shape)
    if "kind" in entries:
        kind = word(entries["kind"], f"{given.label}.kind", KINDS)
        if kind == "axisymmetric":
            return _axisymmetric(given, fixed)
        return _of_one_body(given, fixed, "")
    keys(given, (), (*OWN, "mass", "axis"))
    axis = (
        cast("Axis", word(entries["axis"], f"{given.label}.axis", AXES))
        if "axis" in entries
        else None
    )
    return _Substance(_mass(given, fixed), _unknown(axis), axis, "")


def _unknown(axis: Axis | None) -> Entries:
    """Return an inertia of which nothing is known but that it may have an axis of symmetry."""
    products: Entries = (None, None, None) if axis is None else (ZERO, ZERO, ZERO)
    return (None, None, None, *products)


def _of_one_body(given: Table, fixed: Symbols, look: str) -> _Substance:
    """Return a kind or shape that a scene of a single body may have too."""
    plain = {key: value for key, value in given.entries.items() if key not in OWN}
    body = read_body(Table(given.label, plain), "centre_of_mass", fixed)
    return _Substance(body.mass, body.inertia, body.axis, look)


def _mass(given: Table, fixed: Symbols) -> Formula | None:
    return _positive(given, "mass", MASS, fixed) if "mass" in given.entries else None


def _positive(given: Table, key: str, expected: Dimension, fixed: Symbols) -> Formula:
    label = f"{given.label}.{key}"
    found = formula(given.entries[key], label, constants(fixed), expected)
    return positive(found, label, fixed.parameters)


def _axisymmetric(given: Table, fixed: Symbols) -> _Substance:
    """Return an axisymmetric body; a moment that is left out is not known."""
    keys(given, ("kind", "axis"), ("axial", "transverse", "mass", *OWN))
    axis = cast("Axis", word(given.entries["axis"], f"{given.label}.axis", AXES))
    moments = {
        key: formula(given.entries[key], f"{given.label}.{key}", constants(fixed), INERTIA)
        for key in ("axial", "transverse")
        if key in given.entries
    }
    first, second, third = (moments.get("axial" if name == axis else "transverse") for name in AXES)
    inertia: Entries = (first, second, third, ZERO, ZERO, ZERO)
    return _Substance(_mass(given, fixed), inertia, axis, "")


def _more(given: Table, shape: str, fixed: Symbols) -> _Substance:
    keys(given, ("shape", "mass", *MORE_SHAPES[shape]), OWN)
    mass = _positive(given, "mass", MASS, fixed)
    if shape == "point":
        return _Substance(mass, diagonal(ZERO, ZERO, ZERO), None, shape)
    axis = cast("Axis", word(given.entries["axis"], f"{given.label}.axis", AXES))
    if shape == "plate":
        return _Substance(mass, box(mass, _plate(given, axis, fixed)), None, shape)
    if shape == "blades":
        return _blades(given, axis, mass, fixed)
    inner, outer, length = (
        _positive(given, key, LENGTH, fixed) for key in ("inner", "outer", "length")
    )
    across = inner**2 + outer**2
    axial = number(Fraction(1, 2)) * mass * across
    transverse = number(Fraction(1, 4)) * mass * across
    transverse = transverse + number(Fraction(1, 12)) * mass * length**2
    return _Substance(mass, about_axis(axis, axial, transverse), axis, shape)


def _plate(given: Table, axis: Axis, fixed: Symbols) -> Triple:
    """Return the edges of a plate along x, y and z: none along its axis."""
    value = given.entries["lengths"]
    if not isinstance(value, list) or len(value) != 2:
        raise SceneError(f"{given.label}.lengths must be a list of 2, not {shown(value)}")
    scope = constants(fixed)
    label, parameters = f"{given.label}.lengths", fixed.parameters
    edges = [positive(formula(part, label, scope, LENGTH), label, parameters) for part in value]
    x, y, z = (ZERO if name == axis else edges.pop(0) for name in AXES)
    return x, y, z


def _blades(given: Table, axis: Axis, mass: Formula, fixed: Symbols) -> _Substance:
    """Return slender blades from the hub: a rod for one and two, else as good as a disc."""
    count = given.entries["number"]
    if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= 99:
        raise SceneError(
            f"{given.label}.number must be a whole number of blades, not {shown(count)}"
        )
    length = _positive(given, "length", LENGTH, fixed)
    one = mass * length**2
    first = NEXT[axis]
    if count == 1:
        inertia = about_axis(first, ZERO, number(Fraction(1, 12)) * one)
        x, y, z = (number(Fraction(1, 2)) * length if a == first else ZERO for a in AXES)
        return _Substance(mass, inertia, None, "blades", (x, y, z))
    whole, axial = number(count) * mass, number(Fraction(count, 3)) * one
    if count == 2:
        x, y, z = (ZERO if a == first else axial for a in AXES)
        return _Substance(whole, diagonal(x, y, z), None, "blades")
    half = number(Fraction(count, 6)) * one
    return _Substance(whole, about_axis(axis, axial, half), axis, "blades")
