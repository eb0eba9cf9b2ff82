"""The ranges of all that is given, and points in them: random ones, corners, zeros."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from random import Random
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sympy import Symbol

from derive.mechanics.words import Words
from derive.program.program import Quantity

RANDOM, CORNERS, NEAR = 96, 24, 2
SPECIAL = (0.0, np.pi / 4, np.pi / 2, np.pi, 3 * np.pi / 2)
BEYOND = 1e-9  # of a range: what bringing a point back may leave
SEED = "derive: sweep"


@dataclass(frozen=True)
class Box:
    """The range of every component that an expression may hold, and which of them are angles."""

    symbols: tuple[Symbol, ...]
    names: tuple[str, ...]
    low: NDArray[Any]
    high: NDArray[Any]
    turns: tuple[bool, ...]
    fixed: frozenset[Symbol]
    quaternions: tuple[slice, ...]
    onto: Any = None

    def brought(self, points: NDArray[Any]) -> NDArray[Any]:
        """Return points that fulfil the constraints; those that cannot are not among them."""
        if self.onto is None:
            return points
        found, fits = self.onto.brought(points)
        places = [*self.onto.places]
        spare = BEYOND * (self.high - self.low)
        low, high = (self.low - spare)[places], (self.high + spare)[places]
        inside = np.all((low <= found[:, places]) & (found[:, places] <= high), axis=1)
        return np.asarray(found[fits & inside])

    @cached_property
    def tried(self) -> NDArray[Any]:
        """Return the points of the ranges that are looked at first, on the constraints."""
        return self.brought(self.trials())

    def fulfilling(self, here: NDArray[Any]) -> NDArray[Any] | None:
        """Return the point nearest to one at which the constraints hold; None if none is found.

        From that point itself no way may lead onto them, as where slopes vanish. Data are kept.
        """
        if self.onto is None:
            return here
        every: dict[int, float] = {**self.onto.places, **self.onto.rates}
        trials, columns = self.trials(), [*every]
        points = np.tile(here, (len(trials), 1))
        points[:, columns] = trials[:, columns]
        found = self.brought(points)
        off = np.abs(found - here)[:, columns] / np.array([*every.values()])
        return np.asarray(found[np.argmin(off.max(axis=1))]) if len(found) else None

    def outside(self, point: NDArray[Any], places: Iterable[int]) -> str:
        """Return words for the first place beyond its range, "" if there is none."""
        for k in places:
            spare = BEYOND * (self.high[k] - self.low[k])
            if not self.low[k] - spare <= point[k] <= self.high[k] + spare:
                return f"{self.names[k]} = {point[k]:.4g}"
        return ""

    def trials(self) -> NDArray[Any]:
        """Return points of the ranges, (points, components)."""
        dice, size = Random(SEED), len(self.symbols)  # noqa: S311 - trial points, no secret
        rows = [[dice.random() for _ in range(size)] for _ in range(RANDOM)]
        rows += [[float(dice.randrange(2)) for _ in range(size)] for _ in range(CORNERS)]
        found = self.low + (self.high - self.low) * np.array(rows).reshape(len(rows), size)
        whole = [found]
        for k, turns in enumerate(self.turns):
            for x in self._special(k, turns):
                near = found[:NEAR].copy()
                near[:, k] = x
                whole.append(near)
        zero = found[:NEAR].copy()
        zero[:, (self.low <= 0) & (self.high >= 0)] = 0
        return np.vstack([*whole, zero])

    def _special(self, k: int, turns: bool) -> list[float]:  # noqa: FBT001
        each = [s * x for x in SPECIAL for s in (1, -1)] if turns else [0.0]
        return [x for x in dict.fromkeys(each) if self.low[k] <= x <= self.high[k]]


def ranges(words: Words) -> Box:
    """Return the ranges of all that is given, and of data left out by the user."""
    book = words.vocabulary
    each: list[tuple[Symbol, str, Quantity]] = [
        (book.symbols[c], c, q) for q in book.given() for c in q.components
    ]
    ends = [tuple(map(float, q.ends)) for _, _, q in each] + [(1.0, 2.0)] * len(words.hidden)
    return Box(
        (*(s for s, _, _ in each), *words.hidden),
        (*(c for _, c, _ in each), *words.hidden.values()),
        np.array([low for low, _ in ends]),
        np.array([high for _, high in ends]),
        (*(q.unit == "rad" for _, _, q in each), *(False for _ in words.hidden)),
        frozenset((*(s for s, _, q in each if q in book.parameters), *words.hidden)),
        tuple(slice(k, k + 4) for k, (_, c, q) in enumerate(each)
              if q.is_quaternion and c == q.components[0]),
        words.held[0].onto if words.held else None,
    )  # fmt: skip
