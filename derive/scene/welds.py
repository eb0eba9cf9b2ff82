"""Bodies that are fixed in one frame: what holds them there, where the scene says nothing of it.

Such bodies move as one. A body on which no declared unknown acts is held by one beside it, by a
force and a couple that are the tool's own: they are no answers, and no code carries them.
"""

from collections.abc import Iterable, Iterator

from derive.scene.declaration import AXES, Parameter, Triple
from derive.scene.formula import ZERO, symbol, symbols
from derive.scene.machine import Force, Load, Member, Unknown


def welded(
    bodies: Iterable[Member],
    loads: Iterable[Load],
    unknowns: Iterable[Unknown],
    parameters: Iterable[Parameter],
) -> tuple[tuple[Force, ...], tuple[Unknown, ...]]:
    """Return the loads that hold bodies in their frames, and what of these is to be found."""
    held = _held(loads, {u.name for u in unknowns})
    constant = {"pi", *(p.name for p in parameters)}
    welds = tuple(
        Force(f"weld of {body.name}", body.name, base.name, body.frame, (ZERO, ZERO, ZERO),
              body.frame, _three(body.name, "f"), _three(body.name, ""))
        for base, body in _pairs([b for b in bodies if _is_fixed(b, constant)], held)
    )  # fmt: skip
    found = [
        (f.name, unit, weld.name)
        for weld in welds
        for unit, three in (("N", weld.force), ("N m", weld.couple))
        for f in three
    ]
    return welds, tuple(Unknown(*one) for one in found)


def _held(loads: Iterable[Load], unknowns: set[str]) -> set[str]:
    """Return the bodies on which an unknown acts."""
    forces = [load for load in loads if isinstance(load, Force)]
    acting = [f for f in forces if any(unknowns & {*symbols(c)} for c in (*f.force, *f.couple))]
    return {name for f in acting for name in (f.on, f.against)}


def _is_fixed(body: Member, constant: set[str]) -> bool:
    """Tell whether a body keeps its place and its attitude in its frame."""
    turns = {name for turn in body.turned for name in symbols(turn.angle)}
    moves = (body.spin, body.axial_speed, body.angular_velocity)
    return turns <= constant and all(way is None for way in moves)


def _pairs(fixed: Iterable[Member], held: set[str]) -> Iterator[tuple[Member, Member]]:
    """Yield the bodies that nothing holds, each behind one of its frame: the first that is held."""
    each: dict[str, list[Member]] = {}
    for body in fixed:
        each.setdefault(body.frame, []).append(body)
    for own in each.values():
        base = next((b for b in own if b.name in held), own[0])
        yield from ((base, b) for b in own if b is not base and b.name not in held)


def _three(body: str, kind: str) -> Triple:
    x, y, z = (symbol(f"weld of {body}, {kind}{axis}") for axis in AXES)
    return x, y, z
