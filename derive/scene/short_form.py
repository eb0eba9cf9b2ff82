"""The scene file: its tables read into declarations, each by one function.

Every value is checked where it is read (type, unit, range, scalars); what must hold between the
tables is in ``derive.scene.rules``.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Literal, cast

from derive.scene.bodies import (
    AXES,
    COMMON,
    KINDS,
    BodyTable,
    Kind,
    Substance,
    apex,
    of_kind,
    of_shape,
)
from derive.scene.declaration import (
    Axes,
    Body,
    Given,
    Input,
    Point,
    Scene,
    SceneError,
    Sextuple,
    Triple,
    Turning,
    Wheel,
)
from derive.scene.escape import brief
from derive.scene.formula import ZERO
from derive.scene.names import distinct
from derive.scene.numbers import positive
from derive.scene.scalars import Scalars, of_one_body, turnings
from derive.scene.shape import SHAPES, moved
from derive.scene.table import (
    Scope,
    Table,
    formula,
    interval,
    keys,
    nearest,
    shown,
    table,
    text,
    triple,
    word,
)
from derive.scene.times import TIMES, read_time
from derive.scene.unit import (
    ACCELERATION,
    ANGULAR_ACCELERATION,
    ANGULAR_VELOCITY,
    FORCE,
    INERTIA,
    LENGTH,
    MOMENT,
    NONE,
    VELOCITY,
    Dimension,
)
from derive.scene.wanted import attitudes_only, read_emission, read_form, read_wanted

if TYPE_CHECKING:
    from collections.abc import Mapping

TABLES = (
    *("parameters", "coordinates", "speeds", "inputs", "axes", "body", "point", "known"),
    *("position", "motion"),
)
LATER = ("frames", "bodies", "loads")
KNOWN: Mapping[str, tuple[Dimension, int]] = {
    "angular_velocity": (ANGULAR_VELOCITY, 10),
    "angular_acceleration": (ANGULAR_ACCELERATION, 50),
    "moment": (MOMENT, 1),
    "force": (FORCE, 10),
}
"""Dimension of each known vector, and the end of its range where none is given."""
PointKind = Literal["centre_of_mass", "fixed", "moving"]
POINTS: tuple[PointKind, ...] = ("centre_of_mass", "fixed", "moving")


def read_scene(document: dict[str, object], name: str, source: str) -> Scene:
    """Return the scene of a parsed TOML document, checked table by table."""
    _top_level(document)
    part = {key: table(document.get(key, {}), key) for key in TABLES}
    keys(part["motion"], (), tuple(TIMES))
    scalars = of_one_body(part)
    wheels = _wheels(document.get("wheels", []), scalars)
    distinct(_declared(scalars, wheels))
    scope = _known_with(scalars, wheels)
    point = _point(part["point"], scope)
    axes = _axes(part["axes"], scalars)
    ranges = _position(part["position"]) if "position" in document else (None, None)
    return Scene(
        name=name,
        title=text(document.get("title", name), "title"),
        text=source,
        parameters=scalars.parameters,
        coordinates=scalars.coordinates,
        speeds=scalars.speeds,
        inputs=scalars.inputs,
        axes=axes,
        body=_body(part["body"], point.kind, scalars),
        wheels=wheels,
        point=point,
        known=_known(part["known"], scope, scalars, _state(axes, "position" in document)),
        position=ranges[0],
        velocity=ranges[1],
        wanted=read_wanted(document["wanted"]),
        form=read_form(document),
        emission=read_emission(document),
        time_step=read_time(part["motion"], "time_step"),
        time=read_time(part["motion"], "time"),
        warnings=(),
    )


def _top_level(document: dict[str, object]) -> None:
    for key in document:
        if key in LATER:
            rule = "is for machines: a file that has it needs bodies, not a body"
            raise SceneError(f"table '{key}' {rule}")
    if "wanted" not in document:
        raise SceneError("the file needs 'wanted', above its first [table]")
    if "body" not in document and attitudes_only(document["wanted"]):
        document["body"] = {"kind": "spherical", "moment": 1}  # nothing asks about it
    said = ("title", "source", "form", "emission")
    optional = (*(name for name in TABLES if name != "body"), "wheels", *said)
    keys(Table("the file", document), ("wanted", "body"), optional)


def _axes(given: Table, scalars: Scalars) -> Axes:
    keys(given, (), ("fixed_in", "attitude", "turned", "angular_velocity"))
    entries = given.entries
    if "turned" in entries and "angular_velocity" in entries:
        raise SceneError("axes have both turned and angular_velocity; give one of them")
    fixed = "fixed_in" in entries or not ("turned" in entries or "angular_velocity" in entries)
    word(entries.get("fixed_in", "body"), "axes.fixed_in", ("body",))
    word(entries.get("attitude", "quaternion"), "axes.attitude", ("quaternion",))
    quaternion = "attitude" in entries
    if "turned" in entries:
        turned = _angles(entries["turned"], "axes.turned", scalars)
        return Axes("turned", turned, quaternion, fixed, None)
    if "angular_velocity" in entries:
        value, scope = entries["angular_velocity"], scalars.motions
        omega = triple(value, "axes.angular_velocity", scope, ANGULAR_VELOCITY)
        return Axes("given", (), quaternion, fixed, omega)
    return Axes("body", (), quaternion, fixed_in_body=True, angular_velocity=None)


def _wheels(value: object, scalars: Scalars) -> tuple[Wheel, ...]:
    if not isinstance(value, list):
        raise SceneError(f"wheels must be a list of tables [[wheels]], not {shown(value)}")
    return tuple(_wheel(table(entry, f"wheel {i + 1}"), scalars) for i, entry in enumerate(value))


def _wheel(given: Table, scalars: Scalars) -> Wheel:
    keys(given, ("name", "axis", "axial", "speed_range", "torque_range"), ())
    name = given.entries["name"]
    if not isinstance(name, str) or not name.isascii() or not name.isalnum() or len(name) > 20:
        rule = "name must be up to 20 letters and digits"
        raise SceneError(f"{given.label}: {rule}, not {shown(name)}")
    label, scope = f"wheel '{name}'", scalars.constants
    axial = formula(given.entries["axial"], f"{label}: axial", scope, INERTIA)
    speed = interval(given.entries["speed_range"], f"{label}: speed_range")
    torque = interval(given.entries["torque_range"], f"{label}: torque_range")
    return Wheel(
        name,
        triple(given.entries["axis"], f"{label}: axis", scope, NONE),
        positive(axial, f"{label}: axial", scalars.parameters),
        Input(f"s_{name}", "rad/s", *speed, f"speed of {label} relative to the carrier"),
        Input(f"u_{name}", "N m", *torque, f"motor torque on {label} about its axis"),
    )


def _declared(scalars: Scalars, wheels: tuple[Wheel, ...]) -> list[tuple[str, str]]:
    """List every name of the scene with what it is, derived ones included."""
    found = scalars.declared
    free = [c.name for c in scalars.coordinates if c.free]
    found += [(f"{n}_{end}", f"the rate '{n}_{end}'") for n in free for end in ("dot", "next")]
    for wheel in wheels:
        found += [(wheel.speed.name, f"the speed of wheel '{wheel.name}'")]
        found += [(wheel.torque.name, f"the torque on wheel '{wheel.name}'")]
        found += [(f"{wheel.speed.name}_dot", f"the rate of wheel '{wheel.name}'")]
        found += [(f"{wheel.speed.name}_next", f"the next speed of wheel '{wheel.name}'")]
    return found


def _body(table: Table, point: str, scalars: Scalars) -> Body:
    """Return the body of a scene, its inertia about the scene's point along its own axes.

    point : the kind of the scene's point; a shape is moved to it unless it is the mass centre
    """
    given = BodyTable(table, scalars)
    if given.has("shape") == given.has("kind"):
        raise SceneError("body needs either a kind or a shape")
    centre = None
    if given.has("shape"):
        made = of_shape(given, SHAPES, COMMON)
        if given.has("centre"):
            centre = given.three("centre", LENGTH)
        if word(table.entries.get("about", "centre"), "body.about", ("centre", "apex")) == "apex":
            centre = _fromapex(given, made, point)
        made = _at_point(made, centre, point)
    else:
        made = of_kind(given, KINDS, COMMON)
        if given.has("centre"):
            centre = given.three("centre", LENGTH)
    turned: tuple[Turning, ...] = ()
    if given.has("turned"):
        turned = _angles(table.entries["turned"], "body.turned", scalars)
    return Body(
        cast("Kind", made.kind), given.mass(), cast("Sextuple", made.inertia), centre, made.axis,
        turned, given.moves("spin"), given.lengths(),
    )  # fmt: skip


def _fromapex(given: BodyTable, made: Substance, point: str) -> Triple:
    """Return the mass centre of a cone that opens from the point along its positive axis."""
    if point == "centre_of_mass":
        raise SceneError("body.about = 'apex' needs a fixed or moving point, not 'centre_of_mass'")
    if given.has("centre"):
        raise SceneError("body.centre follows from body.about = 'apex'; leave it out")
    return apex(given, made)


def _at_point(made: Substance, centre: Triple | None, point: str) -> Substance:
    """Move a shape's inertia to the scene's point, and say what kind of body it is about it."""
    if point == "centre_of_mass":
        return made
    if centre is None:
        raise SceneError(f"a shape about a {point} point needs body.centre, from that point")
    assert made.mass is not None  # noqa: S101 - every shape says its mass
    inertia = moved(cast("Sextuple", made.inertia), made.mass, centre)
    off = [name for name, length in zip(AXES, centre, strict=True) if length != ZERO]
    if not off or off == [made.axis]:
        return replace(made, inertia=inertia)
    if any(product != ZERO for product in inertia[3:]):
        return replace(made, kind="general", inertia=inertia, axis=None)
    if made.kind == "spherical":
        return replace(made, kind="axisymmetric", inertia=inertia, axis=off[0])
    return replace(made, kind="principal", inertia=inertia, axis=None)


def _point(given: Table, scope: Scope) -> Point:
    keys(given, (), ("kind", "acceleration"))
    kind = cast("PointKind", word(given.entries.get("kind", POINTS[0]), "point.kind", POINTS))
    if kind != "moving":
        if "acceleration" in given.entries:
            raise SceneError(f"point.acceleration needs point.kind = 'moving', not '{kind}'")
        return Point(kind, None)
    if "acceleration" not in given.entries:
        raise SceneError("a moving point needs point.acceleration, a range or three formulas")
    value = given.entries["acceleration"]
    return Point("moving", _given(value, "point.acceleration", scope, ACCELERATION))


def _given(value: object, label: str, scope: Scope, expected: Dimension) -> Given:
    if isinstance(value, list):
        return Given(None, None, triple(value, label, scope, expected))
    if not isinstance(value, dict):
        rule = "must be { range = [low, high] } or three formulas"
        raise SceneError(f"{label} {rule}, not {shown(value)}")
    inner = table(value, label)
    keys(inner, ("range",), ())
    return Given(*interval(inner.entries["range"], f"{label}.range"), None)


def _state(axes: Axes, position: bool) -> Mapping[str, Dimension]:  # noqa: FBT001
    """Return the components of the state that a known moment or force may depend on."""
    state = {f"attitude_{part}": NONE for part in "wxyz" if axes.quaternion}
    state |= {f"omega_{part}": ANGULAR_VELOCITY for part in "xyz" if axes.fixed_in_body}
    moving = {"position": LENGTH, "velocity": VELOCITY} if position else {}
    return state | {f"{name}_{part}": unit for name, unit in moving.items() for part in "xyz"}


def _known(
    given: Table, scope: Scope, scalars: Scalars, state: Mapping[str, Dimension]
) -> Mapping[str, Given]:
    keys(given, (), KNOWN)
    result = {}
    for name, (expected, end) in KNOWN.items():
        allowed = scalars.motions if name == "angular_velocity" else scope
        if name in given.entries:
            wider = _wider(allowed, state) if name in ("moment", "force") else allowed
            result[name] = _given(given.entries[name], f"known.{name}", wider, expected)
        else:
            result[name] = Given(Fraction(-end), Fraction(end), None)
    return result


def _position(given: Table) -> tuple[Given, Given]:
    keys(given, ("position", "velocity"), ())
    found = []
    for key in ("position", "velocity"):
        if isinstance(given.entries[key], list):
            raise SceneError(f"position.{key} must be {{ range = [low, high] }}, not formulas")
        found.append(_given(given.entries[key], f"position.{key}", Scope({}, {}, ""), NONE))
    return found[0], found[1]


def _angles(value: object, label: str, scalars: Scalars) -> tuple[Turning, ...]:
    """Return turns of which each is through a coordinate."""
    turned, known = turnings(value, label, scalars.places), [c.name for c in scalars.coordinates]
    for turn in turned:
        if turn.coordinate not in known:
            rule = f"turns through '{brief(turn.angle)}', which is no coordinate of the scene"
            raise SceneError(f"{label} {rule}{nearest(str(turn.angle), known)}")
    return turned


def _known_with(scalars: Scalars, wheels: tuple[Wheel, ...]) -> Scope:
    """Return the scope of a known vector: what is known with the state, speeds of wheels too."""
    known, speeds = scalars.known, [wheel.speed for wheel in wheels]
    others = {wheel.torque.name: "a motor torque" for wheel in wheels}
    dimensions = {speed.name: ANGULAR_VELOCITY for speed in speeds}
    return Scope({**known.dimensions, **dimensions}, {**known.others, **others}, known.rule)


def _wider(scope: Scope, state: Mapping[str, Dimension]) -> Scope:
    """Return the scope of a moment or force that depends on components of the state."""
    return Scope({**scope.dimensions, **state}, scope.others, scope.rule)
