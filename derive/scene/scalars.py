"""The scalars of a scene: parameters, and what moves; and who may use them."""

from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from dataclasses import replace
from typing import Any, Literal

from derive.scene.declaration import Input, Moving, Parameter, SceneError
from derive.scene.entries import COORDINATE, INPUT, MEANING, PARAMETER, RANGE, SPEED
from derive.scene.entry import Reading, entries_of
from derive.scene.escape import brief
from derive.scene.formula import ZERO, Formula, symbols
from derive.scene.names import identifier
from derive.scene.scopes import ARTICLE, PER_SECOND, Scalars
from derive.scene.table import Scope, Table, formula, shown, table
from derive.scene.table import unit as unit_of
from derive.scene.unit import ANGULAR_VELOCITY, LENGTH, NONE, VELOCITY, dimension, spelled

UNITS = {"coordinate": ("rad", "m"), "speed": ("rad/s", "m/s")}
DIMENSIONS = {"coordinate": (NONE, LENGTH), "speed": (ANGULAR_VELOCITY, VELOCITY)}
ROWS = {"coordinate": COORDINATE, "speed": SPEED, "input": INPUT}


def read_scalars(part: Mapping[str, Table]) -> Scalars:
    """Return the scalars declared in the tables parameters, coordinates, speeds and inputs."""
    parameters = tuple(_parameter(*entry) for entry in _entries(part["parameters"], "parameter"))
    speeds = tuple(_speed(*entry) for entry in _components(part["speeds"], "speed"))
    inputs = tuple(_input(*entry) for entry in _components(part["inputs"], "input"))
    own = _components(part["coordinates"], "coordinate")
    known = {"pi": NONE} | {p.name: dimension(p.unit) for p in parameters}
    known |= {s.name: dimension(s.unit) for s in speeds}
    known |= {name: dimension(_spelling(given, "coordinate")) for name, given, _ in own}
    others = {f"{name}_dot": "a rate" for name in known if f"{name}_dot" not in known}
    others |= dict.fromkeys((m.name for m in inputs), "an input, whose rate is not known")
    scope = Scope(known, others, "only parameters, coordinates and speeds may stand here")
    moved = {name for name, *_ in own} | {s.name for s in speeds if s.free}
    coordinates = tuple(_coordinate(*entry, scope, moved) for entry in own)
    return Scalars(parameters, coordinates, speeds, inputs)


def of_one_body(part: Mapping[str, Table]) -> Scalars:
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


def _entries(given: Table, kind: str) -> list[tuple[str, Table]]:
    return [
        (identifier(name, f"{ARTICLE[kind]} {kind}"), table(value, f"{kind} '{name}'"))
        for name, value in given.entries.items()
    ]


def _components(given: Table, kind: str) -> list[tuple[str, Table, str]]:
    """Return name and table of each scalar, and the vector that it is a component of."""
    found = []
    for name, one in _entries(given, kind):
        if "components" not in one.entries:
            found.append((name, one, ""))
            continue
        parts = entries_of(one, ROWS[kind], Reading())["components"]
        alone = {key: value for key, value in one.entries.items() if key != "components"}
        for part in parts:
            own = identifier(f"{name}_{part}", f"{ARTICLE[kind]} {kind}")
            found.append((own, Table(f"{kind} '{own}'", alone), name))
    return found


def _parameter(name: str, given: Table) -> Parameter:
    said = entries_of(given, PARAMETER, Reading())
    unit_of(given)
    if (said["range"] is None) == (said["value"] is None):
        raise SceneError(f"{given.label} needs either a range or a value")
    low, high = said["range"] or (said["value"], said["value"])
    says = said["meaning"] or f"parameter {name}"
    return Parameter(name, said["unit"], low, high, says, said["value"])


def _spelling(given: Table, kind: str) -> str:
    entries_of(given, ROWS[kind], Reading())
    found = unit_of(given)
    for spelling, known in zip(UNITS[kind], DIMENSIONS[kind], strict=True):
        if found == known:
            return spelling
    first, second = UNITS[kind]
    raise SceneError(f"{given.label} must be in {first} or {second}, not {spelled(found)}")


