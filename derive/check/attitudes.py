"""Formulas for attitudes beside what their names mean: turns about an axis, by Rodrigues' formula.

No quaternion is multiplied here and no matrix is made of one: a quaternion says an axis and an
angle, vectors are turned about it, and the three unit vectors so turned must be the same.
"""

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from math import atan, atan2, cos, hypot, inf, pi, sin
from random import Random
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.check.emitted import Emitted, verdict
from derive.check.verdict import JUDGED, Verdict
from derive.program.largest import largest
from derive.scene.wanted import ATTITUDES

COUNT = 200
ALLOWED = 32.0
"""In u: a formula promises 8 u at most, and a turn of rounded numbers is not far from that."""
ROUNDED = 1e-6
UNIT: NDArray[Any] = np.eye(3)


def attitude_definitions(emitted: Emitted) -> Iterator[Verdict]:
    """Yield whether every formula for attitudes gives what its name means."""
    dice = Random("attitudes")  # noqa: S311 - samples, no secret
    dtype = emitted.precision.dtype
    for program in emitted.library.printed():
        if program.name not in ATTITUDES:
            continue
        function = emitted.functions[program.name]
        gaps = []
        for _ in range(COUNT):
            given = {q.name: _drawn(dice, q.name).astype(dtype).tolist() for q in program.inputs}
            (found,) = function(given).values()
            gaps.append(_gap(program.name, np.array(found), list(map(np.array, given.values()))))
        worst = largest(gaps) / emitted.precision.unit_roundoff
        says = f"{COUNT} samples, largest gap {worst:.2g} u"
        yield verdict(emitted, program.name, "definition", JUDGED[worst <= ALLOWED], says)


def _drawn(dice: Random, name: str) -> NDArray[Any]:
    """Return a sample of an input: quaternions of length 1, matrices that turn."""
    four: NDArray[Any] = np.array([dice.gauss(0, 1) for _ in range(4)])
    unit: NDArray[Any] = four / _size(four)
    match name:
        case "matrix":
            return _columns(unit)
        case "quaternion":
            return four
        case "attitude" | "left" | "right" | "target":
            return unit
        case _:
            three: NDArray[Any] = np.array([dice.uniform(-3, 3) for _ in range(3)])
            return three


def _gap(name: str, found: NDArray[Any], given: list[NDArray[Any]]) -> float:
    """Return how far what is found is from what it means, beside the length of that or 1."""
    of_found, of_given = _meaning(name.removeprefix("quaternion_"))
    a, b = of_found(found), of_given(*given)
    pairs = zip(np.atleast_2d(a), np.atleast_2d(b), strict=True)
    apart = [_size(x - y) / max(_size(y), 1.0) for x, y in pairs]
    besides = BESIDES.get(name.removeprefix("quaternion_"))
    return largest([*apart, *([besides(found, *given)] if besides else [])])


def _meaning(name: str) -> tuple[Callable[..., NDArray[Any]], Callable[..., NDArray[Any]]]:
    """Return what is made of a formula's result and of what it is given: these are the same."""
    way, _, sequence = name.partition("_euler_")
    if not sequence:
        return MEANT[name]
    angles = partial(_in_turn, sequence)
    return (angles, _turned) if way == "to" else (_turned, angles)


def _as_it_is(x: NDArray[Any]) -> NDArray[Any]:
    return x


def _turned(q: NDArray[Any], vectors: NDArray[Any] = UNIT) -> NDArray[Any]:
    """Return vectors turned by a quaternion, which says an axis and half an angle."""
    return _rodrigues(q[1:], 2 * atan2(_size(q[1:]), q[0]), vectors)


def _turned_back(q: NDArray[Any], vectors: NDArray[Any]) -> NDArray[Any]:
    return _rodrigues(q[1:], -2 * atan2(_size(q[1:]), q[0]), vectors)


def _columns(q: NDArray[Any]) -> NDArray[Any]:
    found: NDArray[Any] = np.ravel(_turned(q))
    return found


def _of_vector(v: NDArray[Any]) -> NDArray[Any]:
    return _rodrigues(v, _size(v), UNIT)


def _of_mrp(mrp: NDArray[Any]) -> NDArray[Any]:
    return _rodrigues(mrp, 4 * atan(_size(mrp)), UNIT)


def _between(target: NDArray[Any], q: NDArray[Any]) -> NDArray[Any]:
    """Return the unit vectors turned by q, then back by the target: rows of a rotation matrix."""
    return _turned_back(target, _turned(q))


