"""The largest of errors or gaps, which no value that is not a number can hide behind.

``max`` compares, and every comparison with a NaN is false: a NaN that is not first would be lost.
"""

import math
from collections.abc import Iterable
from typing import Any

from flint import arb


def largest(numbers: Iterable[Any]) -> float:
    """Return the largest of some numbers, infinite if any of them is not finite.

    numbers : floats, balls, or numbers of many digits; at least one

    >>> largest([1, 2.5]), largest([1.0, math.nan]), largest([-math.inf, 1.0])
    (2.5, inf, inf)
    """
    return max(float(x) if _finite(x) else math.inf for x in numbers)


def _finite(x: Any) -> bool:
    return bool(x.is_finite()) if isinstance(x, arb) else math.isfinite(x)
