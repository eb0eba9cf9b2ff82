"""Attitudes in a task: turns from rest to rest, their errors, cones that an axis keeps out of."""

from collections.abc import Callable
from math import cos, pi, sin
from typing import Any

import casadi
import numpy as np

from derive.control.plant import NDFloat, Plant
from derive.motion.attitude import quaternion
from derive.scene import SceneError
from derive.scene.table import shown
from derive.solve.settings import number

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
UNIT = 1e-6  # that the length of a quaternion may be off 1
product: Callable[[Any, Any], list[Any]] = quaternion.product
conjugate: Callable[[Any], list[Any]] = quaternion.conjugate


def require_unit(says: str, q: NDFloat) -> None:
    if abs(np.linalg.norm(q) - 1) > UNIT:
        raise SceneError(f"{says} must have length 1, not {np.linalg.norm(q):.6g}")


def axis_of(label: str, text: str) -> NDFloat:
    """Return the unit vector of x, y, z, or of three numbers with commas between."""
    parts = text.split(",")
    try:
        found = AXES.get(text) or tuple(number(label, t.strip(), "1") for t in parts)
    except SceneError:
        found = ()
    largest = max(map(abs, found), default=0.0) or 1.0
    found = tuple(c / largest for c in found)  # so that no square is beyond all numbers
    length = np.linalg.norm(found)
    if len(found) != 3 or not any(found):
        raise SceneError(
            f"{label}: an axis is x, y, z or three numbers as 1,2,2, not all 0, not {shown(text)}"
        )
    axis: NDFloat = np.array(found) / length
    return axis


def slewed(own: Plant, says: str, turn: str, start: NDFloat, x: Any) -> tuple[NDFloat, list[Any]]:
    """Return where a turn from the start ends, at rest, and what vanishes there."""
    if not own.attitude:
        rule = 'a turn is of an attitude, and this scene has none (attitude = "quaternion")'
        raise SceneError(f"{says}: {rule}; name states at the end instead")
    words = turn.split()
    if len(words) != 2:
        raise SceneError(
            f'{says}: a turn is an axis and an angle, as "z 180deg", not {shown(turn)}'
        )
    axis = axis_of(f"{says}: turn", words[0])
    angle = number(f"{says}: turn", words[1], "rad")
    if not 0 < abs(angle) <= pi * (1 + 1e-12):
        raise SceneError(f"{says}: a turn is by more than 0 and at most 180deg, not {words[1]}")
    goal, place = start.copy(), list(own.attitude)
    goal[place] = product(start[place], [cos(angle / 2), *(sin(angle / 2) * axis)])
    goal[list(own.turning)] = 0
    rest = [x[k] for k in own.turning]
    return goal, [turn_error(own, goal, x), *rest]


def turn_error(own: Plant, goal: NDFloat, x: Any) -> Any:
    """Return twice the vector of conj(q_goal) q, which has no fold at any turn."""
    q = goal[list(own.attitude)]
    return 2 * casadi.vertcat(*product(conjugate(q), [x[k] for k in own.attitude])[1:])


def outside(own: Plant, says: str, text: str, x: Any) -> Any:
    """Return what is above 0 where an axis of the body points into a cone."""
    words = text.split()
    if not own.attitude:
        rule = 'an axis of an attitude (attitude = "quaternion")'
        raise SceneError(f"{says}: to avoid a cone is for {rule}, and this scene has none")
    if len(words) != 3:
        rule = 'an axis of a body, a direction, an angle, as "x 0,0,1 30deg"'
        raise SceneError(f"{says}: to avoid is {rule}, not {shown(text)}")
    own_axis, direction = (axis_of(f"{says}: avoid", w) for w in words[:2])
    angle = number(f"{says}: avoid", words[2], "rad")
    if not 0 < angle < pi:
        raise SceneError(
            f"{says}: a cone to avoid is of more than 0 and less than 180deg, not {words[2]}"
        )
    q = [x[k] for k in own.attitude]
    seen = product(product(q, [0, *own_axis]), conjugate(q))[1:]
    return casadi.dot(casadi.vertcat(*seen), casadi.DM(direction)) - cos(angle)
