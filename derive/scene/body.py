"""The body of a scene: its kind or shape read into six formulas about the scene's point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, cast

from derive.scene.declaration import Axis, Body, SceneError, Sextuple, Triple
from derive.scene.formula import ZERO, Formula, number
from derive.scene.numbers import positive
from derive.scene.shape import CONE_CENTRE, ROUND, SHAPES, about_axis, box, diagonal, moment, moved
from derive.scene.symbols import Symbols, constants, motions, turns
from derive.scene.table import Scope, Table, formula, keys, shown, triple, word
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
COMMON = ("mass", "centre", "turned", "spin")
LENGTHS = ("radius", "length", "height", "inner", "outer")


@dataclass(frozen=True)
class Part:
    """What a kind or a shape says of the body."""

    kind: str
    inertia: Sextuple
    centre: Triple | None
    axis: Axis | None


def read_body(given: Table, point: str, symbols: Symbols) -> Body:
    """Return the body, its inertia about the scene's point along its own axes.

    point : the kind of the scene's point; a shape is moved to it unless it is the mass centre
    """
    entries = given.entries
    if ("shape" in entries) == ("kind" in entries):
        raise SceneError("body needs either a kind or a shape")
    read = _shaped(given, point, symbols) if "shape" in entries else _of_kind(given, symbols)
    spin = None
    if "spin" in entries:
        spin = formula(entries["spin"], "body.spin", motions(symbols), ANGULAR_VELOCITY)
    return Body(
        cast("Kind", read.kind),
        _positive(given, "mass", MASS, symbols) if "mass" in entries else None,
        read.inertia,
        read.centre,
        read.axis,
        turns(entries["turned"], "body.turned", symbols) if "turned" in entries else (),
        spin,
        lengths(given, constants(symbols)),
    )


def lengths(given: Table, scope: Scope) -> dict[str, Formula]:
    """Return the lengths of a shape, by which it is drawn and which must be positive."""
    entries = given.entries
    found = {
        key: formula(entries[key], f"{given.label}.{key}", scope, LENGTH)
        for key in LENGTHS
        if key in entries
    }
    listed = entries.get("lengths")
    for n, part in enumerate(listed if isinstance(listed, list) else (), 1):
        found[f"length_{n}"] = formula(part, f"{given.label}.lengths", scope, LENGTH)
    return found


def _positive(given: Table, key: str, expected: Dimension, symbols: Symbols) -> Formula:
    label = f"{given.label}.{key}"
    found = formula(given.entries[key], label, constants(symbols), expected)
    return positive(found, label, symbols.parameters)


def _centre(given: Table, scope: Scope) -> Triple | None:
    if "centre" not in given.entries:
        return None
    return triple(given.entries["centre"], f"{given.label}.centre", scope, LENGTH)


def _axis(given: Table) -> Axis:
    return cast("Axis", word(given.entries["axis"], f"{given.label}.axis", AXES))


def _moment(given: Table, key: str, scope: Scope) -> Formula:
    return formula(given.entries[key], f"{given.label}.{key}", scope, INERTIA)


def _of_kind(given: Table, symbols: Symbols) -> Part:
    kind, scope = word(given.entries["kind"], f"{given.label}.kind", KINDS), constants(symbols)
    three = ("moments", "second_moments") if kind in ("general", "principal") else ()
    keys(given, ("kind", *KINDS[kind]), (*three, *COMMON))
    centre = _centre(given, scope)
    if three:
        return Part(kind, _three_moments(given, scope), centre, None)
    if kind == "spherical":
        common = _moment(given, "moment", scope)
        return Part(kind, diagonal(common, common, common), centre, None)
    axis = _axis(given)
    if kind == "rod":
        inertia = about_axis(axis, ZERO, _moment(given, "moment", scope))
        return Part(kind, inertia, centre, axis)
    axial, transverse = _moment(given, "axial", scope), _moment(given, "transverse", scope)
    return Part(kind, about_axis(axis, axial, transverse), centre, axis)


def _three_moments(given: Table, scope: Scope) -> Sextuple:
    if ("moments" in given.entries) == ("second_moments" in given.entries):
        raise SceneError(f"{given.label} needs either moments or second_moments")
    key = "moments" if "moments" in given.entries else "second_moments"
    first, second, third = triple(given.entries[key], f"{given.label}.{key}", scope, INERTIA)
    if key == "second_moments":
        first, second, third = second + third, first + third, first + second
    if "products" not in given.entries:
        return diagonal(first, second, third)
    xy, xz, yz = _products(given, scope)
    return first, second, third, xy, xz, yz


def _products(given: Table, scope: Scope) -> Triple:
    value = given.entries["products"]
    if not isinstance(value, list) or len(value) != 3:
        rule = "must be a list of 3 (xy, xz, yz)"
        raise SceneError(f"{given.label}.products {rule}, not {shown(value)}")
    xy, xz, yz = (
        formula(part, f"{given.label}.products.{name}", scope, INERTIA)
        for part, name in zip(value, ("xy", "xz", "yz"), strict=True)
    )
    return xy, xz, yz


def _shaped(given: Table, point: str, symbols: Symbols) -> Part:
    name = word(given.entries["shape"], f"{given.label}.shape", SHAPES)
    scope = constants(symbols)
    if name == "box":
        keys(given, ("shape", "mass", "lengths"), COMMON)
        mass = _positive(given, "mass", MASS, symbols)
        lengths = triple(given.entries["lengths"], f"{given.label}.lengths", scope, LENGTH)
        for length, label in zip(lengths, "xyz", strict=True):
            positive(length, f"{given.label}.lengths.{label}", symbols.parameters)
        return _at_point("principal", box(mass, lengths), mass, _centre(given, scope), None, point)
    return _round(given, name, point, symbols)


def _round(given: Table, name: str, point: str, symbols: Symbols) -> Part:
    """Return a shape with an axis, or a sphere."""
    shape = ROUND[name]
    axes = () if shape.kind == "spherical" else ("axis",)
    about = ("about",) if name == "cone" else ()
    keys(given, ("shape", "mass", *shape.lengths, *axes), (*about, *COMMON))
    mass = _positive(given, "mass", MASS, symbols)
    lengths = {key: _positive(given, key, LENGTH, symbols) for key in shape.lengths}
    axis = _axis(given) if axes else None
    axial = moment(shape.axial, mass, lengths)
    inertia = about_axis(axis, axial, moment(shape.transverse, mass, lengths))
    centre = _centre(given, constants(symbols))
    if word(given.entries.get("about", "centre"), "body.about", ("centre", "apex")) == "apex":
        centre = _from_apex(given, lengths, axis, point)
    return _at_point(shape.kind, inertia, mass, centre, axis, point)


def _from_apex(
    given: Table, lengths: Mapping[str, Formula], axis: Axis | None, point: str
) -> Triple:
    """Return the mass centre of a cone that opens from the point along its positive axis."""
    if point == "centre_of_mass":
        raise SceneError("body.about = 'apex' needs a fixed or moving point, not 'centre_of_mass'")
    if "centre" in given.entries:
        raise SceneError("body.centre follows from body.about = 'apex'; leave it out")
    distance = number(CONE_CENTRE) * lengths["height"]
    x, y, z = (distance if name == axis else ZERO for name in ("x", "y", "z"))
    return x, y, z


def _at_point(
    kind: str,
    inertia: Sextuple,
    mass: Formula,
    centre: Triple | None,
    axis: Axis | None,
    point: str,
) -> Part:
    """Move a shape's inertia to the scene's point, and say what kind of body it is about it."""
    if point == "centre_of_mass":
        return Part(kind, inertia, centre, axis)
    if centre is None:
        raise SceneError(f"a shape about a {point} point needs body.centre, from that point")
    inertia = moved(inertia, mass, centre)
    off = [name for name, length in zip(AXES, centre, strict=True) if length != ZERO]
    if not off or off == [axis]:
        return Part(kind, inertia, centre, axis)
    if any(product != ZERO for product in inertia[3:]):
        return Part("general", inertia, centre, None)
    if kind == "spherical":
        return Part("axisymmetric", inertia, centre, off[0])
    return Part("principal", inertia, centre, None)
