"""Which inputs a member has: its number alone says, whatever chunk or machine it is moved in.

Members of grids are numbered point by point, and all points have the same draws. Draws are points
of a scrambled Sobol sequence. Behind them stand, if sensitivities are asked for, the members that
Saltelli's estimates need: for each of two independent points, the first with one of its numbers
taken from the second, for every number, and both themselves.
"""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.solve.sweep.vary import FloatColumn, Spread

BITS = 32
"""Of a part of one, and of the number of a draw; SciPy passes over draws by no more.

Half a bit is added: parts are above 0 and below 1."""


@dataclass(frozen=True)
class Design:
    """The members of a sweep.

    samples : draws at each point of the grids, one if nothing is drawn
    pairs   : of points for sensitivities, a power of two, or 0
    """

    spreads: tuple[Spread, ...]
    samples: int
    pairs: int
    seed: int

    @property
    def drawn(self) -> tuple[Spread, ...]:
        """Return what is drawn."""
        return tuple(s for s in self.spreads if not s.count)

    @property
    def points(self) -> int:
        """Return how many points the grids have."""
        return prod(s.count for s in self.spreads if s.count)

    @property
    def plain(self) -> int:
        """Return how many members there are but for those for sensitivities."""
        return self.points * self.samples

    @property
    def members(self) -> int:
        """Return how many members there are."""
        return self.plain + self.pairs * (len(self.spreads) + 2)

    def values(self, first: int, count: int) -> dict[str, FloatColumn]:
        """Return by name what varies, of so many members from the first on."""
        plain = max(0, min(count, self.plain - first))
        parts = [self._plain(first, plain)] if plain else []
        if count > plain:
            parts.append(self._paired(first + plain - self.plain, count - plain))
        return {s.name: np.concatenate([p[s.name] for p in parts]) for s in self.spreads}

    def _plain(self, first: int, count: int) -> dict[str, FloatColumn]:
        number = np.arange(first, first + count)
        place, draw = number % self.points, number // self.points
        found: dict[str, FloatColumn] = {}
        for s in self.spreads:
            if s.count:
                found[s.name] = s.at_place(place % s.count)
                place = place // s.count
        if self.drawn:
            low = int(draw[0])
            parts = sobol(len(self.drawn), self.seed, low, int(draw[-1]) + 1 - low)
            for k, s in enumerate(self.drawn):
                found[s.name] = s.values(parts[draw - low, k])
        return found

    def _paired(self, first: int, count: int) -> dict[str, FloatColumn]:
        size = len(self.spreads)
        number = np.arange(first, first + count)
        pair, which = number // (size + 2), number % (size + 2)
        low = int(pair[0])
        parts = sobol(2 * size, self.seed, low, int(pair[-1]) + 1 - low)[pair - low]
        found = {}
        for k, s in enumerate(self.spreads):
            second = (which == k + 1) | (which == size + 1)
            chosen = np.where(second, parts[:, size + k], parts[:, k])
            found[s.name] = (
                s.at_place((chosen * s.count).astype(np.int64)) if s.count else s.values(chosen)
            )
        return found


def sobol(size: int, seed: int, first: int, count: int) -> FloatColumn:
    """Return points of a scrambled Sobol sequence: (count, size), above 0 and below 1."""
    sequence = _sequence(size, seed)
    if first:
        sequence.fast_forward(first)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # that any count but a power of two is worse
        points: NDArray[Any] = sequence.random(count)
    found: FloatColumn = points + 2.0 ** -(BITS + 1)
    return found


def _sequence(size: int, seed: int) -> Any:
    from scipy.stats import qmc

    return qmc.Sobol(size, scramble=True, bits=BITS, rng=np.random.default_rng(seed))


def in_pairs(values: FloatColumn, size: int) -> Sequence[FloatColumn]:
    """Return the values of members for sensitivities as rows of a pair, those of whole pairs."""
    whole = len(values) // (size + 2)
    return list(values[: whole * (size + 2)].reshape(whole, size + 2))
