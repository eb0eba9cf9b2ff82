"""What a trajectory must do: where it begins and ends, what it keeps away from, what it costs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np

from derive.control.aim import Aim, aim
from derive.control.limits import Keeps, limited, require_kept, require_room
from derive.control.plant import NDFloat, Plant
from derive.control.slew import conjugate, product
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
    keeps       : what must not be above 0 on the way
    low, high   : of x, then of u
    cost        : weights of the time in s and of the integral of u.u ("energy")
    sizes       : of x, then of u: what each may come to, by its limits, its range, and what inputs
                  add to it in the time
    until       : s, the end, or where the cost counts the time, the first guess of it
    """

    start: NDFloat
    goal: NDFloat
    ends: Any
    keeps: Keeps
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
    ranged = () if weights["energy"] else own.u
    low, high, keeps = limited(own, says, limits, ranged, avoid, to.named)
    require_room(own, says, to, low, high)
    require_kept(own, says, keeps, to, (low[len(own.x) :], high[len(own.x) :]))
    end_time = _time(own, says, weights, until, to, low, high)
    sizes = _sizes(own, to, low, high, end_time)
    return Task(to.start, to.goal, to.ends, keeps, low, high, weights, sizes, end_time)


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
