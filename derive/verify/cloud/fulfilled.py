"""States of a cloud of particles brought onto its constraints, to the digits of the cloud."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from mpmath import mp, mpf

from derive.scene import Input, Scene
from derive.verify.cloud.balance import at_instant
from derive.verify.cloud.held import conditions_of, first_rates, first_slopes
from derive.verify.cloud.history import History

ROUNDS, FULFILLED = 60, mpf(10) ** -45
NEAR, FOLLOWED, TELLING = mpf(10) ** -9, mpf(10) ** -35, 1e-6


def fulfilled(
    machine: Scene, given: Mapping[str, Any], only: Sequence[str] = ()
) -> dict[str, Any] | None:
    """Return a state nearby that fulfils all constraints, to the digits of the cloud, or None.

    only : the rates that may change, or whose places may; all if none is named

    Places are moved along the velocities that the frames allow, then rates are: by all conditions
    at first, then by those that are independent there, which the others must follow.
    """
    here = dict(given)
    for of_rates in (False, True):
        own: list[int] = []
        for _ in range(ROUNDS):
            values, slopes, states = _near(machine, here, only, of_rates=of_rates)
            largest = max(map(abs, values), default=mpf(0))
            if not mp.isfinite(largest):
                return None
            if all(abs(values[k]) < FULFILLED for k in own or range(len(values))):
                break
            if largest < NEAR and not own:
                own = _independent(slopes)
            kept = own or range(len(values))
            step = _least([[row[k] for k in kept] for row in slopes], [values[k] for k in kept])
            for k, name in enumerate(states):
                for c, slope in states[name].items():
                    here[c] -= slope * step[k]
        else:
            return None
        if largest > FOLLOWED:
            return None
    return here


def _near(machine: Scene, here: Mapping[str, Any], only: Sequence[str], *, of_rates: bool) -> Any:
    """Return conditions, their slopes by each rate, and the rates of states by each rate."""
    free = {m.unknown: mpf(0) for m in (*machine.coordinates, *machine.speeds) if m.free}
    known = {u.name: mpf(0) for u in machine.unknowns}

    def make(change: Mapping[str, Any]) -> History:
        return History(machine, {**known, **here, **free, **change})

    base = make({})
    values = first_rates(base) if of_rates else [
        s.value for one, s in conditions_of(base) if not one.of_rates
    ]  # fmt: skip
    rates = [c.rate.name for c in machine.coordinates if c.free and isinstance(c.rate, Input)]
    rates += [s.name for s in machine.speeds if s.free]
    rates = [name for name in rates if not only or name in only]
    slopes, states = [], {}
    for name in rates:
        moved = make({name: here[name] + 1})
        own = first_slopes(base, moved, name)
        kept = [of_rates or not one.of_rates for one, _ in conditions_of(base)]
        slopes.append([x for x, keep in zip(own, kept, strict=True) if keep])
        states[name] = {name: mpf(1)} if of_rates else _carried(machine, base, moved)
    return values, slopes, states


def _carried(machine: Scene, base: History, moved: History) -> dict[str, Any]:
    """Return how the states that places are made of move where a rate is one more."""
    found = {}
    for c in machine.coordinates:
        if c.state:
            found[c.name] = moved.scalars[c.name].velocity - base.scalars[c.name].velocity
    for frame in machine.frames:
        if frame.attitude and frame.angular_velocity is not None:
            own = [at_instant(h.column(frame.angular_velocity)) for h in (moved, base)]
            x, y, z = own[0] - own[1]
            w, i, j, k = (base.values[f"{frame.attitude}_{p}"] for p in "wxyz")
            rates = (-i * x - j * y - k * z, w * x + j * z - k * y,
                     w * y + k * x - i * z, w * z + i * y - j * x)  # fmt: skip
            found |= {f"{frame.attitude}_{p}": r / 2 for p, r in zip("wxyz", rates, strict=True)}
    return {c: slope for c, slope in found.items() if slope}


def _independent(slopes: list[list[Any]]) -> list[int]:
    """Return the places of the first conditions that are independent."""
    matrix, kept = np.array(slopes, dtype=float).T, list[int]()
    for k in range(len(matrix)):
        size = np.linalg.svd(matrix[[*kept, k]], compute_uv=False)
        if len(size) == len(kept) + 1 and size[-1] > TELLING * size[0]:
            kept.append(k)
    return kept


def _least(slopes: list[list[Any]], values: list[Any]) -> Any:
    """Return the least step that takes values off, by slopes of each rate; damped where far."""
    J = mp.matrix(slopes)  # (rates, conditions)
    square = J.T * J
    size = max((abs(square[i, i]) for i in range(square.rows)), default=mpf(1)) or mpf(1)
    gap = mp.fsum(x * x for x in values)
    for i in range(square.rows):
        square[i, i] += size * (gap if gap > NEAR**2 else 0) / (1 + gap)
    return J * mp.lu_solve(square, mp.matrix(values))
