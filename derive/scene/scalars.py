"""The scalars of a scene: parameters, and what moves; and who may stand in which formula."""

from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

from derive.scene.declaration import Input, Kind, Moving, Parameter, SceneError
from derive.scene.entries import COORDINATE, INPUT, MEANING, PARAMETER, RANGE, SPEED
from derive.scene.entry import Reading, entries_of
from derive.scene.escape import brief
from derive.scene.formula import ZERO, Formula, symbols
from derive.scene.named import Named, read_named, widened
from derive.scene.names import distinct, identifier
from derive.scene.scope import Scope, formula
from derive.scene.table import Table, shown, table
from derive.scene.table import unit as unit_of
from derive.scene.unit import NONE, Dimension, dimension, spelled

UNITS = {"coordinate": ("rad", "m"), "speed": ("rad/s", "m/s")}
ROWS = {"coordinate": COORDINATE, "speed": SPEED, "input": INPUT}
ARTICLE = {"parameter": "a", "coordinate": "a", "speed": "a", "input": "an"}
PER_SECOND = {"rad": "rad/s", "m": "m/s", "rad/s": "rad/s^2", "m/s": "m/s^2"}


@dataclass(frozen=True)
class Scalars:
    """The scalars of a scene, in the order of the file."""

    parameters: tuple[Parameter, ...]
    coordinates: tuple[Moving, ...] = ()
    speeds: tuple[Moving, ...] = ()
    inputs: tuple[Moving, ...] = ()
    named: tuple[Named, ...] = ()

    @property
    def moving(self) -> tuple[Moving, ...]:
        """Return all that moves."""
        return (*self.coordinates, *self.speeds, *self.inputs)

    @property
    def declared(self) -> list[tuple[str, str]]:
        """List every name with what it is, derived ones included."""
        found = [(p.name, f"parameter '{p.name}'") for p in self.parameters]
        for m in self.moving:
            found.append((m.name, f"{m.kind} '{m.name}'"))
            rates = [i.name for i in m.given]
            if m.free and m.kind != "input":
                rates.append(m.unknown)
            found += [(name, f"the rate '{name}'") for name in rates]
        found += [(one.name, one.label) for one in self.named]
        vectors = dict.fromkeys((m.vector, m.kind) for m in self.moving if m.vector)
        for name, kind in vectors:
            found.append((name, f"the vector '{name}'"))
            rates = [] if kind == "input" else [f"{name}_dot", f"{name}_ddot"]
            found += [(rate, f"the rate of the vector '{name}'") for rate in rates]
        return found

    @property
    def scopes(self) -> Mapping[str, Scope]:
        """Return who may stand where, by what the tables of entries call it."""
        names = ("constants", "places", "motions", "known")
        return {name: getattr(self, name) for name in names}

    @cached_property
    def constants(self) -> Scope:
        """Return the scope of what a rigid body keeps: parameters only."""
        known = {"pi": NONE} | {p.name: dimension(p.unit) for p in self.parameters}
        others = {m.name: f"{ARTICLE[m.kind]} {m.kind}" for m in self.moving}
        others |= {i.name: "a rate" for m in self.moving for i in m.given}
        return self._widened(known, others, "only parameters may stand here")

    @cached_property
    def places(self) -> Scope:
        """Return the scope of where things are: parameters and coordinates."""
        known = dict(self.constants.dimensions)
        known |= {c.name: dimension(c.unit) for c in self.coordinates}
        others = {m.name: f"{ARTICLE[m.kind]} {m.kind}" for m in (*self.speeds, *self.inputs)}
        return self._widened(known, others, "only parameters and coordinates may stand here")

    @cached_property
    def motions(self) -> Scope:
        """Return the scope of how things move: what has a known rate, and those rates."""
        lost = [c.name for c in self.coordinates if c.rate is None]
        known = {n: d for n, d in self.places.dimensions.items() if n not in lost}
        known |= rates(self)
        known |= {s.name: dimension(s.unit) for s in self.speeds}
        others = {m.name: "an input, whose rate is not known" for m in self.inputs}
        others |= dict.fromkeys(lost, "a coordinate, whose rate is to be found")
        others |= dict.fromkeys(accelerations(self), "an acceleration")
        return self._widened(
            known, others, "only parameters, coordinates, their rates and speeds may stand here"
        )

    @cached_property
    def known(self) -> Scope:
        """Return the scope of a load: all that is known with the state and the inputs."""
        dimensions = dict(self.places.dimensions) | dict(self.motions.dimensions)
        dimensions |= accelerations(self)
        dimensions |= {m.name: dimension(m.unit) for m in self.inputs}
        others = dict.fromkeys(unknown_rates(self), "an acceleration that is found")
        others |= {f"{c.name}_dot": "a rate that is found" for c in self.coordinates
                   if c.rate is None}  # fmt: skip
        rule = "a load is a formula of what is known with the state"
        return self._widened(dimensions, others, rule)

    def _widened(
        self, dimensions: Mapping[str, Dimension], others: Mapping[str, str], rule: str
    ) -> Scope:
        return widened(Scope(dimensions, others, rule), self.named)


