"""The scene file: its tables read into declarations, each by one function.

Every value is checked where it is read (type, unit, range, symbols); what must hold between the
tables is in ``derive.scene.rules``.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Literal, cast

from derive.scene.body import read_body
from derive.scene.declaration import Axes, Given, Input, Point, Scene, SceneError, Wheel
from derive.scene.names import distinct
from derive.scene.numbers import positive
from derive.scene.symbols import (
    Symbols,
    accelerations,
    anything,
    constants,
    motions,
    rates,
    read_symbols,
    turns,
    with_state,
)
from derive.scene.table import (
    Scope,
    Table,
    formula,
    interval,
    keys,
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
    scalars = ("parameters", "coordinates", "speeds", "inputs")
    symbols = read_symbols(*(part[key] for key in scalars))
    wheels = _wheels(document.get("wheels", []), symbols)
    distinct(_declared(symbols, wheels))
    scope = anything(symbols, wheels)
    point = _point(part["point"], scope)
    axes = _axes(part["axes"], symbols)
    ranges = _position(part["position"]) if "position" in document else (None, None)
    return Scene(
        name=name,
        title=text(document.get("title", name), "title"),
        text=source,
        parameters=symbols.parameters,
        coordinates=symbols.coordinates,
        speeds=symbols.speeds,
        inputs=symbols.inputs,
        axes=axes,
        body=read_body(part["body"], point.kind, symbols),
        wheels=wheels,
        point=point,
        known=_known(part["known"], scope, symbols, _state(axes, "position" in document)),
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


def _axes(given: Table, symbols: Symbols) -> Axes:
    keys(given, (), ("fixed_in", "attitude", "turned", "angular_velocity"))
    entries = given.entries
    if "turned" in entries and "angular_velocity" in entries:
        raise SceneError("axes have both turned and angular_velocity; give one of them")
    fixed = "fixed_in" in entries or not ("turned" in entries or "angular_velocity" in entries)
    word(entries.get("fixed_in", "body"), "axes.fixed_in", ("body",))
    word(entries.get("attitude", "quaternion"), "axes.attitude", ("quaternion",))
    quaternion = "attitude" in entries
    if "turned" in entries:
        turned = turns(entries["turned"], "axes.turned", symbols)
        return Axes("turned", turned, quaternion, fixed, None)
    if "angular_velocity" in entries:
        value, scope = entries["angular_velocity"], motions(symbols)
        omega = triple(value, "axes.angular_velocity", scope, ANGULAR_VELOCITY)
        return Axes("given", (), quaternion, fixed, omega)
    return Axes("body", (), quaternion, fixed_in_body=True, angular_velocity=None)


def _wheels(value: object, symbols: Symbols) -> tuple[Wheel, ...]:
    if not isinstance(value, list):
        raise SceneError(f"wheels must be a list of tables [[wheels]], not {shown(value)}")
    return tuple(_wheel(table(entry, f"wheel {i + 1}"), symbols) for i, entry in enumerate(value))


def _wheel(given: Table, symbols: Symbols) -> Wheel:
    keys(given, ("name", "axis", "axial", "speed_range", "torque_range"), ())
    name = given.entries["name"]
    if not isinstance(name, str) or not name.isascii() or not name.isalnum() or len(name) > 20:
        rule = "name must be up to 20 letters and digits"
        raise SceneError(f"{given.label}: {rule}, not {shown(name)}")
    label, scope = f"wheel '{name}'", constants(symbols)
    axial = formula(given.entries["axial"], f"{label}: axial", scope, INERTIA)
    speed = interval(given.entries["speed_range"], f"{label}: speed_range")
    torque = interval(given.entries["torque_range"], f"{label}: torque_range")
    return Wheel(
        name,
        triple(given.entries["axis"], f"{label}: axis", scope, NONE),
        positive(axial, f"{label}: axial", symbols.parameters),
        Input(f"s_{name}", "rad/s", *speed, f"speed of {label} relative to the carrier"),
        Input(f"u_{name}", "N m", *torque, f"motor torque on {label} about its axis"),
    )


def _declared(symbols: Symbols, wheels: tuple[Wheel, ...]) -> list[tuple[str, str]]:
    """List every name of the scene with what it is, derived ones included."""
    found = [(entry.name, f"parameter '{entry.name}'") for entry in symbols.parameters]
    found += [(entry.name, f"coordinate '{entry.name}'") for entry in symbols.coordinates]
    found += [(entry.name, f"speed '{entry.name}'") for entry in symbols.speeds]
    found += [(entry.name, f"input '{entry.name}'") for entry in symbols.inputs]
    derived = [entry.name for entry in (*rates(symbols), *accelerations(symbols))]
    free = [entry.name for entry in symbols.coordinates if entry.motion == "free"]
    derived += [f"{name}_{dots}" for name in free for dots in ("dot", "ddot", "next")]
    found += [(name, f"the rate '{name}'") for name in derived]
    for wheel in wheels:
        found += [(wheel.speed.name, f"the speed of wheel '{wheel.name}'")]
        found += [(wheel.torque.name, f"the torque on wheel '{wheel.name}'")]
        found += [(f"{wheel.speed.name}_dot", f"the rate of wheel '{wheel.name}'")]
        found += [(f"{wheel.speed.name}_next", f"the next speed of wheel '{wheel.name}'")]
    return found


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
    given: Table, scope: Scope, symbols: Symbols, state: Mapping[str, Dimension]
) -> Mapping[str, Given]:
    keys(given, (), KNOWN)
    result = {}
    for name, (expected, end) in KNOWN.items():
        allowed = motions(symbols) if name == "angular_velocity" else scope
        if name in given.entries:
            wider = with_state(allowed, state) if name in ("moment", "force") else allowed
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