def _free(said: Mapping[str, Any], key: str) -> bool:
    """Tell whether a motion is free: it says so, or nothing of its rates is given."""
    return said[key] is None if said["motion"] is None else said["motion"] == "free"


def _coordinate(
    name: str, given: Table, vector: str, scope: Scope, moved: AbstractSet[str]
) -> Moving:
    said = entries_of(given, COORDINATE, Reading())
    spelling = _spelling(given, "coordinate")
    rate, own = said["rate"], PER_SECOND[spelling]
    free = _free(said, "acceleration") and (rate is None or isinstance(rate, dict))
    made: Input | Formula | None
    second: Input | Formula | None = None
    if free:
        if said["acceleration"] is not None:
            raise SceneError(f"{given.label} is free, so its acceleration is found, not given")
        bounds = {"range": [-1, 1]} if rate is None else rate
        made = _given_rate(name, vector, given, "rate", bounds, own)
    else:
        if rate is None:
            raise SceneError(
                f"{given.label} needs rate = {{ range = [low, high] }}, 0 or a formula"
            )
        if isinstance(rate, dict):
            made = _given_rate(name, vector, given, "rate", rate, own)
            second = _input_or_zero(name, vector, given, "acceleration", "0", PER_SECOND[own])
        else:
            made = formula(rate, f"{given.label}: rate", scope, dimension(own))
            if said["acceleration"] not in (None, 0):
                rule = f"its acceleration follows from the rate '{brief(made)}'"
                raise SceneError(f"{given.label}: {rule}")
    by_moved = isinstance(made, Formula) and not moved.isdisjoint(symbols(made))
    state = free or (said["motion"] or ("free" if by_moved else "")) == "free"
    return _moving(name, vector, spelling, said, "coordinate", (free, state), (made, second))


def _moving(
    name: str,
    vector: str,
    unit: str,
    said: Mapping[str, Any],
    kind: Literal["coordinate", "speed", "input"],
    free_and_state: tuple[bool, bool],
    rates_: tuple[Input | Formula | None, Input | Formula | None],
) -> Moving:
    low, high = said["range"]
    says = said["meaning"] or f"{kind} {vector or name}"
    return Moving(name, unit, low, high, says, kind, *free_and_state, *rates_, vector)


def _input_or_zero(
    name: str, vector: str, given: Table, key: str, zero: str, unit: str
) -> Input | Formula:
    """Return what prescribes a motion last: an input of a range, or nothing that changes.

    zero : how a file says so
    """
    value = given.entries.get(key)
    if isinstance(value, dict):
        return _given_rate(name, vector, given, key, value, unit)
    if value == 0 and value is not None:
        return ZERO
    found = "" if value is None else f", not {shown(value)}"
    raise SceneError(f"{given.label} needs {key} = {{ range = [low, high] }} or {zero}{found}")


def _given_rate(name: str, vector: str, given: Table, key: str, value: object, unit: str) -> Input:
    said = entries_of(table(value, given.of(key)), (RANGE, MEANING), Reading())
    (low, high), dots = said["range"], "ddot" if key == "acceleration" else "dot"
    return Input(f"{name}_{dots}", unit, low, high, said["meaning"] or f"{key} of {vector or name}")


def _speed(name: str, given: Table, vector: str) -> Moving:
    said = entries_of(given, SPEED, Reading())
    spelling, value = _spelling(given, "speed"), said["rate"]
    free = _free(said, "rate")
    rate: Input | Formula | None = None
    if free and value is not None:
        raise SceneError(f"{given.label} is free, so its rate is found, not given")
    if not free:
        rate = _input_or_zero(name, vector, given, "rate", "rate = 0", PER_SECOND[spelling])
    return _moving(name, vector, spelling, said, "speed", (free, free), (rate, None))


def _input(name: str, given: Table, vector: str) -> Moving:
    said = entries_of(given, INPUT, Reading())
    unit_of(given)
    return _moving(name, vector, said["unit"], said, "input", (False, False), (None, None))
