"""Bodies to check at: which inertias are bodies, and the ones that are hard to compute with.

A tensor is a body's if its second moments are not negative, which is the triangle inequality of
the principal moments. Hard bodies are entered through the scene's own parameters, where these are
the moments and products themselves.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from random import Random
from typing import Any, TypeGuard

import numpy as np

from derive.program.added import added
from derive.program.arithmetic import rounded
from derive.program.precision import Precision
from derive.scene import Scene
from derive.scene.formula import ZERO, Arithmetic, Formula, evaluate
from derive.scene.machine import Above, Demand, Entries, Tensor
from derive.verify.columns import arithmetics

Triple = tuple[float, float, float]
SLACK = 1e-12
"""Of the triangle inequality, relative to the trace: a disc obeys it with equality."""
OWN_AXES = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
TURN = (0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6)  # a rotation, exact in decimals


@dataclass(frozen=True)
class Hard:
    """A kind of body: second moments along its own axes, for the precision's smallest step.

    Turned bodies are full tensors; others lie along their principal axes.
    """

    kind: str
    second: Mapping[str, Triple]  # by precision: sum x^2 dm, sum y^2 dm, sum z^2 dm
    spread: float  # relative spread of the second moments
    axes: tuple[float, ...]  # the turn from them to the scene's axes, row by row


def _same(second: Triple) -> dict[str, Triple]:
    return {"f32": second, "f64": second}


BODIES = (
    Hard("sphere", _same((0.5, 0.5, 0.5)), 0.0, OWN_AXES),
    Hard("near sphere", _same((0.5, 0.5, 0.5)), 1e-8, OWN_AXES),
    Hard("thin rod", _same((1e-6, 1e-6, 1.0)), 0.5, OWN_AXES),
    Hard("thin disc", _same((1.0, 1.0, 0.0)), 0.5, OWN_AXES),
    Hard("turned, near sphere", _same((0.5, 0.5, 0.5)), 1e-8, TURN),
    Hard(
        "turned, ill-conditioned",
        {"f32": (1e-5, 2e-5, 1.0), "f64": (1e-9, 2e-9, 1.0)},
        0.5,
        TURN,
    ),
)


def inverted(scene: Scene) -> list[Tensor]:
    """Return the tensors that must be definite, since the equations divide by them."""
    tensors = [d for d in scene.demands if isinstance(d, Tensor)]
    return [t for t in tensors if t.relation == "positive"]


def bodies_taken(scene: Scene) -> tuple[Hard, ...]:
    """Return the kinds of hard bodies that a scene's parameters can describe."""
    for tensor in inverted(scene):
        entered = [_entered(scene, f) for f in tensor.whole]
        moments, products = entered[:3], tensor.whole[3:]
        if all(entered) and len(set(entered)) == 6:
            return BODIES
        straight = all(p == ZERO for p in products)
        distinct = len({m for m in moments if m is not None})
        if straight and (distinct == 3 or (distinct == 2 and None not in moments)):
            return tuple(hard for hard in BODIES if hard.axes is OWN_AXES)
    return ()


def _entered(scene: Scene, formula: Formula | None) -> str | None:
    free = {p.name for p in scene.parameters if p.value is None}
    named = formula is not None and formula.operator == "symbol" and formula.name in free
    return formula.name if named and formula is not None else None


def hard_body(scene: Scene, hard: Hard, dice: Random, precision: Precision) -> dict[str, float]:
    """Return the parameters of a hard body, and of wheels that are light enough for it."""
    a, b, c = (x * (1 + hard.spread * dice.random()) for x in hard.second[precision.name])
    (tensor, *_), moments = inverted(scene), inverted(scene)[0].whole[:3]
    alone = [axis for axis, m in zip("xyz", moments, strict=True) if moments.count(m) == 1]
    if len(alone) == 1:
        a, b, c = _symmetric((a, b, c), alone[0])
    principal = (b + c, c + a, a + b)
    whole = _turned(principal, hard.axes)
    entries = [float(rounded(Fraction(x), precision.dtype)) for x in whole]
    values = {
        f.name: x
        for f, x in zip(tensor.whole, entries, strict=True)
        if f is not None and f.operator == "symbol"
    }
    for axial in (d.formula for d in scene.demands if _of_wheel(d)):
        if axial.operator == "symbol":
            light = min(principal) * (0.1 + 0.1 * dice.random())
            values[axial.name] = float(rounded(Fraction(light), precision.dtype))
    return values


