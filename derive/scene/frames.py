"""The frames of a machine: a tree of axes, each read by what turns it and what carries it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from derive.scene.declaration import SceneError
from derive.scene.escape import brief
from derive.scene.formula import ZERO
from derive.scene.machine import INERTIAL, Frame, Rolling
from derive.scene.names import label
from derive.scene.scalars import Scalars, turnings
from derive.scene.table import Table, keys, nearest, table, text, triple, word
from derive.scene.unit import ACCELERATION, ANGULAR_VELOCITY, LENGTH, VELOCITY

if TYPE_CHECKING:
    from derive.scene.declaration import Triple

TURNING = ("turned", "angular_velocity", "attitude")
ORIGIN = ("origin", "rolls", "velocity", "acceleration")
STILL = Frame(INERTIAL, "", (), None, False, (ZERO, ZERO, ZERO))  # noqa: FBT003


def read_frames(given: Table, scalars: Scalars, bodies: tuple[str, ...]) -> tuple[Frame, ...]:
    """Return the inertial frame and all others, each after its parent."""
    found: dict[str, Frame] = {INERTIAL: STILL}
    waiting = {
        label(name, "a frame"): table(value, f"frame '{name}'")
        for name, value in given.entries.items()
    }
    if INERTIAL in waiting:
        raise SceneError(f"frame '{INERTIAL}' is there already")
    carried: dict[str, list[str]] = {}
    for name, entry in waiting.items():
        carried.setdefault(_parent(entry), []).append(name)
    place = {name: k for k, name in enumerate(waiting)}
    ready = carried.get(INERTIAL, [])
    while ready:
        for name in ready:
            found[name] = _frame(name, waiting.pop(name), scalars, bodies)
        ready = sorted((n for r in ready for n in carried.get(r, ())), key=place.__getitem__)
    if waiting:
        name, entry = next(iter(waiting.items()))
        parent = str(entry.entries.get("parent"))
        hint = "" if parent in waiting else nearest(parent, [*found, *waiting])
        rule = "which no chain of frames carries"
        raise SceneError(f"frame '{name}' has the parent '{brief(parent)}', {rule}{hint}")
    return tuple(found.values())


def _parent(given: Table) -> str:
    return text(given.entries.get("parent", INERTIAL), f"{given.label}.parent")


def _frame(name: str, given: Table, scalars: Scalars, bodies: tuple[str, ...]) -> Frame:
    keys(given, (), ("parent", *TURNING, *ORIGIN))
    entries, label = given.entries, given.label
    turned = "turned" in entries
    if turned and ("angular_velocity" in entries or "attitude" in entries):
        raise SceneError(f"{label} has both turned and angular_velocity; give one of them")
    if "attitude" in entries:
        word(entries["attitude"], f"{label}.attitude", ("quaternion",))
        if "angular_velocity" not in entries:
            raise SceneError(f"{label}: an attitude needs angular_velocity")
    if sum(key in entries for key in ORIGIN) > 1:
        raise SceneError(f"{label} needs at most one of {', '.join(ORIGIN)}")

    def three(key: str) -> Triple | None:
        scope, unit = {
            "angular_velocity": (scalars.motions, ANGULAR_VELOCITY),
            "velocity": (scalars.motions, VELOCITY),
            "acceleration": (scalars.known, ACCELERATION),
            "origin": (scalars.places, LENGTH),
        }[key]
        return triple(entries[key], f"{label}.{key}", scope, unit) if key in entries else None

    return Frame(
        name,
        _parent(given),
        turnings(entries["turned"], f"{label}.turned", scalars.places) if turned else (),
        three("angular_velocity"),
        "attitude" in entries,
        three("origin") or (ZERO, ZERO, ZERO),
        three("velocity"),
        three("acceleration"),
        _rolling(given, scalars, bodies) if "rolls" in entries else None,
    )


def _rolling(given: Table, scalars: Scalars, bodies: tuple[str, ...]) -> Rolling:
    inner = table(given.entries["rolls"], f"{given.label}.rolls")
    keys(inner, ("body", "at"), ())
    body = word(inner.entries["body"], f"{inner.label}.body", bodies)
    return Rolling(body, triple(inner.entries["at"], f"{inner.label}.at", scalars.places, LENGTH))
