"""What inputs do on a grid: at which limit each one is, and when that changes."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise

import numpy as np

from derive.control.direct import Grid
from derive.control.plant import NDFloat

AT = 1e-3  # of the width between its limits, within which an input is at one of them


@dataclass(frozen=True)
class Arc:
    """A while in which each input keeps to its lower limit (-1), its upper (1), or moves (0)."""

    stays: tuple[int, ...]
    lasts: float


def arcs_of(trajectory: Grid, low: NDFloat, high: NDFloat, short: int) -> tuple[Arc, ...]:
    """Return the arcs of a trajectory, its inputs' limits given.

    short : the steps that an input may need between limits and be taken to switch at once
    """
    step = trajectory.until / trajectory.u.shape[1]
    each = [
        [*_stays(row, (a, b), step, short)]
        for row, a, b in zip(trajectory.u, low, high, strict=True)
    ]
    times = sorted({t for own in each for t, _ in own} | {trajectory.until})
    found = []
    for begins, ends in pairwise(times):
        stays = tuple(next(s for t, s in reversed(own) if t <= begins) for own in each)
        found.append(Arc(stays, ends - begins))
    return tuple(found)


def _stays(
    u: NDFloat, limits: tuple[float, float], step: float, short: int
) -> Iterator[tuple[float, int]]:
    """Yield when an input begins to stay, and where."""
    low, high = limits
    width = high - low
    at = [0] * len(u)
    if np.isfinite(width):
        at = [1 if x > high - AT * width else -1 if x < low + AT * width else 0 for x in u]
    runs = _without_short(at, short)
    begins = 0.0
    for k, (place, count, stay) in enumerate(runs):
        yield begins, stay
        if k + 1 < len(runs):
            after, _, then = runs[k + 1]
            begins = step * after
            if stay * then == -1 and (gap := after - place - count) >= 0:
                # between them lie steps of values in between: the same area under a jump
                own = high if stay == 1 else low
                other = high if then == 1 else low
                area = float(np.sum(u[place + count : after]))
                begins = step * (place + count + (area - other * gap) / (own - other))


def _without_short(at: Sequence[int], short: int) -> list[tuple[int, int, int]]:
    """Return where runs begin, their steps, where the input is; short ones are left out."""
    runs, place = list[tuple[int, int, int]](), 0
    for stay, own in groupby(at):
        count = len([*own])
        runs.append((place, count, stay))
        place += count
    kept = list[tuple[int, int, int]]()
    for run in runs:
        start, count, stay = run
        if stay == 0 and count <= short and len(runs) > 1:
            continue
        if kept and kept[-1][2] == stay:
            first = kept[-1][0]
            kept[-1] = (first, start + count - first, stay)
        else:
            kept.append(run)
    return kept or [(0, len(at), 0)]
