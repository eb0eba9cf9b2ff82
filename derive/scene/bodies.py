"""A body: its kind or shape read into mass, inertia and mass centre along its own axes.

What the user does not know stays None; whether an answer needs it is found later.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Literal, cast

from derive.scene.declaration import Axis, SceneError, Sextuple, Triple, Turning
from derive.scene.formula import ZERO, Formula, number
from derive.scene.machine import Entries, Frame, Member
from derive.scene.numbers import check_member, positive
from derive.scene.scalars import Scalars, turnings
from derive.scene.shape import CONE_CENTRE, ROUND, about_axis, box, diagonal, moment, moved
from derive.scene.table import Table, formula, keys, listed, shown, triple, word
from derive.scene.unit import ANGULAR_VELOCITY, INERTIA, LENGTH, MASS, Dimension

if TYPE_CHECKING:
    from collections.abc import Mapping

Kind = Literal["general", "principal", "axisymmetric", "spherical", "rod"]
AXES: tuple[Axis, ...] = ("x", "y", "z")
KINDS: Mapping[str, tuple[str, ...]] = {
    "general": ("products",),
    "principal": (),
    "axisymmetric": ("axis", "axial", "transverse"),
    "spherical": ("moment",),
    "rod": ("axis", "moment"),
}
"""What each kind of body must say; general and principal ones also their moments."""
SAID: Mapping[str, tuple[str, ...]] = {
    "box": ("lengths",),
    "plate": ("lengths", "axis"),
    "point": (),
    "blades": ("number", "length", "axis"),
}
"""Shapes that are not round, and what each must say besides its mass."""
COMMON = ("mass", "centre", "turned", "spin")
OWN = ("frame", "turned", "spin", "axial_speed", "angular_velocity", "about", "centre")
LENGTHS = ("radius", "length", "height", "inner", "outer")
NEXT: Mapping[str, Axis] = {"x": "y", "y": "z", "z": "x"}


@dataclass(frozen=True)
class Substance:
    """What a kind or a shape says: mass, inertia, the axis of symmetry, where the centre lies."""

    kind: str
    mass: Formula | None
    inertia: Entries
    axis: Axis | None
    look: str = ""
    offset: Triple = (ZERO, ZERO, ZERO)


@dataclass(frozen=True)
class BodyTable:
    """The table of a body with the scalars that it may use."""

    table: Table
    scalars: Scalars

    def has(self, key: str) -> bool:
        """Tell whether an entry is there."""
        return key in self.table.entries

    def label(self, key: str) -> str:
        """Return what an entry is called in a sentence."""
        return f"{self.table.label}.{key}"

    def one(self, key: str, unit: Dimension) -> Formula:
        """Return a formula of parameters."""
        return formula(self.table.entries[key], self.label(key), self.scalars.constants, unit)

    def three(self, key: str, unit: Dimension) -> Triple:
        """Return three formulas of parameters."""
        return triple(self.table.entries[key], self.label(key), self.scalars.constants, unit)

    def positive(self, key: str, unit: Dimension) -> Formula:
        """Return a formula of parameters that is above zero."""
        return positive(self.one(key, unit), self.label(key), self.scalars.parameters)

    def moment(self, key: str) -> Formula | None:
        """Return a moment of inertia, if it is known."""
        return self.one(key, INERTIA) if self.has(key) else None

    def mass(self) -> Formula | None:
        """Return the mass, if it is known."""
        return self.positive("mass", MASS) if self.has("mass") else None

    def axis(self) -> Axis:
        """Return the axis of symmetry."""
        return cast("Axis", word(self.table.entries["axis"], self.label("axis"), AXES))

    def moves(self, key: str) -> Formula | None:
        """Return an angular velocity about the body's axis, if it is there."""
        if not self.has(key):
            return None
        value = self.table.entries[key]
        return formula(value, self.label(key), self.scalars.motions, ANGULAR_VELOCITY)

    def lengths(self) -> dict[str, Formula]:
        """Return the lengths of a shape, by which it is drawn and which must be positive."""
        found = {key: self.one(key, LENGTH) for key in LENGTHS if self.has(key)}
        listed_ = self.table.entries.get("lengths")
        for n, part in enumerate(listed_ if isinstance(listed_, list) else (), 1):
            label, scope = self.label("lengths"), self.scalars.constants
            found[f"length_{n}"] = formula(part, label, scope, LENGTH)
        return found


def apex(given: BodyTable, made: Substance) -> Triple:
    distance = number(CONE_CENTRE) * given.one("height", LENGTH)
    x, y, z = (distance if name == made.axis else ZERO for name in AXES)
    return x, y, z


