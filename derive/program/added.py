"""Floats added up from left to right: the same bits under every version of Python.

The built-in ``sum`` compensates what floats lose from Python 3.12 on, and did not before.
"""

from collections.abc import Iterable


def added(values: Iterable[float]) -> float:
    """Return the sum of ``values``, rounded after each.

    >>> added([1e16, 1.0, 1.0, -1e16])
    0.0
    """
    total = 0.0
    for value in values:
        total += value
    return total
