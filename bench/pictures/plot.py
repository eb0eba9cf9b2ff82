"""Error against cost on two logarithmic axes, as points of a picture."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

Line = Sequence[tuple[float, float]]


@dataclass(frozen=True)
class Axis:
    """Powers of ten from ``low`` to ``high`` along pixels from ``first`` to ``last``."""

    low: int
    high: int
    first: float
    last: float

    def at(self, value: float) -> float:
        """Return the pixel of a value, to a tenth.

        >>> Axis(0, 2, 10, 30).at(10)
        20.0
        """
        part = (math.log10(value) - self.low) / (self.high - self.low)
        return round(self.first + part * (self.last - self.first), 1)

    def ticks(self, every: int) -> list[tuple[float, int]]:
        """Return pixel and exponent of every so many powers of ten."""
        return [(self.at(10.0**n), n) for n in range(self.low, self.high + 1, every)]


def improving(points: Iterable[tuple[float, float]]) -> Line:
    """Return cost and error of points from cheap to dear, down to the least error.

    What lies behind it is rounding: more steps for more of it.

    >>> improving([(3, 0.5), (1, 9.0), (2, 1.0), (4, 0.7)])
    [(1, 9.0), (2, 1.0), (3, 0.5)]
    """
    ordered = sorted(points)
    least = min(ordered, key=lambda point: point[1])
    return ordered[: ordered.index(least) + 1]
