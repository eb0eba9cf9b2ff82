"""A body: its kind or shape read into mass, inertia and mass centre along its own axes.

What the user does not know stays None; whether an answer needs it is found later.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain
from typing import Any, Literal, cast

from derive.scene.declaration import AXES, Axis, SceneError, Sextuple, Triple
from derive.scene.entries import AXIS, KINDS, MASS, MEMBER, SAID, shape_entries
from derive.scene.entry import Entry, Reading, entries_of
from derive.scene.formula import ZERO, Formula, number
from derive.scene.machine import Entries, Frame, Member
from derive.scene.numbers import check_member, positive
from derive.scene.scalars import Scalars
from derive.scene.scope import formulas
from derive.scene.shape import (
    AXIS_AFTER,
    CONE_CENTRE,
    ROUND,
    Portion,
    about_axis,
    blade_parts,
    box,
    by_parallel_axes,
    diagonal,
    moment,
    round_part,
)
from derive.scene.table import Table, keys, one_of
from derive.scene.unit import LENGTH

CHOSEN = ("kind", "shape")
"""What says how a body's moments of inertia are known."""
InertiaKind = Literal["general", "principal", "axisymmetric", "spherical", "rod"]


@dataclass(frozen=True)
class Substance:
    """What a kind or a shape says: mass, inertia, the axis of symmetry, lengths, an offset centre.

    said : all entries of the body's table by key       given : its inertia about another point
    """

    kind: str
    mass: Formula | None
    inertia: Entries
    axis: Axis | None
    said: Mapping[str, Any]
    look: str = ""
    offset: Triple = (ZERO, ZERO, ZERO)
    lengths: Mapping[str, Formula] | None = None
    given: Entries = ()
    parts: tuple[Portion, ...] = ()

    def apex(self) -> Triple:
        """Return the mass centre of a cone, from its apex along its axis."""
        distance = number(CONE_CENTRE) * self.said["height"]
        x, y, z = (distance if name == self.axis else ZERO for name in AXES)
        return x, y, z


def read_member(name: str, given: Table, frames: tuple[Frame, ...], scalars: Scalars) -> Member:
    """Return a body of the machine, its inertia about its mass centre."""
    if "frame" not in given.entries:
        keys(given, ("frame",), every_key(MEMBER))
    one_of(given.entries["frame"], given.of("frame"), [f.name for f in frames])
    names = {"frame": tuple(f.name for f in frames)}
    made = _substance(given, Reading(scalars.scopes, names, scalars.parameters))
    said, (centre, made) = made.said, _about(given.label, made)
    check_member(given.label, made.inertia, scalars.parameters)
    _agree(given.label, made, centre)
    return Member(
        name, said["frame"], made.mass, made.inertia, centre, made.axis, said["turned"] or (),
        said["spin"], said["axial_speed"], said["angular_velocity"], made.look, made.lengths or {},
        given=made.given, parts=made.parts,
    )  # fmt: skip


def _agree(label: str, made: Substance, centre: Triple) -> None:
    """Refuse a body that turns in two ways, or in a way in which it would not look the same."""
    said = made.said
    if said["spin"] is not None and said["axial_speed"] is not None:
        raise SceneError(f"{label} has both spin and axial_speed; give one of them")
    if made.axis is None and (said["spin"] or said["axial_speed"]) is not None:
        rule = "turns about its own axis, so it must be axisymmetric and name its axis"
        raise SceneError(f"{label} {rule}; or give the angle by turned")
    xx, yy, zz, *products = made.inertia
    alike = xx == yy == zz and all(f == ZERO for f in (*products, *centre))
    if said["angular_velocity"] is not None and (not alike or said["turned"]):
        rule = "needs three equal moments and its mass centre at the frame's origin"
        raise SceneError(f"{label}: angular_velocity {rule}; or carry it by a frame of its own")


def _about(label: str, made: Substance) -> tuple[Triple, Substance]:
    """Return the mass centre and the inertia about it; ``about`` says what they are given by."""
    about, given = made.said["about"], made.said["centre"]
    centre = given or (ZERO, ZERO, ZERO)
    if about == "apex":
        if made.look != "cone" or given is not None:
            raise SceneError(f"{label}: about = 'apex' is for a cone without a centre")
        return made.apex(), made
    if about == "origin":
        if made.mass is None or None in made.inertia or made.said["turned"]:
            rule = "about = 'origin' needs mass and whole inertia, along the frame's axes"
            raise SceneError(f"{label}: {rule}")
        inertia = by_parallel_axes(cast("Sextuple", made.inertia), -made.mass, centre)
        return centre, replace(made, inertia=inertia, given=made.inertia)
    x, y, z = (a + b if b != ZERO else a for a, b in zip(centre, made.offset, strict=True))
    return (x, y, z), made


def every_key(more: Iterable[Entry]) -> tuple[str, ...]:
    """Return what any kind or shape of body may say, and what each says besides."""
    shapes = map(shape_entries, (*ROUND, *SAID))
    rows = (MASS, *more, *chain(*KINDS.values(), *shapes))
    return tuple(dict.fromkeys((*CHOSEN, *(row.key for row in rows))))


