"""How a number scatters: ``uniform(1, 2)``, ``normal(0.1, 0.01)``, a grid ``0..1:11``.

Each is a formula from a part of one, which a sequence gives, to a value: whoever knows the part
knows the value. Texts are read by the rules here; Python never evaluates them.
"""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.program.program import Quantity
from derive.scene import SceneError
from derive.scene.table import nearest, shown
from derive.scene.unit import behind
from derive.solve.settings import number, settable
from derive.solve.told import met

FloatColumn = NDArray[np.float64]
MOST_OF_GRID = 1_000_000
SIGMAS = 3.0
"""Standard deviations to either side that count as where a normal value may lie."""
CALLED = re.compile(r"([a-z]+)\(([^()]*)\)")
GRID = re.compile(r"([^:]+?)\.\.([^:]+):([^:]*)")
EXAMPLES = "uniform(1, 2), normal(0.1, 0.01), normal(0.1, 0.01, 0, 0.2), loguniform(1, 10), 0..1:11"
WHOLE = re.compile(r"[0-9]{1,7}")


@dataclass(frozen=True)
class Spread:
    """How one component scatters.

    kind : "uniform", "normal", "loguniform" or "grid"
    ends : of a normal value mean, deviation and, if it is cut off, both ends; else both ends
    count : of a grid, its values; else 0
    """

    name: str
    kind: str
    ends: tuple[float, ...]
    count: int = 0

    @property
    def within(self) -> tuple[float, float]:
        """Return where values lie, of a normal one ``SIGMAS`` deviations to either side."""
        if self.kind != "normal":
            return self.ends[0], self.ends[1]
        if len(self.ends) == 4:
            return self.ends[2], self.ends[3]
        return self.ends[0] - SIGMAS * self.ends[1], self.ends[0] + SIGMAS * self.ends[1]

    @property
    def middle(self) -> float:
        """Return a value in the middle: a mean, or halfway between both ends."""
        if self.kind == "normal":
            return min(max(self.ends[0], self.within[0]), self.within[1])
        if self.kind == "loguniform":
            return math.sqrt(self.ends[0]) * math.sqrt(self.ends[1])
        return self.ends[0] / 2 + self.ends[1] / 2

    def values(self, parts: FloatColumn) -> FloatColumn:
        """Return the values for parts of one, each above 0 and below 1."""
        return SPREADS[self.kind](self.ends, parts)

    def at_place(self, place: NDArray[np.int64]) -> FloatColumn:
        """Return values of a grid by their places."""
        low, high = self.ends
        last = self.count - 1
        part = place / last if last else 0.0 * place
        between = low + (high - low) * part
        found: FloatColumn = np.where(place == last, high if last else low, between)
        return found


def _uniform(ends: Sequence[float], parts: FloatColumn) -> FloatColumn:
    low, high = ends
    found: FloatColumn = np.clip(low + (high - low) * parts, low, high)
    return found


def _loguniform(ends: Sequence[float], parts: FloatColumn) -> FloatColumn:
    low, high = ends
    found = low * by_python(math.exp, math.log(high / low) * parts)
    return np.clip(found, low, high)


def _normal(ends: Sequence[float], parts: FloatColumn) -> FloatColumn:
    from scipy.special import ndtr, ndtri

    mean, deviation = ends[:2]
    sign = 1.0
    if len(ends) == 4:
        # parts near 1 are told apart by no more than 2^-53: what lies above the mean is mirrored
        sign = -1.0 if ends[2] > mean else 1.0
        low, high = (float(ndtr(sign * (end - mean) / deviation)) for end in ends[2:])
        parts = low + (high - low) * parts
    found: FloatColumn = mean + sign * deviation * np.asarray(ndtri(parts))
    return np.clip(found, ends[2], ends[3]) if len(ends) == 4 else found


def _weight(mean: float, deviation: float, low: float, high: float) -> float:
    """Return the part of normal values that lies between both ends."""
    apart = (abs(end - mean) / deviation / math.sqrt(2) for end in (low, high))
    first, second = map(math.erfc, apart)
    if low <= mean <= high:
        return 1 - (first + second) / 2
    return abs(first - second) / 2


def by_python(function: Callable[[float], float], values: Any) -> FloatColumn:
    """Return a function of Python's at every value: NumPy's own differ from machine to machine."""
    found = np.frompyfunc(partial(_or_nan, function), 1, 1)(values)
    return np.asarray(found, dtype=np.float64)


