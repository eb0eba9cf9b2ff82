"""Which conditions of a machine say something of their own, at states that fulfil all of them.

A condition that the others hold anyway is redundant: it is left out, and what enforces it, of which
nothing could tell how it shares its part, is taken as zero. What cannot be fulfilled is refused.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from random import Random

import numpy as np
from sympy import Symbol

from derive.mechanics.box import Box, ranges
from derive.mechanics.constraints import Tie, curved, ties
from derive.mechanics.frames import Frames
from derive.mechanics.independence import independent_conditions
from derive.mechanics.onto import Doubles, Onto, onto
from derive.scene import SceneError
from derive.scene.escape import at_place

STATES, TRIES = 3, 60
ASIDE, FOLLOWED = 0.05, 1e-6
"""Of a range; and of what a condition is off by there, where the others are fulfilled again."""
SEED = "derive: states on constraints"


@dataclass(frozen=True)
class Bindings:
    """The conditions that are kept, those that are redundant, and what fulfils all.

    every : all of them in the order in which the scene has them
    told : for each unknown that is taken as zero, the condition that it would enforce
    off   : of those that are dropped, by what they do not hold where others do, as a part of ranges
    """

    kept: tuple[Tie, ...] = ()
    dropped: tuple[Tie, ...] = ()
    onto: Onto | None = None
    told: Mapping[Symbol, str] = field(default_factory=dict)
    every: tuple[Tie, ...] = ()
    off: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def curved(self) -> bool:
        """Tell whether a condition of rates is no line in them: one correction does not do then."""
        kept = [c.first for c in self.kept if c.place is None]
        return self.onto is not None and any(curved(self.onto.frames, first) for first in kept)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Return a sentence for each condition that is left out."""
        sheet = self.onto.frames.sheet if self.onto else None
        found = []
        for c in self.dropped:
            force = "" if c.factor is None or sheet is None else f": '{sheet.label(c.factor)}' is 0"
            says = "says nothing that the others do not, and is left out"
            if c.name in self.off:
                off = f"by {self.off[c.name]:.2g} of a range, as rounded numbers are"
                says = f"is off where the others hold {off}, and is left out"
            found.append(f"constraint '{c.name}' {says}{force}")
        return tuple(found)


def bindings(frames: Frames) -> Bindings:
    """Return the conditions of a machine, found once.

    Raises SceneError if no state of the ranges fulfils them.
    """
    if not frames.machine.constraints:
        return Bindings()
    if not frames.words.held:
        frames.words.held.append(_bindings(frames))
    found: Bindings = frames.words.held[0]
    return found


def lost(frames: Frames, place: Mapping[str, float]) -> str:
    """Return a sentence on a condition that the others hold at a place alone, "" if none is."""
    held, box = bindings(frames), ranges(frames.words)
    usual = box.brought(box.trials())
    if held.onto is None or not len(usual) or not place:
        return ""
    rows = [held.every.index(c) for c in held.kept]
    point = np.array([place[name] for name in box.names])
    row = held.onto.lost(point, usual[0], rows)
    if row is None:
        return ""
    where = at_place(
        {n: float(f"{x:.4g}") for n, x in place.items() if n in _placed(held.onto, box)}
    )
    rule = f"says nothing that the others do not {where.strip()}"
    return (f"constraint '{held.every[row].name}' {rule}, so more than one motion may go on from "
            "there; declare ranges that keep away from it")  # fmt: skip


def _placed(brings: Onto, box: Box) -> set[str]:
    return {box.names[k] for k in brings.places}


def _bindings(frames: Frames) -> Bindings:
    every = ties(frames)
    brings = onto(frames, every)
    states = _states(frames, brings, ranges(frames.words))
    found = independent_conditions(brings, states)
    dropped = [c for k, c in enumerate(every) if k not in found.rows]
    told = {c.factor: c.name for c in dropped if c.factor is not None}
    kept = tuple(every[k] for k in found.rows)
    off = {every[k].name: off for k, off in found.off.items()}
    return Bindings(kept, tuple(dropped), brings, told, every, off)


def _states(frames: Frames, brings: Onto, box: Box) -> list[np.ndarray]:
    """Return states of the ranges that fulfil all conditions."""
    dice, found = Random(SEED), []  # noqa: S311 - trial states, no secret
    flat = list[np.ndarray]()
    best = ""
    for _ in range(TRIES):
        start = box.low + (box.high - box.low) * np.array([dice.random() for _ in box.symbols])
        point, fits = brings.brought(start[None, :])
        if fits[0] and not box.outside(point[0], brings.places):
            found.append(point[0])
            flat.append(brings.flat(start, point[0]))
            if len(found) == STATES:
                break
        elif fits[0]:
            best = box.outside(point[0], brings.places)
    if found:
        _require_slopes(brings, np.all(flat, axis=0), np.array(found))
        return found
    names = ", ".join(f"'{c.name}'" for c in frames.machine.constraints)
    kind = "constraint" if len(frames.machine.constraints) == 1 else "constraints"
    rule = f"no state of the declared ranges was found that fulfils {kind} {names}"
    more = f"; the nearest has {best}" if best else ", nor any near them: do they contradict"
    raise SceneError(f"{rule}{more}{'' if best else ' each other?'}")


def _require_slopes(brings: Onto, flat: Doubles, states: Doubles) -> None:
    """Refuse a condition that changes with nothing wherever it holds: no force enforces it.

    It may, where the others hold it anyway.
    """
    others = tuple(c for c, is_flat in zip(brings.conditions, flat, strict=True) if not is_flat)
    if len(others) == len(flat):
        return
    dice, near, fits = Random(SEED), states.copy(), np.ones(len(states), bool)  # noqa: S311
    for k, size in {**brings.places, **brings.rates}.items():
        near[:, k] += [ASIDE * size * dice.uniform(-1, 1) for _ in near]
    off = np.abs(brings.values(near))
    if others:
        near, fits = replace(brings, conditions=others).brought(near)
    for c, is_flat, own, was in zip(brings.conditions, flat, brings.values(near)[fits].T,
                                    off[fits].T, strict=True):  # fmt: skip
        if is_flat and not np.all(np.abs(own) < FOLLOWED * was):
            rule = "changes with nothing where it is 0, as a square does, so nothing enforces it"
            raise SceneError(f"constraint '{c.name}' {rule}; say what is 0 by itself")
