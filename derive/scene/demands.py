"""What a scene demands of its parameters: positive masses and lengths, tensors of bodies.

The reader tries the declared ranges; set-up tries the very values that it is given. A broken
triangle inequality is not among the demands: it is a warning in a scene, and so it is in set-up.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import Literal

from derive.scene.declaration import Body, Sextuple, ShortForm
from derive.scene.formula import Formula
from derive.scene.machine import Above, Demand, Entries, Member, Tensor


def kind(demand: Demand) -> Literal["mass", "length", "inertia"]:
    """Return what a demand is about."""
    return "inertia" if isinstance(demand, Tensor) else demand.kind


def of_one_body(scene: ShortForm) -> tuple[Demand, ...]:
    """Return what the scene of a single body demands of its parameters."""
    body, found = scene.body, list[Demand]()
    found += _of_substance("body", body.mass, body.lengths)
    for wheel in scene.wheels:
        found.append(Above(f"wheel '{wheel.name}': axial", "inertia", wheel.axial))
    label = "body inertia less that of the wheels" if scene.wheels else "body inertia"
    return _sorted((*found, Tensor(label, _about_every_axis(body, carrier(scene)), "positive",
                                     body.inertia)))  # fmt: skip


def of_bodies(bodies: Iterable[Member]) -> tuple[Demand, ...]:
    """Return what bodies demand of a scene's parameters, masses first, tensors last."""
    found = list[Demand]()
    for body in bodies:
        label = f"body '{body.name}'"
        found += _of_substance(label, body.mass, body.lengths)
        if {"inner", "outer"} <= set(body.lengths):
            gap = body.lengths["outer"] - body.lengths["inner"]
            found.append(Above(f"{label}.outer less inner", "length", gap))
        found.append(Tensor(f"{label} inertia", body.inertia, "not negative"))
    return _sorted(found)


def _sorted(found: Iterable[Demand]) -> tuple[Demand, ...]:
    return tuple(sorted(found, key=lambda d: ("mass", "length", "inertia").index(kind(d))))


def _of_substance(
    label: str, mass: Formula | None, lengths: Mapping[str, Formula]
) -> Iterator[Demand]:
    if mass is not None:
        yield Above(f"{label}.mass", "mass", mass)
    for name, length in lengths.items():
        yield Above(f"{label}.{name}", "length", length)


def carrier(scene: ShortForm) -> Sextuple:
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