def _of_wheel(demand: Demand) -> TypeGuard[Above]:
    return isinstance(demand, Above) and demand.kind == "inertia"


def _symmetric(second: Triple, axis: str) -> Triple:
    across = second[0] if axis == "z" else second[1]
    along = second[2]
    return tuple(along if name == axis else across for name in "xyz")  # type: ignore[return-value]


def _turned(moments: Triple, turn: Sequence[float]) -> tuple[float, ...]:
    """Return moments and products (+sum x y dm) of a turned body."""
    rows = [turn[0:3], turn[3:6], turn[6:9]]
    entry = [
        [added(rows[i][n] * moments[n] * rows[k][n] for n in range(3)) for k in range(3)]
        for i in range(3)
    ]
    own = [entry[0][0], entry[1][1], entry[2][2], -entry[0][1], -entry[0][2], -entry[1][2]]
    return tuple(own)


def admissible(scene: Scene, values: Mapping[str, Any]) -> Any:
    """Tell whether a scene's parameters describe bodies, wheels included; of columns, which do.

    A body keeps the triangle inequality: its second moments are not negative.
    """
    fits = solvable(scene, values)
    for tensor in inverted(scene):
        whole, size = _tensor(scene, values, tensor.whole), _size(scene, values, tensor)
        half = (whole[0][0] + whole[1][1] + whole[2][2]) / 2
        second = [[(half if i == k else 0.0) - whole[i][k] for k in range(3)] for i in range(3)]
        fits = fits & _semidefinite(second, size)
    return fits


def solvable(scene: Scene, values: Mapping[str, Any]) -> Any:
    """Tell whether no tensor that equations divide by has a negative moment.

    That is all that the equations need.
    """
    fits = np.True_
    for tensor in inverted(scene):
        rest = _tensor(scene, values, without_wheels(tensor))
        fits = fits & _semidefinite(rest, _size(scene, values, tensor))
    return fits


def without_wheels(tensor: Tensor) -> Entries:
    """Return the entries of a tensor, those that are not asked about as they are of the whole."""
    pairs = zip(tensor.entries, tensor.whole, strict=True)
    return tuple(whole if own is None else own for own, whole in pairs)


def _size(scene: Scene, values: Mapping[str, Any], tensor: Tensor) -> Any:
    whole = _tensor(scene, values, tensor.whole)
    return np.abs(whole[0][0]) + np.abs(whole[1][1]) + np.abs(whole[2][2])


def _tensor(scene: Scene, values: Mapping[str, Any], entries: Entries) -> list[list[Any]]:
    fixed = {p.name: float(p.value) for p in scene.parameters if p.value is not None}
    numbers = {**values, **fixed}
    known = arithmetics(np.float64).own
    own: Arithmetic = {
        **known,
        "number": float,
        "power": _power,
        "tan": lambda x: known["sin"](x) / known["cos"](x),
    }
    with np.errstate(all="ignore"):
        xx, yy, zz, xy, xz, yz = (
            np.float64(0) if f is None else np.asarray(evaluate(f, numbers, own)) for f in entries
        )
    return [[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]]


def _power(x: Any, n: int) -> Any:
    product = x * 0 + 1.0
    for _ in range(abs(n)):
        product = product * x
    return product if n >= 0 else 1 / product


def _semidefinite(m: list[list[Any]], size: Any) -> Any:
    """Tell whether no principal minor is negative, but for rounding beside ``size``."""
    (a, d, e), (_, b, f), (_, _, c) = m
    with np.errstate(all="ignore"):
        a, b, c = (x + SLACK * size for x in (a, b, c))
        whole = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)
        minors = (a, b, c, whole, a * b - d * d, a * c - e * e, b * c - f * f)
        return reduce(np.logical_and, [minor >= 0 for minor in minors])