def read_member(name: str, table: Table, frames: tuple[Frame, ...], scalars: Scalars) -> Member:
    """Return a body of the machine, its inertia about its mass centre."""
    given, entries = BodyTable(table, scalars), table.entries
    if "frame" not in entries:
        raise SceneError(f"{table.label} needs 'frame'")
    frame = word(entries["frame"], given.label("frame"), [f.name for f in frames])
    made = _substance(given)
    centre: Triple = (ZERO, ZERO, ZERO)
    if "centre" in entries:
        centre = given.three("centre", LENGTH)
    centre, made = _about(given, centre, made)
    check_member(table.label, made.inertia, scalars.parameters)
    turned: tuple[Turning, ...] = ()
    if "turned" in entries:
        turned = turnings(entries["turned"], given.label("turned"), scalars.places)
    spin, axial_speed = _spins(given, made)
    return Member(
        name, frame, made.mass, made.inertia, centre, made.axis, turned, spin, axial_speed,
        _angular_velocity(given, centre, made), made.look, given.lengths(),
    )  # fmt: skip


def _spins(given: BodyTable, made: Substance) -> tuple[Formula | None, Formula | None]:
    """Return how a body turns about its own axis: its spin or its axial speed, or neither."""
    spin, axial_speed = given.moves("spin"), given.moves("axial_speed")
    if spin is not None and axial_speed is not None:
        raise SceneError(f"{given.table.label} has both spin and axial_speed; give one of them")
    if (spin or axial_speed) is not None and made.axis is None:
        rule = "turns about its own axis, so it must be axisymmetric and name its axis"
        raise SceneError(f"{given.table.label} {rule}; or give the angle by turned")
    return spin, axial_speed


def _angular_velocity(given: BodyTable, centre: Triple, made: Substance) -> Triple | None:
    """Return how a ball turns in its frame; any other body would not look the same."""
    if not given.has("angular_velocity"):
        return None
    xx, yy, zz, *products = made.inertia
    alike = xx == yy == zz and all(f == ZERO for f in (*products, *centre))
    if not alike or given.has("turned"):
        rule = "needs three equal moments and its mass centre at the frame's origin"
        raise SceneError(
            f"{given.table.label}: angular_velocity {rule}; or carry it by a frame of its own"
        )
    value, label = given.table.entries["angular_velocity"], given.label("angular_velocity")
    return triple(value, label, given.scalars.motions, ANGULAR_VELOCITY)


def _about(given: BodyTable, centre: Triple, made: Substance) -> tuple[Triple, Substance]:
    """Return the mass centre and the inertia about it; ``about`` says what they are given by."""
    about = word(given.table.entries.get("about", "centre"), given.label("about"),
                 ("centre", "origin", "apex"))  # fmt: skip
    if about == "apex":
        if made.look != "cone" or given.has("centre"):
            raise SceneError(f"{given.table.label}: about = 'apex' is for a cone without a centre")
        return apex(given, made), made
    if about == "origin":
        if made.mass is None or None in made.inertia or given.has("turned"):
            rule = "about = 'origin' needs mass and whole inertia, along the frame's axes"
            raise SceneError(f"{given.table.label}: {rule}")
        inertia = moved(cast("Sextuple", made.inertia), -made.mass, centre)
        return centre, replace(made, inertia=inertia)
    x, y, z = (a + b if b != ZERO else a for a, b in zip(centre, made.offset, strict=True))
    return (x, y, z), made


def _substance(given: BodyTable) -> Substance:
    """Return what a machine's body is made of, as far as it is known."""
    if given.has("shape") and given.has("kind"):
        raise SceneError(f"{given.table.label} has both a kind and a shape; give one of them")
    if given.has("shape"):
        return of_shape(given, (*ROUND, *SAID), OWN)
    if given.has("kind"):
        loose = {**KINDS, "axisymmetric": ("axis",)}  # a moment that is left out is not known
        return of_kind(given, loose, ("mass", *OWN))
    keys(given.table, (), (*OWN, "mass", "axis"))
    axis = given.axis() if given.has("axis") else None
    products: Entries = (None, None, None) if axis is None else (ZERO, ZERO, ZERO)
    return Substance("", given.mass(), (None, None, None, *products), axis)