def rates(scalars: Scalars) -> dict[str, Dimension]:
    """Return the rates of coordinates that have a name of their own."""
    each = [c.rate for c in scalars.coordinates]
    return {i.name: dimension(i.unit) for i in each if isinstance(i, Input)}


def accelerations(scalars: Scalars) -> dict[str, Dimension]:
    """Return the given accelerations of coordinates and rates of speeds."""
    each = [c.acceleration for c in scalars.coordinates] + [s.rate for s in scalars.speeds]
    return {i.name: dimension(i.unit) for i in each if isinstance(i, Input)}


def unknown_rates(scalars: Scalars) -> dict[str, Dimension]:
    """Return the accelerations that the balances are to find."""
    found = {}
    for m in (*scalars.coordinates, *scalars.speeds):
        if m.free:
            unit = PER_SECOND[m.unit]
            found[m.unknown] = dimension(PER_SECOND[unit] if m.kind == "coordinate" else unit)
    return found


@dataclass(frozen=True)
class _Said:
    """A scalar that moves as a file says it: its table, entries and unit, its vector if any."""

    kind: Kind
    name: str
    vector: str
    given: Table
    said: Mapping[str, Any]
    unit: str

    def rate(self, key: str, value: object, unit: str) -> Input:
        """Return a rate, or an acceleration, that is an input of the range given for it."""
        said = entries_of(table(value, self.given.of(key)), (RANGE, MEANING), Reading())
        (low, high), dots = said["range"], "ddot" if key == "acceleration" else "dot"
        meaning = said["meaning"] or f"{key} of {self.vector or self.name}"
        return Input(f"{self.name}_{dots}", unit, low, high, meaning)

    def rate_or_zero(self, key: str, zero: str, unit: str) -> Input | Formula:
        """Return what prescribes a motion last: an input of a range, or nothing that changes.

        zero : how a file says so
        """
        value = self.said[key]
        if isinstance(value, dict):
            return self.rate(key, value, unit)
        if value == 0 and value is not None:
            return ZERO
        found = "" if value is None else f", not {shown(value)}"
        rule = f"needs {key} = {{ range = [low, high] }} or {zero}{found}"
        raise SceneError(f"{self.given.label} {rule}")

    def free(self, key: str) -> bool:
        """Tell whether a motion is free: it says so, or nothing of its rates is given."""
        motion = self.said["motion"]
        return self.said[key] is None if motion is None else bool(motion == "free")

    def moving(
        self,
        motion: Literal["free", "summed up", "given"] = "given",
        rate: Input | Formula | None = None,
        acceleration: Input | Formula | None = None,
    ) -> Moving:
        """Return the declaration, with what is known of its rates; what is free is summed up."""
        (low, high), says = self.said["range"], self.said["meaning"]
        return Moving(
            self.name, self.unit, low, high, says or f"{self.kind} {self.vector or self.name}",
            self.kind, motion == "free", motion != "given", rate, acceleration, self.vector,
        )  # fmt: skip


