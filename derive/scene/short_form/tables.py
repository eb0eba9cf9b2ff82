"""The tables of the short form read into declarations, each by one function.

Every value is checked where it is read (type, unit, range, scalars); what must hold between the
tables is in ``derive.scene.short_form.rules``.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Literal

from derive.scene.declaration import Input, SceneError
from derive.scene.entries import AXES_OF_ONE, COLUMN, KNOWN, POINT, POSITION, TIME, TIME_STEP, WHEEL
from derive.scene.entry import Reading, entries_of
from derive.scene.named import check_named, widened
from derive.scene.names import distinct
from derive.scene.reader import SCALARS, Form, read_file
from derive.scene.scalars import UNITS, Scalars, read_scalars
from derive.scene.scope import Scope
from derive.scene.short_form.body import read_body, through_coordinates
from derive.scene.short_form.declared import Axes, Point, ShortForm, Wheel
from derive.scene.table import Table, keys, shown, table
from derive.scene.unit import ANGULAR_VELOCITY, LENGTH, NONE, VELOCITY, Dimension
from derive.scene.wanted import EQUATIONS, WANTED, attitudes_only, resembling

ONE_BODY = Form(
    ("body", "axes", "wheels", "point", "known", "position", *SCALARS),
    ("frames", "bodies", "loads"),
    "is for machines: a file that has it needs bodies, not a body",
    (TIME_STEP, TIME, COLUMN),
)


def read_scene(document: dict[str, Any], name: str, source: str) -> ShortForm:
    """Return the scene of a parsed TOML document, checked table by table."""
    if "body" not in document and attitudes_only(document.get("wanted")):
        document["body"] = {"kind": "spherical", "moment": 1}  # nothing asks about it
    head, part = read_file(document, name, source, ONE_BODY)
    scalars = _scalars(part)
    wheels = _wheels(document.get("wheels", []), scalars)
    distinct(_declared(scalars, wheels))
    scope = _known_with(scalars, wheels)
    axes = _axes(part["axes"], scalars)
    place = entries_of(part["position"], POSITION, Reading()) if "position" in document else {}
    state = _state(axes, "position" in document)
    widest = replace(scope, dimensions={**scope.dimensions, **state})
    loads = widened(widest, scalars.named)
    check_named(scalars.named, loads)
    by = Reading({"motions": scalars.motions, "known": scope, "loads": loads})
    point = _point(part["point"], scope)
    return ShortForm(
        parameters=scalars.parameters,
        coordinates=scalars.coordinates,
        speeds=scalars.speeds,
        inputs=scalars.inputs,
        axes=axes,
        body=read_body(part["body"], point.kind, scalars),
        wheels=wheels,
        point=point,
        known=entries_of(part["known"], KNOWN, by),
        position=place.get("position"),
        velocity=place.get("velocity"),
        named=scalars.named,
        head={**head, "source": "", "wanted": _wanted(head["wanted"])},
        warnings=(),
    )


def _axes(given: Table, scalars: Scalars) -> Axes:
    said = entries_of(given, AXES_OF_ONE, Reading(scalars.scopes))
    turned, omega = said["turned"], said["angular_velocity"]
    if turned and omega:
        raise SceneError("axes have both turned and angular_velocity; give one of them")
    through_coordinates(turned or (), "axes.turned", scalars)
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
    both = Scope({**known.dimensions, **dimensions}, {**known.others, **others}, known.rule)
    return widened(both, scalars.named)


def _scalars(part: Mapping[str, Table]) -> Scalars:
    """Return the scalars of a single body: angles, free unless they say more, and given speeds.

    The rate of a free angle follows from the angular velocity of the body.
    """
    written = dict(part)
    found = {}
    for name, value in part["coordinates"].entries.items():
        entries = {"motion": "free", **table(value, f"coordinate '{name}'").entries}
        given = [key for key in ("rate", "acceleration") if key in entries]
        if entries["motion"] == "free" and given:
            rule = f"is free, so its {given[0]} is found, not given"
            raise SceneError(f"coordinate '{name}' {rule}")
        found[name] = entries
    written["coordinates"] = Table("coordinates", found)
    scalars = read_scalars(written)
    for m in (*scalars.coordinates, *scalars.speeds):
        if m.unit != UNITS[m.kind][0]:
            raise SceneError(f"{m.kind} '{m.name}' must be in {UNITS[m.kind][0]}, not {m.unit}")
        if m.free and m.kind == "speed":
            rule = "needs rate = { range = [low, high] } or rate = 0"
            raise SceneError(f"speed '{m.name}' {rule}")
    angles = tuple(replace(c, rate=None) if c.free else c for c in scalars.coordinates)
    return replace(scalars, coordinates=angles)


def _wanted(value: object) -> tuple[str, ...]:
    """Return the wanted functions of a scene file."""
    if not isinstance(value, list) or not value:
        raise SceneError(f"wanted must be a list of at least one function, not {shown(value)}")
    for name in value:
        if not isinstance(name, str) or name not in WANTED:
            hint = resembling(name, WANTED) if isinstance(name, str) else ""
            more = "and more in docs/scenes.md and docs/motion.md"
            hint = hint or f" (known: {', '.join(EQUATIONS)}, {more})"
            raise SceneError(f"wanted has {shown(name)}, which is no function{hint}")
        if value.count(name) > 1:
            raise SceneError(f"wanted has '{name}' twice")
    return tuple(value)