def of_kind(
    given: BodyTable, kinds: Mapping[str, tuple[str, ...]], optional: tuple[str, ...]
) -> Substance:
    """Return a body whose moments are given."""
    kind = word(given.table.entries["kind"], given.label("kind"), kinds)
    three = ("moments", "second_moments") if kind in ("general", "principal") else ()
    loose = KINDS[kind] if kind == "axisymmetric" else ()
    keys(given.table, ("kind", *kinds[kind]), (*three, *loose, *optional))
    mass = given.mass()
    if three:
        return Substance(kind, mass, _three_moments(given), None)
    axis = None if kind == "spherical" else given.axis()
    axial: Formula | None = ZERO if kind == "rod" else given.moment("axial")
    across = given.moment("transverse" if kind == "axisymmetric" else "moment")
    xx, yy, zz = (axial if name == axis else across for name in AXES)
    return Substance(kind, mass, (xx, yy, zz, ZERO, ZERO, ZERO), axis)


def _three_moments(given: BodyTable) -> Sextuple:
    if given.has("moments") == given.has("second_moments"):
        raise SceneError(f"{given.table.label} needs either moments or second_moments")
    key = "moments" if given.has("moments") else "second_moments"
    first, second, third = given.three(key, INERTIA)
    if key == "second_moments":
        first, second, third = second + third, first + third, first + second
    if not given.has("products"):
        return diagonal(first, second, third)
    value = given.table.entries["products"]
    if not isinstance(value, list) or len(value) != 3:
        rule = "must be a list of 3 (xy, xz, yz)"
        raise SceneError(f"{given.label('products')} {rule}, not {shown(value)}")
    xy, xz, yz = (
        formula(part, given.label(f"products.{name}"), given.scalars.constants, INERTIA)
        for part, name in zip(value, ("xy", "xz", "yz"), strict=True)
    )
    return first, second, third, xy, xz, yz


def of_shape(given: BodyTable, shapes: tuple[str, ...], optional: tuple[str, ...]) -> Substance:
    """Return a body of a named shape and of uniform density."""
    shape = word(given.table.entries["shape"], given.label("shape"), shapes)
    row = ROUND.get(shape)
    own = SAID[shape] if row is None else (*row.lengths, *(() if row.sphere else ("axis",)))
    about = ("about",) if shape == "cone" else ()
    keys(given.table, ("shape", "mass", *own), (*optional, *about))
    mass = given.positive("mass", MASS)
    axis = given.axis() if "axis" in own else None
    if row is not None:
        lengths = {key: given.positive(key, LENGTH) for key in row.lengths}
        axial, across = (moment(terms, mass, lengths) for terms in (row.axial, row.transverse))
        return Substance(row.kind, mass, about_axis(axis, axial, across), axis, shape)
    if axis is not None and shape == "blades":
        return _blades(given, axis, mass)
    if shape == "point":
        return Substance("spherical", mass, diagonal(ZERO, ZERO, ZERO), None, shape)
    along = tuple(name for name in AXES if name != axis)  # a plate has no edge across
    return Substance("principal", mass, box(mass, _edges(given, along)), None, shape)


def _edges(given: BodyTable, along: tuple[Axis, ...]) -> Triple:
    """Return the edges of a box along x, y and z, or of a plate: none across it."""
    parts = listed(given.table.entries["lengths"], given.label("lengths"), len(along))
    found = {}
    for part, name in zip(parts, along, strict=True):
        label = given.label(f"lengths.{name}")
        edge = formula(part, label, given.scalars.constants, LENGTH)
        found[name] = positive(edge, label, given.scalars.parameters)
    x, y, z = (found.get(name, ZERO) for name in AXES)
    return x, y, z


def _blades(given: BodyTable, axis: Axis, mass: Formula) -> Substance:
    """Return slender blades from the hub: a rod for one and two, else as good as a disc."""
    count = given.table.entries["number"]
    if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= 99:
        rule = f"must be a whole number of blades, not {shown(count)}"
        raise SceneError(f"{given.label('number')} {rule}")
    length = given.positive("length", LENGTH)
    one = mass * length**2
    first = NEXT[axis]
    if count == 1:
        inertia = about_axis(first, ZERO, number(Fraction(1, 12)) * one)
        x, y, z = (number(Fraction(1, 2)) * length if a == first else ZERO for a in AXES)
        return Substance("rod", mass, inertia, None, "blades", (x, y, z))
    whole, axial = number(count) * mass, number(Fraction(count, 3)) * one
    if count == 2:
        x, y, z = (ZERO if a == first else axial for a in AXES)
        return Substance("rod", whole, diagonal(x, y, z), None, "blades")
    half = number(Fraction(count, 6)) * one
    return Substance("axisymmetric", whole, about_axis(axis, axial, half), axis, "blades")
