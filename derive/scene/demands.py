"""What a scene demands of its parameters: positive masses and lengths, tensors of bodies.

The reader tries the declared ranges; set-up tries the very values that it is given. A broken
triangle inequality is not among the demands: it is a warning in a scene, and so it is in set-up.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import Literal

from derive.scene.formula import ZERO, Formula
from derive.scene.machine import Above, Demand, Member, Tensor


def kind(demand: Demand) -> Literal["mass", "length", "inertia"]:
    """Return what a demand is about."""
    return "inertia" if isinstance(demand, Tensor) else demand.kind


def of_bodies(bodies: Iterable[Member]) -> tuple[Demand, ...]:
    """Return what bodies demand of a scene's parameters, masses first, tensors last."""
    found = list[Demand]()
    for body in bodies:
        label = f"body '{body.name}'"
        found += of_substance(label, body.mass, body.lengths)
        if {"inner", "outer"} <= set(body.lengths):
            gap = body.lengths["outer"] - body.lengths["inner"]
            found.append(Above(f"{label}.outer less inner", "length", gap))
        found.append(Tensor(f"{label} inertia", body.inertia, "not negative", body.inertia,
                            body.given))  # fmt: skip
    return in_order(found)


def in_order(found: Iterable[Demand]) -> tuple[Demand, ...]:
    return tuple(sorted(found, key=lambda d: ("mass", "length", "inertia").index(kind(d))))


def of_substance(
    label: str, mass: Formula | None, lengths: Mapping[str, Formula]
) -> Iterator[Demand]:
    if mass is not None and mass != ZERO:
        yield Above(f"{label}.mass", "mass", mass)
    for name, length in lengths.items():
        yield Above(f"{label}.{name}", "length", length)
