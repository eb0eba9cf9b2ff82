"""What a trajectory must do: where it begins and ends, what it keeps away from, what it costs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from typing import Any

import casadi
import numpy as np

from derive.control.plant import NDFloat, Plant
from derive.control.slew import conjugate, outside, product, require_unit, slewed, turn_error
from derive.scene import SceneError
from derive.scene.table import nearest, shown
from derive.solve.settings import NamedValues, number, settings

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
    start = _start(own, given)
    there = settings(own.name, own.states, end)
    _require_states(says, "end", there, own.x)
    low, high = _bounded(own, says, limits, () if weights["energy"] else own.u)
    x = casadi.SX.sym("x", len(own.x))
    goal, left = start.copy(), list[Any]()
    if turn:
        goal, left = slewed(own, says, turn, start, x)
    if not {own.x[k] for k in own.attitude}.isdisjoint(there):
        goal[list(own.attitude)] = 0
    for name, value in there.items():
        k = own.x.index(name)
        goal[k] = value
        if k not in own.attitude:
            left.append(x[k] - value)
    if not turn and {own.x[k] for k in own.attitude} & there.keys():
        left.append(turn_error(own, says, goal, x))
    if not left:
        raise SceneError(f"{says}: nothing is to be reached; give a turn, or states at the end")
    away = [outside(own, says, text, x) for text in avoid]
    end_time = _time(own, says, weights, until, start, goal, low, high)
    return Task(
        start,
        goal,
        casadi.Function("ends", [x], [casadi.vertcat(*left)]),
        casadi.Function("keeps", [x], [casadi.vertcat(*away)]),
        low,
        high,
        weights,
        _sizes(own, start, goal, low, high, end_time),
        end_time,
    )


def _weights(says: str, cost: Mapping[str, float]) -> dict[str, float]:
    for name, value in cost.items():
        if name not in COSTS:
            raise SceneError(
                f"{says}: a cost is time or energy, not {shown(name)}{nearest(name, COSTS)}"
            )
        if not (isfinite(value) and value >= 0):
            raise SceneError(
                f"{says}: the weight of {name} must be a number from 0 up, not {value:g}"
            )
    weights = {name: float(cost.get(name, 0)) for name in COSTS}
    if not any(weights.values()):
        raise SceneError(f"{says}: the cost must weigh time or energy above 0")
    return weights


def _start(own: Plant, given: Mapping[str, float]) -> NDFloat:
    start = np.array([given.get(n, 0.0) for n in own.x])
    place = list(own.attitude)
    if place and not start[place].any():
        start[place] = (1, 0, 0, 0)
    if place:
        require_unit(f"scene '{own.name}'", start[place])
    return start


def _require_states(says: str, what: str, names: Mapping[str, Any], known: Sequence[str]) -> None:
    for name in names:
        if name not in known:
            raise SceneError(f"{says}: '{name}' has no value at the {what}, for it is no state")


def _bounded(
    own: Plant, says: str, limits: Mapping[str, float | str], ranged: Sequence[str]
) -> tuple[NDFloat, NDFloat]:
    """Return the least and largest x and u; of ``ranged``, those of their ranges, if none else."""
    every = (*own.x, *own.u)
    ends = dict.fromkeys(every, (-inf, inf)) | {n: own.ranges[n] for n in ranged}
    whole = {q.name: q.components for q in own.found.quantities()}
    for name, value in limits.items():
        named = [c for c in whole.get(name, (name,)) if c in ends]
        if not named:
            rule = "a limit is of a state or an input"
            raise SceneError(f"{says}: {rule}, not of {shown(name)}{nearest(name, every)}")
        ends |= dict.fromkeys(named, _ends(f"{says}: limit {name}", value, own.units[named[0]]))
    low, high = np.array([ends[n] for n in every]).T
    return low, high


def _ends(label: str, value: float | str, unit: str) -> tuple[float, float]:
    """Return the limits that a text tells: 0.4 is -0.4 to 0.4, and 0..2 is what it says."""
    first, dots, last = value.partition("..") if isinstance(value, str) else ("", "", "")
    if dots:
        low, high = (number(label, t.strip(), unit) for t in (first, last))
    else:
        high = number(label, value.strip(), unit) if isinstance(value, str) else float(value)
        low = -high
    if not low < high:
        raise SceneError(f"{label}: a limit must be above 0, or LOW..HIGH, not {value}")
    return low, high


def _time(
    own: Plant, says: str, weights: Mapping[str, float], until: float | None,
    start: NDFloat, goal: NDFloat, low: NDFloat, high: NDFloat,
) -> float:  # fmt: skip
    """Return the time that is asked for, or a guess: what a turn about one axis takes."""
    if until is not None:
        if not (isfinite(until) and until > 0):
            raise SceneError(f"{says}: until must be a number of seconds above 0, not {until:g}")
        return until
    count = len(own.x)
    most = np.minimum(high[count:], -low[count:])
    if (
        weights["time"] == 0
        or not own.turning
        or not (np.isfinite(most).all() and (most > 0).all())
    ):
        which = "a first guess of it" if weights["time"] else "the time at the end"
        raise SceneError(f"{says}: until is missing: {which}, in seconds")
    gain = own.gain(start)[list(own.turning)]
    place = list(own.attitude)
    between = np.array(product(conjugate(start[place]), goal[place]))
    trajectory = between[1:] / (np.linalg.norm(between[1:]) or 1.0)
    needed = np.linalg.lstsq(gain, trajectory, rcond=None)[0]
    angle = 2 * np.arctan2(np.linalg.norm(between[1:]), abs(between[0]))
    fastest = 1 / max(np.abs(needed) / most)
    return float(2 * np.sqrt(max(angle, 1e-3) / fastest))


def _sizes(
    own: Plant, start: NDFloat, goal: NDFloat, low: NDFloat, high: NDFloat, until: float
) -> NDFloat:
    """Return how large states and inputs may become: scales of variables, and of perturbations."""
    count = len(own.x)
    widest = np.maximum(np.abs(low), np.abs(high))[count:]
    inputs = np.where(np.isfinite(widest), widest, own.scales(own.u))
    ends = np.maximum(np.abs(start), np.abs(goal))
    reached = np.maximum(until * np.abs(own.gain(start)) @ inputs, ends)
    ranges = own.scales(own.x)
    return np.concatenate([np.where(reached > 0, np.minimum(reached, ranges), ranges), inputs])


def costs_of(texts: Mapping[str, str]) -> dict[str, float]:
    """Return the weights of a cost. Raises SceneError for a text that is no number."""
    return {name: number(f"cost {name}", value.strip(), "1") for name, value in texts.items()}
