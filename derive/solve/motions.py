"""Steady and small motions of a machine: roots by CasADi, frequencies by an eigenvalue routine."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any

import casadi
import numpy as np
from numpy.typing import NDArray

from derive.program.largest import largest
from derive.scene import SceneError
from derive.scene.table import one_of
from derive.solve.instrument import Instrument
from derive.solve.lacking import advice_on

STARTS = 200  # of one unknown; of several, so many in all
SAME = 1e-7  # distance of two roots that are one, beside the root or, near 0, beside its range
LEFT = 1e-9  # of the largest residual on the grid: Newton's method leaves less at any root
UNSTABLE = 1e-6  # growth beside the largest eigenvalue that is more than rounding
NOTHING = 1e-15  # of the largest value in the range: a root so near to 0 is 0
HALVINGS = 60


def _unknown(found: Instrument, steady: object) -> tuple[str, ...]:
    scene = found.library.scene
    if not scene.steady:
        raise SceneError(advice_on(scene, "steady", "a search for roots"))
    return scene.steady[one_of(steady, f"scene '{found.name}': steady", scene.steady)].unknown


def roots(
    found: Instrument, given: Mapping[str, float], steady: str = "steady"
) -> list[dict[str, float]]:
    """Return the unknowns of every steady motion in the declared ranges, by CasADi's root finder.

    given : all that the residual needs but its unknowns       steady : the function that vanishes
    """
    names = _unknown(found, steady)
    x = casadi.SX.sym("x", len(names))
    left = found.answer(steady, dict(given) | {n: x[k] for k, n in enumerate(names)})
    residual = casadi.Function("residual", [x], [casadi.vertcat(*left.values())])
    grid = _grid(found, names)
    size = max((s for p in grid if np.isfinite(s := _size(residual, p))), default=0.0)
    rule = {"x": x, "g": casadi.vertcat(*left.values()) / (size or 1.0)}
    finder = casadi.rootfinder("finder", "newton", rule, {"error_on_fail": False})
    widest = np.abs([_bounds(found, name) for name in names]).max(axis=1)
    near = SAME * widest
    kept: list[NDArray[Any]] = []
    for start in _starts(grid, residual):
        root = np.array(finder(x0=start)["x"]).ravel()
        root = np.where(np.abs(root) <= NOTHING * widest, 0.0, root)
        known = any(np.allclose(root, other, rtol=SAME, atol=near) for other in kept)
        vanishes = _size(residual, root) <= LEFT * size
        if not known and vanishes and _within(found, names, root):
            kept.append(root)
    return [dict(zip(names, map(float, root), strict=True)) for root in sorted(kept, key=tuple)]


def _bounds(found: Instrument, name: str) -> tuple[float, float]:
    q = next(q for q in found.quantities() if name in q.components)
    return float(q.low or 0), float(q.high or 0)


def _grid(found: Instrument, names: Sequence[str]) -> list[NDArray[Any]]:
    count = STARTS if len(names) == 1 else max(3, round(STARTS ** (1 / len(names))))
    axes = [np.linspace(*_bounds(found, name), count) for name in names]
    return [np.array(point) for point in product(*axes)]


def _starts(grid: Sequence[NDArray[Any]], residual: Any) -> Iterator[NDArray[Any]]:
    """Yield starts: where one residual changes sign, or the grid of several unknowns."""
    if len(grid[0]) > 1:
        yield from grid
        return
    values = [float(residual(v)) for v in grid]
    for (a, here), (b, there) in pairwise(zip(grid, values, strict=True)):
        if here * there <= 0:
            slope = there - here
            yield a + (-here / slope if slope else 0.5) * (b - a)


def _size(residual: Any, point: NDArray[Any]) -> float:
    """Return how large the largest residual is, infinite where it is no number."""
    return largest(np.abs(np.array(residual(point))).ravel())


def _within(found: Instrument, names: Sequence[str], root: NDArray[Any]) -> bool:
    ends = [_bounds(found, name) for name in names]
    return all(low <= x <= high for x, (low, high) in zip(root, ends, strict=True))


def eigenvalues(matrices: Mapping[str, float]) -> NDArray[Any]:
    """Return the eigenvalues of small motion, from the components of the three matrices."""
    each = []
    for name in ("mass_matrix", "damping_matrix", "stiffness_matrix"):
        own = [v for c, v in matrices.items() if c.startswith(f"{name}_")]
        size = round(len(own) ** 0.5)
        each.append(np.array(own).reshape(size, size).T)
    M, D, K = each
    size = len(M)
    inverse = np.linalg.inv(M)
    whole = np.block([[np.zeros((size, size)), np.eye(size)], [-inverse @ K, -inverse @ D]])
    found: NDArray[Any] = np.linalg.eigvals(whole)
    return found


@dataclass(frozen=True)
class SmallMotion:
    """Circular frequencies in rad/s, rising, and the fastest growth in 1/s, 0 where none grows."""

    frequencies: list[float]
    growth: float


def small_motion(found: Instrument, given: Mapping[str, float]) -> SmallMotion:
    """Return how small motions go; no growth is what is no more than rounding.

    Raises SceneError if the scene does not ask for them, or its mass matrix has no inverse.
    """
    if "linearised" not in found.library.scene.wanted:
        raise SceneError(advice_on(found.library.scene, "linearised", "small motion"))
    try:
        every = eigenvalues(found.answer("linearised", given))
    except np.linalg.LinAlgError as error:
        raise SceneError(
            f"scene '{found.name}': small motion needs a mass matrix that can be inverted, "
            f"but with these values: {error}"
        ) from None
    least = UNSTABLE * max(abs(every), default=0.0)
    fastest = float(max(every.real, default=0.0))
    rising = sorted(float(v.imag) for v in every if v.imag > least)
    return SmallMotion(rising, fastest if fastest > least else 0.0)


def frequencies(found: Instrument, given: Mapping[str, float]) -> list[float]:
    """Return the circular frequencies of small motion, rising, in rad/s."""
    return small_motion(found, given).frequencies


def growth(found: Instrument, given: Mapping[str, float]) -> float:
    """Return the fastest growth of small motion, in 1/s; 0 if it is no more than rounding."""
    return small_motion(found, given).growth


Carried = Callable[[Instrument, Mapping[str, float]], Sequence[Mapping[str, float]]]
"""From values to those of each motion that is small around: themselves, or each steady one."""


def limits(
    found: Instrument,
    given: Mapping[str, float],
    name: str,
    carried: Carried = lambda _, values: (values,),
) -> list[float]:
    """Return the values of one quantity, in its declared range, at which stability changes.

    Of steady motions that are looked for at each value, so are those at which their number does.
    """

    def stable(value: float) -> tuple[bool, ...]:
        each = carried(found, dict(given) | {name: value})
        return tuple(growth(found, values) == 0 for values in each)

    grid = list(map(float, np.linspace(*_bounds(found, name), STARTS)))
    told = list(map(stable, grid))
    changes = [k for k in range(STARTS - 1) if told[k] != told[k + 1]]
    return [_halved(stable, (grid[k], grid[k + 1])) for k in changes]


def _halved(stable: Callable[[float], tuple[bool, ...]], ends: tuple[float, float]) -> float:
    low, high = ends
    first = stable(low)
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        if stable(middle) == first:
            low = middle
        else:
            high = middle
    return (low + high) / 2
