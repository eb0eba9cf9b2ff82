"""What a scene demands of its parameters: positive masses and lengths, tensors of bodies.

The reader tries the declared ranges; set-up tries the very values that it is given. A broken
triangle inequality is not among the demands: it is a warning in a scene, and so it is in set-up.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from derive.scene.machine import Machine

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from derive.scene.declaration import Body, Scene, Sextuple
    from derive.scene.formula import Formula
    from derive.scene.machine import Entries


@dataclass(frozen=True)
class Above:
    """A formula of parameters that must be above zero."""

    label: str
    kind: Literal["mass", "length", "inertia"]
    formula: Formula


@dataclass(frozen=True)
class Tensor:
    """An inertia (xx, yy, zz, xy, xz, yz) that must be positive definite, or not negative.

    None stands for an entry that is not known or not asked about.
    """

    label: str
    entries: Entries
    relation: Literal["positive", "not negative"]


Demand = Above | Tensor


def demands(scene: Scene | Machine) -> tuple[Demand, ...]:
    """Return all that ``scene`` demands of its parameters, masses first, tensors last."""
    found = tuple(_of_machine(scene) if isinstance(scene, Machine) else _of_scene(scene))
    return tuple(sorted(found, key=lambda d: ("mass", "length", "inertia").index(kind(d))))


def kind(demand: Demand) -> Literal["mass", "length", "inertia"]:
    """Return what a demand is about."""
    return "inertia" if isinstance(demand, Tensor) else demand.kind


def _of_scene(scene: Scene) -> Iterator[Demand]:
    body = scene.body
    yield from _of_substance("body", body.mass, body.lengths)
    for wheel in scene.wheels:
        yield Above(f"wheel '{wheel.name}': axial", "inertia", wheel.axial)
    label = "body inertia less that of the wheels" if scene.wheels else "body inertia"
    yield Tensor(label, _about_every_axis(body, carrier(scene)), "positive")


def _of_machine(machine: Machine) -> Iterator[Demand]:
    for body in machine.bodies:
        label = f"body '{body.name}'"
        yield from _of_substance(label, body.mass, body.lengths)
        if {"inner", "outer"} <= set(body.lengths):
            gap = body.lengths["outer"] - body.lengths["inner"]
            yield Above(f"{label}.outer less inner", "length", gap)
        yield Tensor(f"{label} inertia", body.inertia, "not negative")


def _of_substance(
    label: str, mass: Formula | None, lengths: Mapping[str, Formula]
) -> Iterator[Demand]:
    if mass is not None:
        yield Above(f"{label}.mass", "mass", mass)
    for name, length in lengths.items():
        yield Above(f"{label}.{name}", "length", length)


def carrier(scene: Scene) -> Sextuple:
    """Return the inertia of the body without what its wheels have about their axes."""
    xx, yy, zz, xy, xz, yz = scene.body.inertia
    for wheel in scene.wheels:
        (x, y, z), axial = wheel.axis, wheel.axial
        xx, yy, zz = xx - axial * x * x, yy - axial * y * y, zz - axial * z * z
        xy, xz, yz = xy + axial * x * y, xz + axial * x * z, yz + axial * y * z
    return xx, yy, zz, xy, xz, yz


def _about_every_axis(body: Body, inertia: Sextuple) -> Entries:
    """Return the entries that count: a thin rod need not have a moment about its own axis."""
    if body.kind != "rod":
        return inertia
    xx, yy, zz, xy, xz, yz = inertia
    first, second, third = (
        None if name == body.axis else m for name, m in zip("xyz", (xx, yy, zz), strict=True)
    )
    return first, second, third, xy, xz, yz
