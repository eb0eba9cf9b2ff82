"""The scalars of a scene: parameters, coordinates, speeds, their rates, and who may use them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, cast

from derive.scene.declaration import (
    Axis,
    Coordinate,
    Input,
    Parameter,
    SceneError,
    Speed,
    Turn,
    Wheel,
)
from derive.scene.names import identifier
from derive.scene.table import (
    Scope,
    Table,
    interval,
    keys,
    nearest,
    rational,
    shown,
    table,
    text,
    unit,
    word,
)
from derive.scene.unit import ANGULAR_VELOCITY, NONE, Dimension, dimension, spelled

if TYPE_CHECKING:
    from collections.abc import Mapping

Scalar = Parameter | Coordinate | Speed | Input
Motion = Literal["free", "prescribed"]
MOTIONS: tuple[Motion, ...] = ("free", "prescribed")


@dataclass(frozen=True)
class Symbols:
    """The scalars that a scene declares, in the order of the file."""

    parameters: tuple[Parameter, ...]
    coordinates: tuple[Coordinate, ...]
    speeds: tuple[Speed, ...]
    inputs: tuple[Input, ...]


def read_symbols(parameters: Table, coordinates: Table, speeds: Table, inputs: Table) -> Symbols:
    """Return the scalars declared in the four tables."""
    return Symbols(
        tuple(_parameter(*entry) for entry in _entries(parameters, "parameter")),
        tuple(_coordinate(*entry) for entry in _entries(coordinates, "coordinate")),
        tuple(_speed(*entry) for entry in _entries(speeds, "speed")),
        tuple(_input(*entry) for entry in _entries(inputs, "input")),
    )


def _entries(given: Table, kind: str) -> list[tuple[str, Table]]:
    return [
        (identifier(name, f"a {kind}"), table(value, f"{kind} '{name}'"))
        for name, value in given.entries.items()
    ]


def _parameter(name: str, given: Table) -> Parameter:
    keys(given, ("unit",), ("range", "value", "meaning"))
    unit(given)
    if ("range" in given.entries) == ("value" in given.entries):
        raise SceneError(f"{given.label} needs either a range or a value")
    spelling, meaning = str(given.entries["unit"]), _meaning(given)
    if "value" in given.entries:
        value = rational(given.entries["value"], f"{given.label}: value")
        return Parameter(name, spelling, value, value, meaning, value)
    low, high = interval(given.entries["range"], f"{given.label}: range")
    return Parameter(name, spelling, low, high, meaning, None)


def _meaning(given: Table) -> str:
    value = given.entries.get("meaning")
    return "" if value is None else text(value, f"{given.label}: meaning")


def _coordinate(name: str, given: Table) -> Coordinate:
    keys(given, ("unit", "range"), ("meaning", "motion", "rate", "acceleration"))
    _require_unit(given, NONE, "rad")
    low, high = interval(given.entries["range"], f"{given.label}: range")
    motion = word(given.entries.get("motion", "free"), f"{given.label}: motion", MOTIONS)
    rate, acceleration = _derivatives(name, given, motion)
    meaning, kept = _meaning(given), cast("Motion", motion)
    return Coordinate(name, "rad", low, high, meaning, kept, rate, acceleration)


def _derivatives(name: str, given: Table, motion: str) -> tuple[Input | None, Input | None]:
    if motion == "free":
        for key in ("rate", "acceleration"):
            if key in given.entries:
                raise SceneError(f"{given.label} is free, so its {key} is found, not given")
        return None, None
    rate = _rate(given, "rate", f"{name}_dot", "rad/s")
    if rate is None:
        if "acceleration" in given.entries and given.entries["acceleration"] != 0:
            raise SceneError(f"{given.label} has rate 0, so its acceleration cannot be given")
        return None, None
    return rate, _rate(given, "acceleration", f"{name}_ddot", "rad/s^2")


def _rate(given: Table, key: str, name: str, spelling: str) -> Input | None:
    """Return the input that a rate is; None where it is given as 0."""
    value = given.entries.get(key)
    if isinstance(value, dict):
        inner = Table(f"{given.label}: {key}", value)
        keys(inner, ("range",), ("meaning",))
        low, high = interval(inner.entries["range"], f"{inner.label}: range")
        return Input(name, spelling, low, high, _meaning(inner))
    if value is None or rational(value, f"{given.label}: {key}") != 0:
        found = "" if value is None else f", not {shown(value)}"
        rule = f"needs {key} = {{ range = [low, high] }} or {key} = 0"
        raise SceneError(f"{given.label} {rule}{found}")
    return None


def _speed(name: str, given: Table) -> Speed:
    keys(given, ("unit", "range"), ("meaning", "rate"))
    _require_unit(given, ANGULAR_VELOCITY, "rad/s")
    low, high = interval(given.entries["range"], f"{given.label}: range")
    rate = _rate(given, "rate", f"{name}_dot", "rad/s^2")
    return Speed(name, "rad/s", low, high, _meaning(given), rate)


def _input(name: str, given: Table) -> Input:
    keys(given, ("unit", "range"), ("meaning",))
    unit(given)
    low, high = interval(given.entries["range"], f"{given.label}: range")
    return Input(name, str(given.entries["unit"]), low, high, _meaning(given))


def _require_unit(given: Table, expected: Dimension, spelling: str) -> None:
    if unit(given) != expected:
        raise SceneError(f"{given.label} must be in {spelling}, not {spelled(unit(given))}")


def turns(value: object, label: str, symbols: Symbols) -> tuple[Turn, ...]:
    """Return the turns of a list such as ["z psi", "x theta"]."""
    if not isinstance(value, list) or not value:
        raise SceneError(f"{label} must be a list such as ['z psi'], not {shown(value)}")
    return tuple(_turn(entry, label, symbols) for entry in value)


def _turn(entry: object, label: str, symbols: Symbols) -> Turn:
    parts = entry.split() if isinstance(entry, str) else []
    if len(parts) != 2 or parts[0] not in ("x", "y", "z"):
        rule = "a turn is an axis and a coordinate, as 'z psi'"
        raise SceneError(f"{label}: {rule}, not {shown(entry)}")
    known = [coordinate.name for coordinate in symbols.coordinates]
    if parts[1] not in known:
        rule = f"turns through '{parts[1]}', which is no coordinate of the scene"
        raise SceneError(f"{label} {rule}{nearest(parts[1], known)}")
    return Turn(cast("Axis", parts[0]), parts[1])


def rates(symbols: Symbols) -> tuple[Input, ...]:
    """Return the inputs that are rates of prescribed coordinates."""
    return tuple(coordinate.rate for coordinate in symbols.coordinates if coordinate.rate)


def accelerations(symbols: Symbols) -> tuple[Input, ...]:
    """Return the inputs that are accelerations of coordinates or rates of speeds."""
    found = [coordinate.acceleration for coordinate in symbols.coordinates]
    return tuple(entry for entry in (*found, *(speed.rate for speed in symbols.speeds)) if entry)


def constants(symbols: Symbols) -> Scope:
    """Return the scope of what a rigid body keeps: parameters only."""
    others = {
        **{entry.name: "a coordinate" for entry in symbols.coordinates},
        **{entry.name: "a speed" for entry in symbols.speeds},
        **{entry.name: "an input" for entry in symbols.inputs},
        **{entry.name: "a rate" for entry in (*rates(symbols), *accelerations(symbols))},
    }
    dimensions = {entry.name: dimension(entry.unit) for entry in symbols.parameters}
    return Scope(dimensions, others, "only parameters may stand here")


def motions(symbols: Symbols) -> Scope:
    """Return the scope of a prescribed angular velocity: what has a known rate."""
    usable = [entry for entry in symbols.coordinates if entry.motion == "prescribed"]
    free = [entry for entry in symbols.coordinates if entry.motion == "free"]
    others = {
        **{entry.name: "a free coordinate" for entry in free},
        **{entry.name: "an acceleration" for entry in accelerations(symbols)},
        **{entry.name: "an input, whose rate is not known" for entry in symbols.inputs},
    }
    rule = "only parameters, speeds, prescribed coordinates and their rates may stand here"
    scalars: tuple[Scalar, ...] = (*symbols.parameters, *usable, *symbols.speeds, *rates(symbols))
    return Scope(_dimensions(scalars), others, rule)


def anything(symbols: Symbols, wheels: tuple[Wheel, ...]) -> Scope:
    """Return the scope of a known force or moment: every scalar that is known with the state."""
    free = [entry.name for entry in symbols.coordinates if entry.motion == "free"]
    others = {
        **{f"{name}_dot": "the rate of a free coordinate" for name in free},
        **{wheel.torque.name: "a motor torque" for wheel in wheels},
    }
    scalars: tuple[Scalar, ...] = (
        *symbols.parameters,
        *symbols.coordinates,
        *symbols.speeds,
        *rates(symbols),
        *accelerations(symbols),
        *symbols.inputs,
        *(wheel.speed for wheel in wheels),
    )
    rule = "a known vector is a formula of parameters, coordinates, speeds, inputs and given rates"
    return Scope(_dimensions(scalars), others, rule)


def with_state(scope: Scope, state: Mapping[str, Dimension]) -> Scope:
    """Return the scope of a moment or force that depends on components of the state."""
    return Scope({**scope.dimensions, **state}, scope.others, scope.rule)


def _dimensions(scalars: tuple[Scalar, ...]) -> Mapping[str, Dimension]:
    return {entry.name: dimension(entry.unit) for entry in scalars}