def _or_nan(function: Callable[[float], float], x: float) -> float:
    try:
        return function(x)
    except (ArithmeticError, ValueError):
        return math.nan


SPREADS: Mapping[str, Callable[[Sequence[float], FloatColumn], FloatColumn]] = {
    "uniform": _uniform,
    "loguniform": _loguniform,
    "normal": _normal,
}


def variations(
    scene: str, quantities: Sequence[Quantity], texts: object, values: Mapping[str, float]
) -> tuple[Spread, ...]:
    """Return how each component scatters, of texts by name.

    values : what is set, which cannot scatter as well
    Raises SceneError for names that there are none of, and for texts of another form.
    """
    if not isinstance(texts, Mapping):
        rule = "what varies is given by name, as {'m': 'uniform(1, 2)'}"
        raise SceneError(f"scene '{scene}': {rule}, not as {met(texts)}")
    found = []
    for name, text in texts.items():
        q = settable(scene, quantities, name)
        if name not in q.components:
            says = f"one component varies at a time, of {', '.join(q.components)}"
            raise SceneError(f"scene '{scene}': {says}, not {name}")
        if name in values:
            raise SceneError(f"scene '{scene}': '{name}' is set and varies; it can do one of both")
        if not isinstance(text, str):
            raise SceneError(f"scene '{scene}': {name} varies as a text says, not {met(text)}")
        found.append(_spread(f"{name}={text.strip()}"[:60], name, text.strip(), q.unit))
    if not found:
        raise SceneError(f"scene '{scene}': nothing varies; name what does, as m = 'uniform(1, 2)'")
    return tuple(found)


def _spread(label: str, name: str, text: str, unit: str) -> Spread:
    if grid := GRID.fullmatch(text):
        low, high = (number(label, end.strip(), unit) for end in grid.groups()[:2])
        count = int(grid[3]) if WHOLE.fullmatch(grid[3].strip()) else 0
        if not 0 < count <= MOST_OF_GRID:
            rule = f"a grid has a whole number of values, 1 to {MOST_OF_GRID}"
            raise SceneError(f"{label}: {rule}, not {shown(grid[3])}")
        _require_apart(label, low, high)
        return Spread(name, "grid", (low, high), count)
    called = CALLED.fullmatch(text)
    if called is None or called[1] not in SPREADS:
        hint = nearest(called[1], SPREADS) if called else ""
        rule = f"it varies as one of {EXAMPLES}"
        raise SceneError(f"{label}: {rule}, not {shown(text)}{hint}")
    ends = tuple(number(label, end.strip(), unit) for end in called[2].split(","))
    _require_ends(label, called[1], ends, unit)
    return Spread(name, called[1], ends)


def _require_apart(label: str, low: float, high: float) -> None:
    if not math.isfinite(high - low):
        rule = "what is between both ends must be a number"
        raise SceneError(f"{label}: {rule}, but they are {low:g} and {high:g}")


def _require_ends(label: str, kind: str, ends: Sequence[float], unit: str) -> None:
    if len(ends) != 2 and not (kind == "normal" and len(ends) == 4):
        rule = "takes mean and deviation, and may take both ends" if kind == "normal" else (
            "takes both ends")  # fmt: skip
        raise SceneError(f"{label}: {kind} {rule}, not {len(ends)} numbers")
    if kind == "normal" and ends[1] <= 0:
        rule = "a deviation is above zero"
        raise SceneError(f"{label}: {rule}, not {ends[1]:g}{behind(unit)}")
    if kind == "normal" and len(ends) == 4 and not _weight(*ends):
        says = "nothing of it that numbers can tell lies between"
        raise SceneError(f"{label}: {says} {ends[2]:g} and {ends[3]:g}{behind(unit)}")
    low, high = ends[-2:] if kind != "normal" or len(ends) == 4 else (0.0, 1.0)
    if not low < high:
        raise SceneError(f"{label}: the first end is below the second, but {low:g} to {high:g}")
    _require_apart(label, low, high)
    if kind == "loguniform" and low <= 0:
        raise SceneError(f"{label}: ends of loguniform are above zero, not {low:g}{behind(unit)}")
    if kind == "loguniform" and not math.isfinite(high / low):
        raise SceneError(f"{label}: the second end must be a number of times the first")
