"""The scalars of a machine that move: coordinates, speeds and inputs, and who may use them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, cast

from derive.scene.declaration import Axis, Input, Parameter, SceneError
from derive.scene.formula import ZERO, Formula
from derive.scene.machine import Moving, Turning
from derive.scene.names import identifier
from derive.scene.numbers import middle
from derive.scene.symbols import read_symbols
from derive.scene.table import Scope, Table, formula, interval, keys, shown, table, text, word
from derive.scene.table import unit as unit_of
from derive.scene.unit import (
    ANGULAR_VELOCITY,
    LENGTH,
    NONE,
    VELOCITY,
    Dimension,
    dimension,
    spelled,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

UNITS = {"coordinate": ("rad", "m"), "speed": ("rad/s", "m/s")}
DIMENSIONS = {"coordinate": (NONE, LENGTH), "speed": (ANGULAR_VELOCITY, VELOCITY)}
ARTICLE = {"coordinate": "a", "speed": "a", "input": "an"}
PER_SECOND = {"rad": "rad/s", "m": "m/s", "rad/s": "rad/s^2", "m/s": "m/s^2"}


@dataclass(frozen=True)
class Scalars:
    """The scalars of a machine, in the order of the file."""

    parameters: tuple[Parameter, ...]
    coordinates: tuple[Moving, ...]
    speeds: tuple[Moving, ...]
    inputs: tuple[Moving, ...]

    @property
    def moving(self) -> tuple[Moving, ...]:
        """Return all that moves."""
        return (*self.coordinates, *self.speeds, *self.inputs)

    def middle(self) -> Mapping[str, float]:
        """Return the middle of every range."""
        return middle((*self.parameters, *self.moving))

    @cached_property
    def places(self) -> Scope:
        """Return the scope of where things are: parameters and coordinates."""
        return _places(self)

    @cached_property
    def motions(self) -> Scope:
        """Return the scope of how things move: places, rates of coordinates, and speeds."""
        return _motions(self)

    @cached_property
    def known(self) -> Scope:
        """Return the scope of a load: all that is known with the state and the inputs."""
        return _known(self)


def read_scalars(part: Mapping[str, Table]) -> Scalars:
    """Return the scalars declared in the tables parameters, coordinates, speeds and inputs."""
    empty = Table("", {})
    parameters = read_symbols(part["parameters"], empty, empty, empty).parameters
    fixed = {p.name: dimension(p.unit) for p in parameters}
    speeds = tuple(_speed(name, given) for name, given in _entries(part["speeds"], "speed"))
    for s in speeds:
        fixed[s.name] = dimension(s.unit)
    scope = Scope(fixed, {}, "")
    coordinates = tuple(
        _coordinate(name, given, scope)
        for name, given in _entries(part["coordinates"], "coordinate")
    )
    inputs = tuple(_input(name, given) for name, given in _entries(part["inputs"], "input"))
    return Scalars(parameters, coordinates, speeds, inputs)


def _entries(given: Table, kind: str) -> list[tuple[str, Table]]:
    return [
        (identifier(name, f"{ARTICLE[kind]} {kind}"), table(value, f"{kind} '{name}'"))
        for name, value in given.entries.items()
    ]


def _spelling(given: Table, kind: str) -> str:
    found = unit_of(given)
    for spelling, known in zip(UNITS[kind], DIMENSIONS[kind], strict=True):
        if found == known:
            return spelling
    first, second = UNITS[kind]
    raise SceneError(f"{given.label} must be in {first} or {second}, not {spelled(found)}")


def _meaning(given: Table) -> str:
    value = given.entries.get("meaning")
    return "" if value is None else text(value, f"{given.label}: meaning")


def _free(given: Table, kinds: tuple[str, ...]) -> bool:
    """Tell whether a motion is free: it says so, or nothing of its rates is given."""
    entries = given.entries
    if "motion" in entries:
        motion = word(entries["motion"], f"{given.label}: motion", ("free", "prescribed"))
        return motion == "free"
    return not any(key in entries for key in kinds)


def _coordinate(name: str, given: Table, scope: Scope) -> Moving:
    keys(given, ("unit", "range"), ("meaning", "motion", "rate", "acceleration"))
    spelling = _spelling(given, "coordinate")
    low, high = interval(given.entries["range"], f"{given.label}: range")
    rate = given.entries.get("rate")
    own = PER_SECOND[spelling]
    free = _free(given, ("acceleration",)) and (rate is None or isinstance(rate, dict))
    made: Input | Formula | None
    second: Input | Formula | None = None
    if free:
        if "acceleration" in given.entries:
            raise SceneError(f"{given.label} is free, so its acceleration is found, not given")
        bounds = {"range": [-1, 1]} if rate is None else rate
        made = _given_rate(name, given, "rate", bounds, "dot", own)
    else:
        if rate is None:
            raise SceneError(
                f"{given.label} needs rate = {{ range = [low, high] }}, 0 or a formula"
            )
        made = _rate(name, given, rate, scope, own)
        if isinstance(made, Input):
            second = _second(name, given, PER_SECOND[own])
        elif "acceleration" in given.entries and given.entries["acceleration"] != 0:
            raise SceneError(f"{given.label}: its acceleration follows from the rate '{made}'")
    return Moving(name, spelling, low, high, _meaning(given), "coordinate", free, made, second)


def _rate(name: str, given: Table, value: object, scope: Scope, unit: str) -> Input | Formula:
    if isinstance(value, dict):
        return _given_rate(name, given, "rate", value, "dot", unit)
    return formula(value, f"{given.label}: rate", scope, dimension(unit))


def _second(name: str, given: Table, unit: str) -> Input | Formula:
    value = given.entries.get("acceleration")
    if isinstance(value, dict):
        return _given_rate(name, given, "acceleration", value, "ddot", unit)
    if value == 0 and value is not None:
        return ZERO
    rule = "needs acceleration = { range = [low, high] } or 0"
    raise SceneError(f"{given.label} {rule}" + ("" if value is None else f", not {shown(value)}"))


def _given_rate(name: str, given: Table, key: str, value: object, dots: str, unit: str) -> Input:
    inner = table(value, f"{given.label}: {key}")
    keys(inner, ("range",), ("meaning",))
    low, high = interval(inner.entries["range"], f"{inner.label}: range")
    return Input(f"{name}_{dots}", unit, low, high, _meaning(inner))


def _speed(name: str, given: Table) -> Moving:
    keys(given, ("unit", "range"), ("meaning", "motion", "rate"))
    spelling = _spelling(given, "speed")
    low, high = interval(given.entries["range"], f"{given.label}: range")
    free = _free(given, ("rate",))
    rate: Input | Formula | None = None
    value = given.entries.get("rate")
    if not free:
        if isinstance(value, dict):
            rate = _given_rate(name, given, "rate", value, "dot", PER_SECOND[spelling])
        elif value == 0 and value is not None:
            rate = ZERO
        else:
            raise SceneError(f"{given.label} needs rate = {{ range = [low, high] }} or rate = 0")
    elif value is not None:
        raise SceneError(f"{given.label} is free, so its rate is found, not given")
    return Moving(name, spelling, low, high, _meaning(given), "speed", free, rate, None)


def _input(name: str, given: Table) -> Moving:
    keys(given, ("unit", "range"), ("meaning",))
    unit_of(given)
    low, high = interval(given.entries["range"], f"{given.label}: range")
    spelling = str(given.entries["unit"])
    return Moving(name, spelling, low, high, _meaning(given), "input", False, None, None)  # noqa: FBT003


def _places(scalars: Scalars) -> Scope:
    known = {"pi": NONE} | {p.name: dimension(p.unit) for p in scalars.parameters}
    known |= {c.name: dimension(c.unit) for c in scalars.coordinates}
    others = {m.name: f"{'an' if m.kind == 'input' else 'a'} {m.kind}"
              for m in (*scalars.speeds, *scalars.inputs)}  # fmt: skip
    return Scope(known, others, "only parameters and coordinates may stand here")


def _motions(scalars: Scalars) -> Scope:
    known = dict(scalars.places.dimensions)
    known |= rates(scalars)
    known |= {s.name: dimension(s.unit) for s in scalars.speeds}
    others = {m.name: "an input, whose rate is not known" for m in scalars.inputs}
    return Scope(
        known, others, "only parameters, coordinates, their rates and speeds may stand here"
    )


def rates(scalars: Scalars) -> dict[str, Dimension]:
    """Return the rates of coordinates that have a name of their own."""
    return {
        c.rate.name: dimension(c.rate.unit)
        for c in scalars.coordinates
        if isinstance(c.rate, Input)
    }


def accelerations(scalars: Scalars) -> dict[str, Dimension]:
    """Return the given accelerations of coordinates and rates of speeds."""
    each = [c.acceleration for c in scalars.coordinates] + [s.rate for s in scalars.speeds]
    return {i.name: dimension(i.unit) for i in each if isinstance(i, Input)}


def unknown_rates(scalars: Scalars) -> dict[str, Dimension]:
    """Return the accelerations that the balances are to find."""
    found = {}
    for c in scalars.coordinates:
        if c.free:
            found[c.unknown] = dimension(PER_SECOND[PER_SECOND[c.unit]])
    for s in scalars.speeds:
        if s.free:
            found[s.unknown] = dimension(PER_SECOND[s.unit])
    return found


def _known(scalars: Scalars) -> Scope:
    dimensions = dict(scalars.motions.dimensions)
    dimensions |= accelerations(scalars)
    dimensions |= {m.name: dimension(m.unit) for m in scalars.inputs}
    others = dict.fromkeys(unknown_rates(scalars), "an acceleration that is found")
    return Scope(dimensions, others, "a load is a formula of what is known with the state")


def turnings(value: object, label: str, scope: Scope) -> tuple[Turning, ...]:
    """Return the turns of a list such as ["z psi", "x theta - tilt"]."""
    if not isinstance(value, list) or not value:
        raise SceneError(f"{label} must be a list such as ['z psi'], not {shown(value)}")
    return tuple(_turning(entry, label, scope) for entry in value)


def _turning(entry: object, label: str, scope: Scope) -> Turning:
    axis, _, angle = entry.strip().partition(" ") if isinstance(entry, str) else ("", "", "")
    if axis not in ("x", "y", "z") or not angle.strip():
        rule = "a turn is an axis and an angle, as 'z psi'"
        raise SceneError(f"{label}: {rule}, not {shown(entry)}")
    return Turning(cast("Axis", axis), formula(angle.strip(), label, scope, NONE))