def _substance(given: Table, by: Reading) -> Substance:
    """Return what a machine's body is made of, as far as it is known."""
    if "shape" in given.entries and "kind" in given.entries:
        raise SceneError(f"{given.label} has both a kind and a shape; give one of them")
    if "shape" in given.entries:
        return of_shape(given, (*ROUND, *SAID), MEMBER, by)
    if "kind" in given.entries:
        return of_kind(given, MEMBER, by)
    rows = (replace(AXIS, default=None), MASS, *MEMBER)
    keys(given, (), every_key(MEMBER))
    keys(given, (), (*CHOSEN, *(row.key for row in rows)))
    said = entries_of(given, rows, by)
    products: Entries = (None, None, None) if said["axis"] is None else (ZERO, ZERO, ZERO)
    return Substance("", said["mass"], (None, None, None, *products), said["axis"], said)


def of_kind(given: Table, more: tuple[Entry, ...], by: Reading) -> Substance:
    """Return a body whose moments are given, and what else its table says."""
    kind = one_of(given.entries["kind"], given.of("kind"), KINDS)
    own = (Entry("kind", "text", ""), *KINDS[kind], MASS)
    said = entries_of(given, (*own, *more), by)
    if kind in ("general", "principal"):
        return Substance(kind, said["mass"], _three_moments(given, said), None, said)
    axis = said.get("axis")
    axial: Formula | None = ZERO if kind == "rod" else said.get("axial")
    across = said["transverse" if kind == "axisymmetric" else "moment"]
    xx, yy, zz = (axial if name == axis else across for name in AXES)
    return Substance(kind, said["mass"], (xx, yy, zz, ZERO, ZERO, ZERO), axis, said)


def _three_moments(given: Table, said: Mapping[str, Any]) -> Sextuple:
    if (said["moments"] is None) == (said["second_moments"] is None):
        raise SceneError(f"{given.label} needs either moments or second_moments")
    first, second, third = said["moments"] or said["second_moments"]
    if said["moments"] is None:
        first, second, third = second + third, first + third, first + second
    return (first, second, third, *said.get("products", (ZERO, ZERO, ZERO)))


def of_shape(
    given: Table, shapes: tuple[str, ...], more: tuple[Entry, ...], by: Reading
) -> Substance:
    """Return a body of a named shape and of uniform density, and what else its table says."""
    shape = one_of(given.entries["shape"], given.of("shape"), shapes)
    row = ROUND.get(shape)
    own = shape_entries(shape)
    taken = {entry.key for entry in own}
    more = tuple(entry for entry in more if entry.key not in taken)
    said = entries_of(given, (Entry("shape", "text", ""), *own, *more), by)
    mass, axis = said["mass"], said.get("axis")
    lengths = {e.key: said[e.key] for e in own if e.kind == "formula above 0" and e.unit == "m"}
    if row is not None:
        axial, across = (moment(terms, mass, lengths) for terms in (row.axial, row.transverse))
        inertia = about_axis(axis, axial, across)
        return Substance(row.kind, mass, inertia, axis, said, shape, lengths=lengths,
                         parts=(round_part(shape, axis, lengths),))  # fmt: skip
    if axis is not None and shape == "blades":
        first = said["first"] or AXIS_AFTER[axis]
        if first == axis:
            raise SceneError(f"{given.of('first')} must be across the axis, not '{axis}' itself")
        parts = blade_parts(axis, first, said["number"], said["length"])
        return replace(_blades(axis, mass, said), lengths=lengths, parts=parts)
    if shape == "point":
        inertia = diagonal(ZERO, ZERO, ZERO)
        return Substance("spherical", mass, inertia, None, said, shape, lengths=lengths,
                         parts=(Portion("ball", "z"),))  # fmt: skip
    edges = _edges(given, tuple(name for name in AXES if name != axis), by)
    x, y, z = (edges.get(name, ZERO) for name in AXES)  # a plate has no edge across
    drawn = {f"length_{n}": edge for n, edge in enumerate(edges.values(), 1)}
    return Substance("principal", mass, box(mass, (x, y, z)), None, said, shape, lengths=drawn,
                     parts=(Portion("box", axis or "z", edges=(x, y, z)),))  # fmt: skip


def _edges(given: Table, along: tuple[Axis, ...], by: Reading) -> dict[Axis, Formula]:
    """Return the edges of a box, or of a plate, by the axes that they lie along."""
    label = given.of("lengths")
    edges = formulas(given.entries["lengths"], label, along, by.scopes["constants"], LENGTH)
    return {
        name: positive(edge, f"{label}.{name}", by.parameters)
        for name, edge in zip(along, edges, strict=True)
    }


def _blades(axis: Axis, mass: Formula, said: Mapping[str, Any]) -> Substance:
    """Return slender blades from the hub: a rod for one and two, else as good as a disc."""
    count, length = said["number"], said["length"]
    one = mass * length**2
    first = said["first"] or AXIS_AFTER[axis]
    if count == 1:
        inertia = about_axis(first, ZERO, number(Fraction(1, 12)) * one)
        x, y, z = (number(Fraction(1, 2)) * length if a == first else ZERO for a in AXES)
        return Substance("rod", mass, inertia, None, said, "blades", (x, y, z))
    whole, axial = number(count) * mass, number(Fraction(count, 3)) * one
    if count == 2:
        x, y, z = (ZERO if a == first else axial for a in AXES)
        return Substance("rod", whole, diagonal(x, y, z), None, said, "blades")
    half = number(Fraction(count, 6)) * one
    return Substance("axisymmetric", whole, about_axis(axis, axial, half), axis, said, "blades")
