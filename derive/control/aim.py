"""Where a trajectory begins and ends: states at the start, and what must vanish at the end."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import casadi
import numpy as np

from derive.control.plant import NDFloat, Plant
from derive.control.slew import UNIT, require_unit, slewed, turn_error
from derive.scene import SceneError
from derive.solve.settings import NamedValues, settings

THERE = 1e-12  # of what should vanish at the end: so close, the start is the end


@dataclass(frozen=True)
class Aim:
    """A start, a state that satisfies the end, and x -> what vanishes there.

    named : the components of the goal that the end asks for
    """

    start: NDFloat
    goal: NDFloat
    ends: Any
    named: frozenset[str]


def aim(own: Plant, given: Mapping[str, float], turn: str, end: NamedValues) -> Aim:
    """Return where to begin and to end. Raises SceneError for what makes no sense."""
    says = f"scene '{own.name}'"
    start = _start(own, given)
    there = settings(own.name, own.states, spread(own, end))
    x = casadi.SX.sym("x", len(own.x))
    goal, left = start.copy(), list[Any]()
    if turn:
        goal, left = slewed(own, says, turn, start, x)
        for name in there:
            if own.x.index(name) in (*own.attitude, *own.turning):
                raise SceneError(f"{says}: a turn says what {name} is at the end; leave one out")
    for name, value in there.items():
        goal[own.x.index(name)] = value
    if not turn:
        left += _attitude_at_end(own, says, goal, there, x)
    left += [x[k] - there[n] for k, n in enumerate(own.x) if n in there and k not in own.attitude]
    if not left:
        raise SceneError(f"{says}: nothing is to be reached; give a turn, or states at the end")
    ends = casadi.Function("ends", [x], [casadi.vertcat(*left)])
    if np.abs(np.array(ends(start))).max() <= THERE:
        raise SceneError(f"{says}: the start is where the end is to be")
    turned = {own.x[k] for k in (*own.attitude, *own.turning)} if turn else set[str]()
    return Aim(start, goal, ends, frozenset(there.keys() | turned))


def spread(own: Plant, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values by name, one number for a vector given to each of its components."""
    whole = vector_names(own)
    found = dict[str, Any]()
    for name, value in values.items():
        single = isinstance(value, str) or np.ndim(value) == 0
        found |= dict.fromkeys(whole[name], value) if name in whole and single else {name: value}
    return found


def vector_names(own: Plant) -> dict[str, tuple[str, ...]]:
    """Return the components of states and inputs by what all of them are called."""
    every = (*own.x, *own.u)
    known = {q.name: tuple(c for c in q.components if c in every) for q in own.found.quantities()}
    stems = {s: _beginning(s, every) for n in every if (s := n.rpartition("_")[0])}
    found = stems | known
    return {n: c for n, c in found.items() if len(c) > 1 and n not in every}


def _beginning(stem: str, names: Iterable[str]) -> tuple[str, ...]:
    return tuple(n for n in names if n.rpartition("_")[0] == stem)


def _start(own: Plant, given: Mapping[str, float]) -> NDFloat:
    start = np.array([given.get(n, 0.0) for n in own.x])
    place = list(own.attitude)
    if place and not any(own.x[k] in given for k in place):
        start[place] = (1, 0, 0, 0)
    if place:
        require_unit(f"scene '{own.name}': an attitude at the start", start[place])
    return start


def _attitude_at_end(
    own: Plant, says: str, goal: NDFloat, there: Mapping[str, float], x: Any
) -> list[Any]:
    """Return what vanishes where an attitude is reached, or some of its components."""
    place = list(own.attitude)
    named = [k for k in place if own.x[k] in there]
    if not named:
        return []
    rest = [k for k in place if k not in named]
    length = np.linalg.norm(goal[named])
    if not rest or abs(length - 1) <= UNIT:
        goal[rest] = 0
        require_unit(f"{says}: an attitude at the end", goal[place])
        return [turn_error(own, goal, x)]
    if length > 1:
        require_unit(f"{says}: an attitude at the end", goal[named])
    left = np.linalg.norm(goal[rest])
    goal[rest] = (goal[rest] / left if left else np.eye(len(rest))[0]) * np.sqrt(1 - length**2)
    return [x[k] - goal[k] for k in named]
