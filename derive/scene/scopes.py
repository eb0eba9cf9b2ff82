"""The scalars of a scene together, and who may stand in which formula."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from derive.scene.declaration import Input, Moving, Parameter
from derive.scene.table import Scope
from derive.scene.unit import NONE, Dimension, dimension

ARTICLE = {"parameter": "a", "coordinate": "a", "speed": "a", "input": "an"}
PER_SECOND = {"rad": "rad/s", "m": "m/s", "rad/s": "rad/s^2", "m/s": "m/s^2"}


@dataclass(frozen=True)
class Scalars:
    """The scalars of a scene, in the order of the file."""

    parameters: tuple[Parameter, ...]
    coordinates: tuple[Moving, ...] = ()
    speeds: tuple[Moving, ...] = ()
    inputs: tuple[Moving, ...] = ()

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
        return Scope(known, others, "only parameters may stand here")

    @cached_property
    def places(self) -> Scope:
        """Return the scope of where things are: parameters and coordinates."""
        known = dict(self.constants.dimensions)
        known |= {c.name: dimension(c.unit) for c in self.coordinates}
        others = {m.name: f"{ARTICLE[m.kind]} {m.kind}" for m in (*self.speeds, *self.inputs)}
        return Scope(known, others, "only parameters and coordinates may stand here")

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
        return Scope(
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
        return Scope(dimensions, others, "a load is a formula of what is known with the state")


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
