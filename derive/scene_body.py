"""The body of a scene: its kind or shape read into six formulas about the scene's point."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, cast

from derive.declaration import Axis, Body, SceneError, Sextuple, Triple
from derive.formula import ZERO, Formula, number
from derive.scene_symbols import Symbols, constants, motions, turns
from derive.scene_table import Scope, Table, formula, keys, shown, triple, word
from derive.shape import (
    CONE_CENTRE,
    SHAPES,
    about_axis,
    apex_transverse,
    axial_and_transverse,
    box,
    diagonal,
    moved,
)
from derive.unit import ANGULAR_VELOCITY, INERTIA, LENGTH, MASS

Kind = Literal["general", "principal", "axisymmetric", "spherical", "rod"]
KINDS: Mapping[str, tuple[str, ...]] = {
    "general": ("products",),
    "principal": (),
    "axisymmetric": ("axis", "axial", "transverse"),
    "spherical": ("moment",),
    "rod": ("axis", "moment"),
}
"""What each kind of body must say; general and principal ones also their moments."""
COMMON = ("mass", "centre", "turned", "spin")


def read_body(given: Table, point: str, symbols: Symbols) -> Body:
    """Return the body, its inertia about the scene's point along its own axes.

    point : the kind of the scene's point; a shape is moved to it unless it is the mass centre
    """
    scope = constants(symbols)
    if ("shape" in given.entries) == ("kind" in given.entries):
        raise SceneError("body needs either a kind or a shape")
    mass = _optional(given, "mass", scope)
    if "shape" in given.entries:
        kind, inertia, centre, axis = _shaped(given, point, scope)
    else:
        kind, inertia, axis = _of_kind(given, scope)
        centre = _centre(given, scope)
    turned = turns(given.entries["turned"], "body.turned", symbols) if "turned" in given.entries else ()
    spin = None
    if "spin" in given.entries:
        spin = formula(given.entries["spin"], "body.spin", motions(symbols), ANGULAR_VELOCITY)
    return Body(kind, mass, inertia, centre, axis, turned, spin)


def _optional(given: Table, key: str, scope: Scope) -> Formula | None:
    return formula(given.entries[key], f"body.{key}", scope, MASS) if key in given.entries else None


def _centre(given: Table, scope: Scope) -> Triple | None:
    if "centre" not in given.entries:
        return None
    return triple(given.entries["centre"], "body.centre", scope, LENGTH)


def _axis(given: Table) -> Axis:
    return cast(Axis, word(given.entries["axis"], "body.axis", ("x", "y", "z")))


def _moment(given: Table, key: str, scope: Scope) -> Formula:
    return formula(given.entries[key], f"body.{key}", scope, INERTIA)


def _of_kind(given: Table, scope: Scope) -> tuple[Kind, Sextuple, Axis | None]:
    kind = cast(Kind, word(given.entries["kind"], "body.kind", KINDS))
    three = ("moments", "second_moments") if kind in ("general", "principal") else ()
    keys(given, ("kind", *KINDS[kind]), (*three, *COMMON))
    if three:
        return kind, _three_moments(given, scope), None
    if kind == "spherical":
        moment = _moment(given, "moment", scope)
        return kind, diagonal(moment, moment, moment), None
    axis = _axis(given)
    if kind == "rod":
        return kind, about_axis(axis, ZERO, _moment(given, "moment", scope)), axis
    axial, transverse = _moment(given, "axial", scope), _moment(given, "transverse", scope)
    return kind, about_axis(axis, axial, transverse), axis


def _three_moments(given: Table, scope: Scope) -> Sextuple:
    if ("moments" in given.entries) == ("second_moments" in given.entries):
        raise SceneError("body needs either moments or second_moments")
    key = "moments" if "moments" in given.entries else "second_moments"
    first, second, third = triple(given.entries[key], f"body.{key}", scope, INERTIA)
    if key == "second_moments":
        first, second, third = second + third, first + third, first + second
    if "products" not in given.entries:
        return diagonal(first, second, third)
    xy, xz, yz = _products(given, scope)
    return first, second, third, xy, xz, yz


def _products(given: Table, scope: Scope) -> Triple:
    value = given.entries["products"]
    if not isinstance(value, list) or len(value) != 3:
        raise SceneError(f"body.products must be a list of 3 (xy, xz, yz), not {shown(value)}")
    xy, xz, yz = (
        formula(part, f"body.products.{name}", scope, INERTIA)
        for part, name in zip(value, ("xy", "xz", "yz"), strict=True)
    )
    return xy, xz, yz


def _shaped(given: Table, point: str, scope: Scope) -> tuple[Kind, Sextuple, Triple | None, Axis | None]:
    name = word(given.entries["shape"], "body.shape", SHAPES)
    shape = SHAPES[name]
    about = ("about",) if name == "cone" else ()
    axes = ("axis",) if shape.has_axis else ()
    keys(given, ("shape", "mass", *shape.lengths, *axes), (*about, *COMMON))
    mass = formula(given.entries["mass"], "body.mass", scope, MASS)
    axis = _axis(given) if shape.has_axis else None
    if name == "box":
        inertia = box(mass, triple(given.entries["lengths"], "body.lengths", scope, LENGTH))
        return _at_point(shape.kind, inertia, mass, _centre(given, scope), None, point)
    lengths = {
        key: formula(given.entries[key], f"body.{key}", scope, LENGTH) for key in shape.lengths
    }
    if word(given.entries.get("about", "centre"), "body.about", ("centre", "apex")) == "apex":
        return _cone_about_apex(given, mass, lengths, cast(Axis, axis), point)
    axial, transverse = axial_and_transverse(name, mass, lengths)
    inertia = about_axis(axis, axial, transverse) if axis else diagonal(axial, axial, axial)
    return _at_point(shape.kind, inertia, mass, _centre(given, scope), axis, point)


def _cone_about_apex(
    given: Table, mass: Formula, lengths: Mapping[str, Formula], axis: Axis, point: str
) -> tuple[Kind, Sextuple, Triple | None, Axis | None]:
    """Return a cone that opens from the scene's point along its positive axis."""
    if point == "centre_of_mass":
        raise SceneError("body.about = 'apex' needs a fixed or moving point, not 'centre_of_mass'")
    if "centre" in given.entries:
        raise SceneError("body.centre follows from body.about = 'apex'; leave it out")
    axial, _ = axial_and_transverse("cone", mass, lengths)
    distance = number(CONE_CENTRE) * lengths["height"]
    x, y, z = (distance if name == axis else ZERO for name in "xyz")
    inertia = about_axis(axis, axial, apex_transverse(mass, lengths))
    return "axisymmetric", inertia, (x, y, z), axis


def _at_point(
    kind: str, inertia: Sextuple, mass: Formula, centre: Triple | None, axis: Axis | None, point: str
) -> tuple[Kind, Sextuple, Triple | None, Axis | None]:
    """Move a shape's inertia to the scene's point, and say what kind of body it is about it."""
    if point == "centre_of_mass" or centre is None:
        return cast(Kind, kind), inertia, centre, axis
    inertia = moved(inertia, mass, centre)
    off = [name for name, length in zip("xyz", centre, strict=True) if length != ZERO]
    if not off or (axis and off == [axis]):
        return cast(Kind, kind), inertia, centre, axis
    if any(product != ZERO for product in inertia[3:]):
        return "general", inertia, centre, None
    if kind == "spherical":
        return "axisymmetric", inertia, centre, cast(Axis, off[0])
    return "principal", inertia, centre, None
