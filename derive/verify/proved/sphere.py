"""Quaternions of about unit length: boxes of the ranges that hold such, and points."""

from collections.abc import Sequence
from functools import reduce
from operator import add

import numpy as np

from derive.verify.operators import Column

UNIT = (0.999, 1.001)
"""Of the squared length of a quaternion that is given."""
NARROWER = 1e-6
"""As much of a length is kept from these ends, more than floats round."""
MARGIN = 1e-12
"""More than rounding takes from ends that are found by roots."""


def near_the_sphere(
    quaternions: Sequence[Sequence[int]], lows: Column, highs: Column
) -> tuple[Column, Column]:
    """Return boxes without those that hold no unit quaternion, each as small as holds all."""
    fits = np.ones(lows.shape[1], dtype=bool)
    lows, highs = lows.copy(), highs.copy()
    for places in quaternions:
        low, high = _squares(lows[list(places)], highs[list(places)])
        fits &= (low <= UNIT[1]) & (high >= UNIT[0])
        for place in places:
            others = [k for k in places if k != place]
            _narrow(lows, highs, place, _squares(lows[others], highs[others]))
    fits &= np.all(lows <= highs, axis=0)
    return lows[:, fits], highs[:, fits]


def of_about_unit_length(each: Column) -> Column:
    """Return vectors, a column each, as little longer or shorter as brings them near unit length.

    >>> of_about_unit_length(np.array([[3.0], [4.0]])).round(4)
    array([[0.6003],
           [0.8004]])
    """
    size = np.sqrt(reduce(add, (x * x for x in each)))
    least, most = np.sqrt(UNIT[0]) * (1 + NARROWER), np.sqrt(UNIT[1]) * (1 - NARROWER)
    return np.asarray(each * (np.clip(size, least, most) / np.where(size > 0, size, 1.0)))


def _squares(lows: Column, highs: Column) -> tuple[Column, Column]:
    """Return the range of the squared length of vectors in boxes."""
    across = (lows <= 0) & (highs >= 0)
    most = np.maximum(np.abs(lows), np.abs(highs))
    least = np.where(across, 0.0, np.minimum(np.abs(lows), np.abs(highs)))
    low, high = np.zeros(lows.shape[1]), np.zeros(lows.shape[1])
    for a, b in zip(least, most, strict=True):
        low, high = low + a * a, high + b * b
    return low, high


def _narrow(lows: Column, highs: Column, place: int, others: tuple[Column, Column]) -> None:
    """Make a side of boxes as short as holds all unit quaternions, the others' squares known."""
    most = np.sqrt(np.maximum(UNIT[1] - others[0], 0.0)) * (1 + MARGIN)
    least = np.sqrt(np.maximum(UNIT[0] - others[1], 0.0)) * (1 - MARGIN)
    low, high = np.maximum(lows[place], -most), np.minimum(highs[place], most)
    lows[place] = np.where(low > -least, np.maximum(low, least), low)
    highs[place] = np.where(high < least, np.minimum(high, -least), high)
