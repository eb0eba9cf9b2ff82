"""The scene file: its tables read into declarations, each by one function.

Every value is checked where it is read (type, unit, range, scalars); what must hold between the
tables is in ``derive.scene.rules``.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Literal, cast

from derive.scene.bodies import Kind, Substance, of_kind, of_shape
from derive.scene.declaration import (
    AXES,
    Axes,
    Body,
    Input,
    Point,
    SceneError,
    Sextuple,
    ShortForm,
    Triple,
    Turning,
    Wheel,
)
from derive.scene.entries import (
    AXES_OF_ONE,
    BODY,
    KNOWN,
    POINT,
    POSITION,
    TIME,
    TIME_STEP,
    WHEEL,
)
from derive.scene.entry import Reading, entries_of
from derive.scene.escape import brief
from derive.scene.formula import ZERO
from derive.scene.names import distinct
from derive.scene.reader import SCALARS, Form, read_file
from derive.scene.scalars import Scalars, of_one_body
from derive.scene.shape import SHAPES, moved
from derive.scene.table import Scope, Table, keys, nearest, shown, table
from derive.scene.unit import ANGULAR_VELOCITY, LENGTH, NONE, VELOCITY, Dimension
from derive.scene.wanted import attitudes_only, read_wanted

ONE_BODY = Form(
    ("body", "axes", "wheels", "point", "known", "position", *SCALARS),
    ("frames", "bodies", "loads"),
    "is for machines: a file that has it needs bodies, not a body",
    (TIME_STEP, TIME),
)


def read_scene(document: dict[str, Any], name: str, source: str) -> ShortForm:
    """Return the scene of a parsed TOML document, checked table by table."""
    if "body" not in document and attitudes_only(document.get("wanted")):
        document["body"] = {"kind": "spherical", "moment": 1}  # nothing asks about it
    head, part = read_file(document, name, source, ONE_BODY)
    scalars = of_one_body(part)
    wheels = _wheels(document.get("wheels", []), scalars)
    distinct(_declared(scalars, wheels))
    scope = _known_with(scalars, wheels)
    axes = _axes(part["axes"], scalars)
    place = entries_of(part["position"], POSITION, Reading()) if "position" in document else {}
    state = _state(axes, "position" in document)
    loads = Scope({**scope.dimensions, **state}, scope.others, scope.rule)
    by = Reading({"motions": scalars.motions, "known": scope, "loads": loads})
    point = _point(part["point"], scope)
    return ShortForm(
        parameters=scalars.parameters,
        coordinates=scalars.coordinates,
        speeds=scalars.speeds,
        inputs=scalars.inputs,
        axes=axes,
        body=_body(part["body"], point.kind, scalars),
        wheels=wheels,
        point=point,
        known=entries_of(part["known"], KNOWN, by),
        position=place.get("position"),
        velocity=place.get("velocity"),
        head={**head, "source": "", "wanted": read_wanted(head["wanted"])},
        warnings=(),
    )


def _axes(given: Table, scalars: Scalars) -> Axes:
    said = entries_of(given, AXES_OF_ONE, Reading(scalars.scopes))
    turned, omega = said["turned"], said["angular_velocity"]
    if turned and omega:
        raise SceneError("axes have both turned and angular_velocity; give one of them")
    _through_coordinates(turned or (), "axes.turned", scalars)
    kind: Literal["body", "turned", "given"] = "body"
    if turned or omega:
        kind = "turned" if turned else "given"
    fixed = said["fixed_in"] is not None or kind == "body"
    return Axes(kind, turned or (), said["attitude"] is not None, fixed, omega)


def _wheels(value: object, scalars: Scalars) -> tuple[Wheel, ...]:
    if not isinstance(value, list):
        raise SceneError(f"wheels must be a list of tables [[wheels]], not {shown(value)}")
    return tuple(_wheel(table(entry, f"wheel {i + 1}"), scalars) for i, entry in enumerate(value))


def _wheel(given: Table, scalars: Scalars) -> Wheel:
    name = given.entries.get("name", "")
    if not isinstance(name, str) or not name.isascii() or not name.isalnum() or len(name) > 20:
        keys(given, [row.key for row in WHEEL], ())
        rule = "name must be up to 20 letters and digits"
        raise SceneError(f"{given.label}: {rule}, not {shown(name)}")
    label = f"wheel '{name}'"
    by = Reading(scalars.scopes, {}, scalars.parameters)
    said = entries_of(Table(label, given.entries), WHEEL, by)
    (slow, fast), (least, most) = said["speed_range"], said["torque_range"]
    speed = Input(f"s_{name}", "rad/s", slow, fast, f"speed of {label} relative to the carrier")
    torque = Input(f"u_{name}", "N m", least, most, f"motor torque on {label} about its axis")
    return Wheel(name, said["axis"], said["axial"], speed, torque)


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


def _body(given: Table, point: str, scalars: Scalars) -> Body:
    """Return the body of a scene, its inertia about the scene's point along its own axes.

    point : the kind of the scene's point; a shape is moved to it unless it is the mass centre
    """
    if ("shape" in given.entries) == ("kind" in given.entries):
        raise SceneError("body needs either a kind or a shape")
    by = Reading(scalars.scopes, {}, scalars.parameters)
    if "shape" in given.entries:
        made = of_shape(given, SHAPES, BODY, by)
        centre = made.said["centre"]
        if made.said.get("about") == "apex":
            centre = _from_apex(made, point)
        made = _at_point(made, centre, point)
    else:
        made = of_kind(given, BODY, by)
        centre = made.said["centre"]
        for key in ("axial", "transverse"):
            if made.kind == "axisymmetric" and made.said[key] is None:
                raise SceneError(f"body needs '{key}'")
    turned, spin = made.said["turned"] or (), made.said["spin"]
    _through_coordinates(turned, "body.turned", scalars)
    return Body(
        cast("Kind", made.kind), made.mass, cast("Sextuple", made.inertia), centre, made.axis,
        turned, spin, made.lengths or {}, made.look,
    )  # fmt: skip


def _from_apex(made: Substance, point: str) -> Triple:
    """Return the mass centre of a cone that opens from the point along its positive axis."""
    if point == "centre_of_mass":
        raise SceneError("body.about = 'apex' needs a fixed or moving point, not 'centre_of_mass'")
    if made.said["centre"] is not None:
        raise SceneError("body.centre follows from body.about = 'apex'; leave it out")
    return made.apex()


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
    said = entries_of(given, POINT, Reading({"known": scope}))
    kind, acceleration = said["kind"], said["acceleration"]
    if kind != "moving" and acceleration is not None:
        raise SceneError(f"point.acceleration needs point.kind = 'moving', not '{kind}'")
    if kind == "moving" and acceleration is None:
        raise SceneError("a moving point needs point.acceleration, a range or three formulas")
    return Point(kind, acceleration)


def _state(axes: Axes, position: bool) -> Mapping[str, Dimension]:  # noqa: FBT001
    """Return the components of the state that a known moment or force may depend on."""
    state = {f"attitude_{part}": NONE for part in "wxyz" if axes.quaternion}
    state |= {f"omega_{part}": ANGULAR_VELOCITY for part in "xyz" if axes.fixed_in_body}
    moving = {"position": LENGTH, "velocity": VELOCITY} if position else {}
    return state | {f"{name}_{part}": unit for name, unit in moving.items() for part in "xyz"}


def _known_with(scalars: Scalars, wheels: tuple[Wheel, ...]) -> Scope:
    """Return the scope of a known vector: what is known with the state, speeds of wheels too."""
    known, speeds = scalars.known, [wheel.speed for wheel in wheels]
    others = {wheel.torque.name: "a motor torque" for wheel in wheels}
    dimensions = {speed.name: ANGULAR_VELOCITY for speed in speeds}
    return Scope({**known.dimensions, **dimensions}, {**known.others, **others}, known.rule)


def _through_coordinates(turned: tuple[Turning, ...], label: str, scalars: Scalars) -> None:
    """Refuse turns of which one is not through a coordinate."""
    known = [c.name for c in scalars.coordinates]
    for turn in turned:
        if turn.coordinate not in known:
            rule = f"turns through '{brief(turn.angle)}', which is no coordinate of the scene"
            raise SceneError(f"{label} {rule}{nearest(str(turn.angle), known)}")