def read_scalars(part: Mapping[str, Table]) -> Scalars:
    """Return the scalars declared in the tables parameters, coordinates, speeds and inputs."""
    parameters = tuple(_parameter(*entry) for entry in _entries(part["parameters"], "parameter"))
    speeds = tuple(map(_speed, _said(part["speeds"], "speed")))
    inputs = tuple(one.moving() for one in _said(part["inputs"], "input"))
    own = _said(part["coordinates"], "coordinate")
    every: tuple[Parameter | Moving | _Said, ...] = (*parameters, *speeds, *own)
    known = {"pi": NONE} | {one.name: dimension(one.unit) for one in every}
    others = {f"{name}_dot": "a rate" for name in known if f"{name}_dot" not in known}
    others |= dict.fromkeys((m.name for m in inputs), "an input, whose rate is not known")
    named = read_named(part["formulas"])
    base = Scope(known, others, "only parameters, coordinates and speeds may stand here")
    scope = widened(base, named)
    moved = {one.name for one in own} | {s.name for s in speeds if s.free}
    coordinates = tuple(_coordinate(one, scope, moved) for one in own)
    found = Scalars(parameters, coordinates, speeds, inputs, named)
    if named:  # before a formula is met where a scalar of its name is meant
        distinct(found.declared)
    return found


def _entries(given: Table, kind: str) -> list[tuple[str, Table]]:
    return [
        (identifier(name, f"{ARTICLE[kind]} {kind}"), table(value, f"{kind} '{name}'"))
        for name, value in given.entries.items()
    ]


def _said(given: Table, kind: Kind) -> list[_Said]:
    """Return each scalar of a table, the components of a vector one by one."""
    found = []
    for name, one in _entries(given, kind):
        said = entries_of(one, ROWS[kind], Reading())
        what = f"{ARTICLE[kind]} {kind}"
        parts = [identifier(f"{name}_{part}", what) for part in said["components"] or ()]
        for own in parts or [name]:
            alone = Table(f"{kind} '{own}'", one.entries)
            vector = name if parts else ""
            found.append(_Said(kind, own, vector, alone, said, _unit(alone, kind)))
    return found


def _unit(given: Table, kind: Kind) -> str:
    """Return how the unit of a scalar is spelled: that of a motion is one of two."""
    found = unit_of(given)
    if kind == "input":
        return str(given.entries["unit"])
    for spelling in UNITS[kind]:
        if found == dimension(spelling):
            return spelling
    first, second = UNITS[kind]
    raise SceneError(f"{given.label} must be in {first} or {second}, not {spelled(found)}")


def _parameter(name: str, given: Table) -> Parameter:
    said = entries_of(given, PARAMETER, Reading())
    unit_of(given)
    if (said["range"] is None) == (said["value"] is None):
        raise SceneError(f"{given.label} needs either a range or a value")
    low, high = said["range"] or (said["value"], said["value"])
    says = said["meaning"] or f"parameter {name}"
    return Parameter(name, said["unit"], low, high, says, said["value"])


def _coordinate(one: _Said, scope: Scope, moved: AbstractSet[str]) -> Moving:
    rate, acceleration = one.said["rate"], one.said["acceleration"]
    label, own = one.given.label, PER_SECOND[one.unit]
    if one.free("acceleration") and (rate is None or isinstance(rate, dict)):
        if acceleration is not None:
            raise SceneError(f"{label} is free, so its acceleration is found, not given")
        made = one.rate("rate", {"range": [-1, 1]} if rate is None else rate, own)
        return one.moving("free", made)
    if rate is None:
        raise SceneError(f"{label} needs rate = {{ range = [low, high] }}, 0 or a formula")
    stays = one.said["motion"] == "free"
    if isinstance(rate, dict):
        made = one.rate("rate", rate, own)
        second = one.rate_or_zero("acceleration", "0", PER_SECOND[own])
        return one.moving("summed up" if stays else "given", made, second)
    by = formula(rate, f"{label}: rate", scope, dimension(own))
    if acceleration not in (None, 0):
        rule = f"its acceleration follows from the rate '{brief(by)}'"
        raise SceneError(f"{label}: {rule}")
    by_moved = one.said["motion"] is None and not moved.isdisjoint(symbols(by))
    return one.moving("summed up" if stays or by_moved else "given", by)


def _speed(one: _Said) -> Moving:
    free = one.free("rate")
    if free and one.said["rate"] is not None:
        raise SceneError(f"{one.given.label} is free, so its rate is found, not given")
    if free:
        return one.moving("free")
    rate = one.rate_or_zero("rate", "rate = 0", PER_SECOND[one.unit])
    return one.moving("given", rate)