def _even_of_turn(target: NDArray[Any], q: NDArray[Any]) -> NDArray[Any]:
    """Return what of the turn from the target to q is the same for the opposite turn."""
    rows = _between(target, q)
    found: NDArray[Any] = (rows + rows.T) / 2
    return found


def _even_of_error(e: NDArray[Any]) -> NDArray[Any]:
    """Return the same for e = 2 sin(angle / 2) n: cos 1 + (1 - cos) n n, as e e = 2 (1 - cos)."""
    found: NDArray[Any] = np.multiply.outer(e, e) / 2 + (1 - _size(e) ** 2 / 2) * UNIT
    return found


def _turn_of_slopes(slopes: NDArray[Any]) -> NDArray[Any]:
    """Return the turn, rows as above, that slopes J belong to: J J + 1 - J J' (J = w 1 + [v]x)."""
    rows = slopes.reshape(3, 3)
    found: NDArray[Any] = rows @ rows + UNIT - rows @ rows.T
    return found


def _odd(found: NDArray[Any], target: NDArray[Any], q: NDArray[Any]) -> float:
    """Return 0 if an error points along the axis about which q is turned from the target."""
    rows = _between(target, q)
    axis = np.array([rows[1, 2] - rows[2, 1], rows[2, 0] - rows[0, 2], rows[0, 1] - rows[1, 0]])
    return _none_above(-float((axis * found).sum()), 0.0)


def _in_turn(sequence: str, angles: NDArray[Any]) -> NDArray[Any]:
    """Return the unit vectors after turns about axes that the turns before have moved.

    The same as turns about the axes at rest in the other order: the last angle comes first.
    """
    turns = UNIT
    for axis, angle in reversed(list(zip(sequence, angles, strict=True))):
        turns = _rodrigues(UNIT["xyz".index(axis)], angle, turns)
    return turns


def _rodrigues(axis: NDArray[Any], angle: float, vectors: NDArray[Any]) -> NDArray[Any]:
    """Return vectors turned about an axis: e (e v) + (v - e (e v)) cos + (e x v) sin."""
    e = axis / (_size(axis) or 1.0)
    along = np.multiply.outer((vectors * e).sum(axis=-1), e)
    found: NDArray[Any] = along + (vectors - along) * cos(angle) + np.cross(e, vectors) * sin(angle)
    return found


def _size(v: NDArray[Any]) -> float:
    return hypot(*v)


MEANT: Mapping[str, tuple[Callable[..., NDArray[Any]], Callable[..., NDArray[Any]]]] = {
    "product": (_turned, lambda left, right: _turned(left, _turned(right))),
    "normalise": (_as_it_is, lambda q: q / _size(q)),
    "exp": (_turned, _of_vector),
    "log": (_of_vector, _turned),
    "rotate": (_as_it_is, _turned),
    "rotate_back": (_as_it_is, _turned_back),
    "error": (_even_of_error, _even_of_turn),
    "error_tangent": (_turn_of_slopes, _between),
    "to_matrix": (_as_it_is, _columns),
    "from_matrix": (_columns, _as_it_is),
    "to_mrp": (_of_mrp, _turned),
    "from_mrp": (_turned, _of_mrp),
}


def _cosine(left: NDArray[Any], right: NDArray[Any]) -> float:
    """Return the cosine of half the angle of two turns in a row, by spherical trigonometry."""
    a, b = left[1:], right[1:]
    between = float((a * b).sum()) / (_size(a) * _size(b) or 1.0)
    alpha, beta = atan2(_size(a), left[0]), atan2(_size(b), right[0])
    return cos(alpha) * cos(beta) - sin(alpha) * sin(beta) * between


def _none_above(x: float, limit: float) -> float:
    """Return 0 if a number keeps to its limit, but for rounding in float, else infinity."""
    return 0.0 if x <= limit + ROUNDED else inf


BESIDES: Mapping[str, Callable[..., float]] = {
    "product": lambda found, left, right: abs(_cosine(left, right) - found[0]),
    "exp": lambda found, v: abs(found[0] - cos(_size(v) / 2)),
    "log": lambda found, _: _none_above(_size(found), pi),
    "error": _odd,
    "error_tangent": lambda found, *_: _none_above(-float(found[0] + found[4] + found[8]), 0.0),
    "from_matrix": lambda found, _: _none_above(-found[0], 0.0),
    "to_mrp": lambda found, _: _none_above(_size(found), 1.0),
}
"""What a turn does not tell: which of its two quaternions, which of its vectors."""
