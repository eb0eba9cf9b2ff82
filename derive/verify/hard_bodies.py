"""Bodies to check at: which inertias are bodies, and the ones that are hard to compute with.

A tensor is a body's if its second moments are not negative, which is the triangle inequality of
the principal moments. A hard body is described by ratios of its second moments, and made of the
scene's own parameters: moments, products, masses and lengths, whatever its tensor is made of.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from random import Random
from typing import Any

import numpy as np

from derive.program.added import added
from derive.program.arithmetic import rounded
from derive.program.precision import Precision
from derive.scene import Scene
from derive.scene.formula import ZERO, Arithmetic, Formula, evaluate
from derive.scene.machine import Above, Entries, Tensor
from derive.verify.columns import arithmetics
from derive.verify.ratios import in_ratios

Principal = tuple[float, float, float]
SLACK = 1e-12
"""Of the triangle inequality, relative to the trace: a disc obeys it with equality."""
THIN = 4e-6
"""A moment that a rod has about its own axis, beside 1 across: none will do as well."""
OWN_AXES = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
TURN = (0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6)  # a rotation, exact in decimals


@dataclass(frozen=True)
class Hard:
    """A kind of body: second moments along its own axes, for the precision's smallest step.

    Turned bodies are full tensors; others lie along their principal axes.
    """

    kind: str
    second: Mapping[str, Principal]  # by precision: sum x^2 dm, sum y^2 dm, sum z^2 dm
    spread: float  # relative spread of the second moments
    axes: tuple[float, ...]  # the turn from them to the scene's axes, row by row


def _same(second: Principal) -> dict[str, Principal]:
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


def bodies(scene: Scene) -> list[Tensor]:
    """Return the tensors of bodies of which a scene knows every entry."""
    tensors = [d for d in scene.demands if isinstance(d, Tensor)]
    return [t for t in tensors if None not in t.whole]


def hard_body(
    scene: Scene, place: int, hard: Hard, start: Mapping[str, float], of: tuple[Random, Precision]
) -> dict[str, float] | None:
    """Return parameters at which the body at a place is a hard one, None if there are none.

    They are those next to ``start``, of a body of any size; wheels are light enough for it.
    """
    dice, precision = of
    a, b, c = (x * (1 + hard.spread * dice.random()) for x in hard.second[precision.name])
    tensor = bodies(scene)[place]
    entries = tensor.given or tensor.whole
    alone = [axis for axis, m in zip("xyz", entries, strict=False) if entries[:3].count(m) == 1]
    if len(alone) == 1:
        a, b, c = _symmetric((a, b, c), alone[0])
    principal = (b + c, c + a, a + b)
    xx, yy, zz, *products = _turned(principal, hard.axes)
    moments = [0.0 if f == ZERO and x < THIN else x
               for f, x in zip(entries, (xx, yy, zz), strict=False)]  # fmt: skip
    light = {wheel: min(principal) * (0.1 + 0.1 * dice.random()) for wheel in _wheels(scene)}
    ratios = zip(entries, (*moments, *products), strict=True)
    rows = [*((f, x) for f, x in ratios if f is not None), *light.items()]
    found = in_ratios(scene.parameters, rows, start)
    if found is None:
        return None
    values = {n: float(rounded(x, precision.dtype)) for n, x in found.items()}
    return values if solvable(scene, {**start, **values}) else None


def _symmetric(second: Principal, axis: str) -> Principal:
    across = second[0] if axis == "z" else second[1]
    along = second[2]
    return tuple(along if name == axis else across for name in "xyz")  # type: ignore[return-value]


def _turned(moments: Principal, turn: Sequence[float]) -> tuple[float, ...]:
    """Return moments and products (+sum x y dm) of a turned body."""
    rows = [turn[0:3], turn[3:6], turn[6:9]]
    entry = [
        [added(rows[i][n] * moments[n] * rows[k][n] for n in range(3)) for k in range(3)]
        for i in range(3)
    ]
    own = [entry[0][0], entry[1][1], entry[2][2], -entry[0][1], -entry[0][2], -entry[1][2]]
    return tuple(own)


def _wheels(scene: Scene) -> list[Formula]:
    """Return the moments of wheels that a body holds beside its own tensor."""
    above = [d for d in scene.demands if isinstance(d, Above)]
    return list(dict.fromkeys(d.formula for d in above if d.kind == "inertia"))


def admissible(scene: Scene, values: Mapping[str, Any]) -> Any:
    """Tell whether a scene's parameters describe bodies, wheels included; of columns, which do.

    A body keeps the triangle inequality: its second moments are not negative.
    """
    fits = solvable(scene, values)
    for tensor in bodies(scene):
        whole, size = _tensor(scene, values, tensor.whole), _size(scene, values, tensor)
        half = (whole[0][0] + whole[1][1] + whole[2][2]) / 2
        second = [[(half if i == k else 0.0) - whole[i][k] for k in range(3)] for i in range(3)]
        fits = fits & _semidefinite(second, size)
    return fits


def solvable(scene: Scene, values: Mapping[str, Any]) -> Any:
    """Tell whether masses and lengths are positive, and no tensor has a negative moment.

    That is all that the equations need.
    """
    fits = np.True_
    for demand in scene.demands:
        if isinstance(demand, Above):
            fits = fits & (_values(scene, values, (demand.formula,))[0] > 0)
        else:
            own = _tensor(scene, values, without_wheels(demand))
            fits = fits & _semidefinite(own, _size(scene, values, demand))
    return fits


def without_wheels(tensor: Tensor) -> Entries:
    """Return the entries of a tensor, those that are not asked about as they are of the whole."""
    pairs = zip(tensor.entries, tensor.whole, strict=True)
    return tuple(whole if own is None else own for own, whole in pairs)


def _size(scene: Scene, values: Mapping[str, Any], tensor: Tensor) -> Any:
    whole = _tensor(scene, values, tensor.whole)
    return np.abs(whole[0][0]) + np.abs(whole[1][1]) + np.abs(whole[2][2])


def _tensor(scene: Scene, values: Mapping[str, Any], entries: Entries) -> list[list[Any]]:
    xx, yy, zz, xy, xz, yz = _values(scene, values, entries)
    return [[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]]


def _values(scene: Scene, values: Mapping[str, Any], formulas: Entries) -> list[Any]:
    """Return what formulas of the parameters are, 0 where there is none."""
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
        return [
            np.float64(0) if f is None else np.asarray(evaluate(f, numbers, own)) for f in formulas
        ]


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
