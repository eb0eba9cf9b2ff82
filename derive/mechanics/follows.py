"""What follows by the constraints in small motion, chosen where the scene names nothing.

Of all choices the one is taken whose pivot, the smallest singular value of how conditions change
with the rates that follow, is largest where it is smallest on the declared ranges.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import combinations
from math import comb
from random import Random

import numpy as np
from sympy import lambdify

from derive.mechanics.box import Box, ranges
from derive.mechanics.frames import Frames
from derive.mechanics.held import bindings
from derive.mechanics.onto import TELLING, Doubles
from derive.scene import Input, Scene, SceneError
from derive.scene.declaration import Moving
from derive.scene.escape import at_place
from derive.scene.formula import symbol, symbols
from derive.scene.groups import grouped
from derive.scene.results import MATRICES, written_out

POINTS, MOST, SAME = 32, 20_000, 6
SEED = "derive: what follows"


def wants_small_motion(machine: Scene) -> bool:
    """Tell whether small motion of a machine with constraints is asked for."""
    results = {r.name: r for r in machine.results}
    asked = {name for answers in machine.asked.values() for name in answers}
    used = {s for name in asked & results.keys()
            for s in symbols(written_out(results[name].formula, machine.results))}  # fmt: skip
    own = "linearised" in asked or any(s.startswith(tuple(MATRICES)) for s in used)
    return bool(machine.constraints) and own


def with_what_follows(frames: Frames) -> Scene:
    """Return a machine in which what follows by its constraints is marked, by the tool's choice.

    Raises SceneError where no choice does on all of the declared ranges; the sentence says where.
    """
    machine, held = frames.machine, bindings(frames)
    free = [m for m in (*machine.coordinates, *machine.speeds) if m.free]
    if held.onto is None or any(m.dependent for m in free):
        return machine
    names = [m.rate.name if isinstance(m.rate, Input) else m.name for m in free]
    box, brings = ranges(frames.words), held.onto
    own = [box.names[k] for k in brings.rates]
    points = _about(frames, box)
    rows = [held.every.index(tie) for tie in held.kept]
    slopes = np.array([brings.slopes(p)[rows] for p in points])
    slopes = slopes[:, :, [own.index(name) for name in names]]
    of_places = [k for k, tie in enumerate(held.kept) if tie.place is not None]
    places = [k for k, m in enumerate(free) if m.kind == "coordinate"]
    kept = {n for n, f in machine.about.items() if f == symbol(n)}
    able = [k for k, m in enumerate(free) if m.name not in kept]
    able = able if len(able) >= len(rows) else [*range(len(free))]

    def pivots(chosen: Sequence[int]) -> Doubles:
        found = _least(slopes[:, :, [*chosen]])
        of = [k for k in chosen if k in places]
        if of_places and len(chosen) == len(rows):
            lost = len(of) < len(of_places)
            own_ = _least(slopes[:, of_places][:, :, of]) if not lost else 0 * found
            found = np.minimum(found, own_)
        return found

    best = _best(able, len(rows), pivots)
    worst = int(np.argmin(pivots(best)))
    following = [free[k].name for k in best]
    told = ", ".join(f"'{name}'" for name in following)
    if pivots(best)[worst] <= TELLING:
        where = {n: float(f"{x:.4g}") for n, x in zip(box.names, points[worst], strict=True)}
        rule = "no choice of what follows by the constraints does in all of the given motions"
        place = at_place({n: where[n] for n in box.names[: len(where)] if n not in own})
        raise SceneError(f"'linearised': {rule}; for {told} its pivot is 0 {place.strip()}")

    def marked(each: tuple[Moving, ...]) -> tuple[Moving, ...]:
        return tuple(replace(m, dependent=m.name in following) for m in each)

    says = f"'linearised': {told} follow by the constraints, so it is of the others"
    coordinates, speeds = marked(machine.coordinates), marked(machine.speeds)
    told_ = (*machine.told, says)
    return grouped(replace(machine, coordinates=coordinates, speeds=speeds, told=told_))


def _about(frames: Frames, box: Box) -> Doubles:
    """Return points (count, components) of the ranges, with the state of the given motion."""
    dice = Random(SEED)  # noqa: S311 - trial points, no secret
    parts = np.array([[dice.random() for _ in box.symbols] for _ in range(POINTS)])
    points: Doubles = box.low + (box.high - box.low) * parts
    about, words = frames.machine.about, frames.words
    given = lambdify(box.symbols, [words.expression(f) for f in about.values()], modules="numpy")
    for point in points:
        for name, value in zip(about, given(*point), strict=True):
            point[box.names.index(name)] = value
    return points


def _least(matrices: Doubles) -> Doubles:
    """Return the smallest singular value of each matrix."""
    return np.asarray(np.linalg.svd(matrices, compute_uv=False)[:, -1])


def _best(
    able: Sequence[int], count: int, pivots: Callable[[Sequence[int]], Doubles]
) -> tuple[int, ...]:
    """Return the choice whose smallest pivot is largest; of very many, one by one."""

    def least(own: Sequence[int]) -> float:
        return round(float(np.min(pivots(own))), SAME)

    if comb(len(able), count) <= MOST:
        return max(combinations(able, count), key=least)
    found: tuple[int, ...] = ()
    for _ in range(count):
        rest = (k for k in able if k not in found)
        found = max(((*found, k) for k in rest), key=least)
    return tuple(sorted(found))
