"""The frames of a machine: a tree of axes, each read by what turns it and what carries it."""

from collections.abc import Iterable, Mapping
from typing import Any

from derive.scene.declaration import SceneError
from derive.scene.entries import FRAME, ROLLS
from derive.scene.entry import Reading, entries_of
from derive.scene.escape import brief
from derive.scene.formula import ZERO
from derive.scene.machine import INERTIAL, Frame, Rolling
from derive.scene.names import label
from derive.scene.scalars import Scalars
from derive.scene.table import Table, nearest, table, text

ORIGIN = ("origin", "rolls", "velocity", "acceleration")


def read_frames(given: Table, scalars: Scalars, bodies: tuple[str, ...]) -> tuple[Frame, ...]:
    """Return the inertial frame and all others, each after its parent."""
    found: dict[str, Frame] = {INERTIAL: Frame(INERTIAL, "")}
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
    by = Reading(scalars.scopes, {"body": bodies})
    while ready:
        for name in ready:
            found[name] = _frame(name, waiting.pop(name), by)
        ready = sorted((n for r in ready for n in carried.get(r, ())), key=place.__getitem__)
    if waiting:
        raise SceneError(_uncarried({n: _parent(entry) for n, entry in waiting.items()}, found))
    return tuple(found.values())


def _parent(given: Table) -> str:
    return text(given.entries.get("parent", INERTIAL), f"{given.label}.parent")


def _uncarried(parents: Mapping[str, str], found: Iterable[str]) -> str:
    """Return why no chain of frames leads to those left: one of another name, or a circle."""
    chain = [next(iter(parents))]
    while (parent := parents[chain[-1]]) in parents and parent not in chain:
        chain.append(parent)
    name, known = chain[-1], (*found, *parents)
    if parent not in parents:
        says = f"frame '{name}' has the parent '{brief(parent)}', and no frame is called so"
        return says + nearest(parent, [n for n in known if n != name])
    if parent == name:
        return f"frame '{name}' has itself as its parent; the first of a chain is '{INERTIAL}'"
    circle = [*chain[chain.index(parent) :], parent]
    says = f"frames carry each other in a circle: {', '.join(map(brief, circle))}"
    return f"{says}; the first of a chain is '{INERTIAL}'"


def _frame(name: str, given: Table, by: Reading) -> Frame:
    said = entries_of(given, FRAME, by)
    _agree(given.label, {key for key, value in said.items() if value is not None})
    return Frame(
        name,
        said["parent"],
        said["turned"] or (),
        said["angular_velocity"],
        f"attitude_{name}" if said["attitude"] else "",
        said["origin"] or (ZERO, ZERO, ZERO),
        said["velocity"],
        said["acceleration"],
        _rolling(said["rolls"], by),
    )


def _agree(label: str, said: set[str]) -> None:
    """Refuse entries of a frame that contradict each other."""
    if "turned" in said and said & {"angular_velocity", "attitude"}:
        raise SceneError(f"{label} has both turned and angular_velocity; give one of them")
    if "attitude" in said and "angular_velocity" not in said:
        raise SceneError(f"{label}: an attitude needs angular_velocity")
    if len(said & {*ORIGIN}) > 1:
        raise SceneError(f"{label} needs at most one of {', '.join(ORIGIN)}")


def _rolling(given: Any, by: Reading) -> Rolling | None:
    return None if given is None else Rolling(**entries_of(given, ROLLS, by))
