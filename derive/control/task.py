"""What a trajectory must do: where it begins and ends, what it keeps away from, what it costs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from typing import Any

import casadi
import numpy as np

from derive.control.aim import Aim, aim, vector_names
from derive.control.plant import NDFloat, Plant
from derive.control.slew import conjugate, outside, product
from derive.scene import SceneError
from derive.scene.table import nearest, shown
from derive.solve.arguments import one_number
from derive.solve.settings import NamedValues, number

COSTS = ("time", "energy")


@dataclass(frozen=True)
class Task:
    """A start, conditions at the end, limits on the way, and the cost.

    start, goal : (x,) where it begins, and a state that satisfies the end
    ends        : x -> what vanishes at the end; three components of an attitude, never four
    keeps       : x -> what must not be above 0 on the way
    low, high   : of x, then of u
    cost        : weights of the time in s and of the integral of u.u ("energy")
    sizes       : of x, then of u: what each may come to, by its limits, its range, and what inputs
                  add to it in the time
    until       : s, the end, or where the cost counts the time, the first guess of it
    """

    start: NDFloat
    goal: NDFloat
    ends: Any
    keeps: Any
    low: NDFloat
    high: NDFloat
    cost: Mapping[str, float]
    sizes: NDFloat
    until: float

    @property
    def is_free(self) -> bool:
        """Tell whether the time at the end is to be found."""
        return self.cost["time"] > 0


def task(
    own: Plant,
    given: Mapping[str, float],
    turn: str,
    end: NamedValues,
    limits: Mapping[str, float | str],
    avoid: Sequence[str],
    cost: Mapping[str, float],
    until: float | None,
) -> Task:
    """Return what is asked for, in numbers.

    given : values of states at the start; what is not given begins at 0, an attitude unturned
    Raises SceneError for what makes no sense.
    """
    says = f"scene '{own.name}'"
    weights = _weights(says, cost)
    to = aim(own, given, turn, end)
    low, high = _bounded(own, says, limits, () if weights["energy"] else own.u)
    x = casadi.SX.sym("x", len(own.x))
    away = [outside(own, says, text, x) for text in avoid]
    keeps = casadi.Function("keeps", [x], [casadi.vertcat(*away)])
    _require_room(own, says, to, low, high)
    for where, at in (("start", to.start), *((("end", to.goal),) if turn else ())):
        inside = np.flatnonzero(np.array(keeps(at)).ravel() > 0) if away else ()
        if len(inside):
            raise SceneError(f"{says}: the {where} lies inside of what is to be avoided")
    end_time = _time(own, says, weights, until, to, low, high)
    sizes = _sizes(own, to, low, high, end_time)
    return Task(to.start, to.goal, to.ends, keeps, low, high, weights, sizes, end_time)


def _require_room(own: Plant, says: str, to: Aim, low: NDFloat, high: NDFloat) -> None:
    """Refuse a start, or an end, that lies outside of its own limits."""
    for k, name in enumerate(own.x):
        asked = (("start", to.start), *((("end", to.goal),) if name in to.named else ()))
        for where, at in asked:
            if not low[k] <= at[k] <= high[k]:
                rule = f"must be within its limits, {low[k]:g} to {high[k]:g}"
                raise SceneError(f"{says}: {name} at the {where} {rule}, not {at[k]:g}")


def _weights(says: str, cost: Mapping[str, float]) -> dict[str, float]:
    for name, value in cost.items():
        if name not in COSTS:
            raise SceneError(
                f"{says}: a cost is time or energy, not {shown(name)}{nearest(name, COSTS)}"
            )
        weight = one_number(says, f"the weight of {name}", value)
        if not (isfinite(weight) and weight >= 0):
            raise SceneError(
                f"{says}: the weight of {name} must be a number from 0 up, not {weight:g}"
            )
    weights = {name: float(cost.get(name, 0)) for name in COSTS}
    if not any(weights.values()):
        raise SceneError(f"{says}: the cost must weigh time or energy above 0")
    return weights


def _bounded(
    own: Plant, says: str, limits: Mapping[str, float | str], ranged: Sequence[str]
) -> tuple[NDFloat, NDFloat]:
    """Return the least and largest x and u; of ``ranged``, those of their ranges, if none else."""
    every = (*own.x, *own.u)
    ends = dict.fromkeys(every, (-inf, inf)) | {n: own.ranges[n] for n in ranged}
    whole, limited = vector_names(own), set[str]()
    for name, value in limits.items():
        named = [c for c in whole.get(name, (name,)) if c in ends]
        if not named:
            rule = "a limit is of a state or an input"
            raise SceneError(f"{says}: {rule}, not of {shown(name)}{nearest(name, every)}")
        if not limited.isdisjoint(named):
            raise SceneError(f"{says}: {sorted(limited & {*named})[0]} is limited twice")
        limited |= {*named}
        ends |= dict.fromkeys(named, _ends(f"{says}: limit {name}", value, own.units[named[0]]))
    low, high = np.array([ends[n] for n in every]).T
    return low, high


def _ends(label: str, value: float | str, unit: str) -> tuple[float, float]:
    """Return the limits that a text tells: 0.4 is -0.4 to 0.4, and 0..2 is what it says."""
    first, dots, last = value.partition("..") if isinstance(value, str) else ("", "", "")
    if dots:
        low, high = (number(label, t.strip(), unit) for t in (first, last))
    else:
        own = number(label, value.strip(), unit) if isinstance(value, str) else value
        high = one_number(label, "the limit", own)
        low = -high
    if not low < high:
        raise SceneError(f"{label}: a limit must be above 0, or LOW..HIGH, not {value}")
    return low, high


def _time(
    own: Plant, says: str, weights: Mapping[str, float], until: float | None,
    to: Aim, low: NDFloat, high: NDFloat,
) -> float:  # fmt: skip
    """Return the time that is asked for, or a guess: of turning about one axis, of slowing."""
    if until is not None:
        end = one_number(says, "until", until)
        if not (isfinite(end) and end > 0):
            raise SceneError(f"{says}: until must be a number of seconds above 0, not {end:g}")
        return end
    count = len(own.x)
    most = np.minimum(high[count:], -low[count:])
    place, turning = list(own.attitude), list(own.turning)
    guess = 0.0
    if weights["time"] and turning and np.isfinite(most).all() and (most > 0).all():
        between = np.array(product(conjugate(to.start[place]), to.goal[place]))
        angle = 2 * np.arctan2(np.linalg.norm(between[1:]), abs(between[0]))
        axis = between[1:] / (np.linalg.norm(between[1:]) or 1.0)
        faster = to.goal[turning] - to.start[turning]
        each = np.linalg.lstsq(own.gain(to.start)[turning], np.array([axis, faster]).T, rcond=None)
        turns, speeds = (np.abs(needed) / most for needed in each[0].T)
        guess = float(2 * np.sqrt(angle * turns.max()) + speeds.max())
    if not guess > 0:
        which = "a first guess of it" if weights["time"] else "the time at the end"
        raise SceneError(f"{says}: until is missing: {which}, in seconds")
    return guess


def _sizes(own: Plant, to: Aim, low: NDFloat, high: NDFloat, until: float) -> NDFloat:
    """Return how large states and inputs may become: scales of variables, and of perturbations."""
    count = len(own.x)
    widest = np.maximum(np.abs(low), np.abs(high))[count:]
    inputs = np.where(np.isfinite(widest), widest, own.scales(own.u))
    ends = np.maximum(np.abs(to.start), np.abs(to.goal))
    reached = np.maximum(until * np.abs(own.gain(to.start)) @ inputs, ends)
    ranges = own.scales(own.x)
    return np.concatenate([np.where(reached > 0, np.minimum(reached, ranges), ranges), inputs])


def costs_of(texts: Mapping[str, str]) -> dict[str, float]:
    """Return the weights of a cost. Raises SceneError for a text that is no number."""
    return {name: number(f"cost {name}", value.strip(), "1") for name, value in texts.items()}
