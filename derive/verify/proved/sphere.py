"""Quaternions of about unit length: boxes of the ranges that hold such, and points."""

from collections.abc import Mapping, Sequence
from functools import reduce
from operator import add

import numpy as np

from derive.verify.operators import Column
from derive.verify.proved.forms import (
    Affine,
    chosen_form,
    difference_of_forms,
    opposite,
    plain_form,
    root_form,
    side_form,
    square_form,
    sum_of_forms,
)
from derive.verify.proved.ranges import Interval

UNIT = (0.999, 1.001)
"""Of the squared length of a quaternion that is given."""
NARROWER = 1e-6
"""As much of a length is kept from these ends, more than floats round."""
MARGIN = 1e-12
"""More than rounding takes from ends that are found by roots."""


def near_the_sphere(
    quaternions: Sequence[Sequence[int]],
    lows: Column,
    highs: Column,
    shell: tuple[float, float] = UNIT,
) -> tuple[Column, Column]:
    """Return boxes without those that hold no unit quaternion, each as small as holds all."""
    fits = np.ones(lows.shape[1], dtype=bool)
    lows, highs = lows.copy(), highs.copy()
    for places in quaternions:
        low, high = _squares(lows[list(places)], highs[list(places)])
        fits &= (low <= shell[1]) & (high >= shell[0])
        for place in places:
            others = [k for k in places if k != place]
            _narrow(lows, highs, place, _squares(lows[others], highs[others]), shell)
    fits &= np.all(lows <= highs, axis=0)
    return lows[:, fits], highs[:, fits]


def of_about_unit_length(each: Column, shell: tuple[float, float] = UNIT) -> Column:
    """Return vectors, a column each, as little longer or shorter as brings them near unit length.

    >>> of_about_unit_length(np.array([[3.0], [4.0]])).round(4)
    array([[0.6003],
           [0.8004]])
    """
    size = np.sqrt(reduce(add, (x * x for x in each)))
    least, most = np.sqrt(shell[0]) * (1 + NARROWER), np.sqrt(shell[1]) * (1 - NARROWER)
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


def _narrow(
    lows: Column,
    highs: Column,
    place: int,
    others: tuple[Column, Column],
    shell: tuple[float, float],
) -> None:
    """Make a side of boxes as short as holds all unit quaternions, the others' squares known."""
    most = np.sqrt(np.maximum(shell[1] - others[0], 0.0)) * (1 + MARGIN)
    least = np.sqrt(np.maximum(shell[0] - others[1], 0.0)) * (1 - MARGIN)
    low, high = np.maximum(lows[place], -most), np.minimum(highs[place], most)
    lows[place] = np.where(low > -least, np.maximum(low, least), low)
    highs[place] = np.where(high < least, np.minimum(high, -least), high)


def forms_of_sides(
    boxes: Mapping[str, Interval],
    quaternions: Sequence[Sequence[str]],
    shell: tuple[float, float],
) -> dict[str, Affine]:
    """Return the forms of what is given in boxes, a symbol for each side that has a width.

    The largest component of a quaternion follows from the others', where that says more.
    """
    wide = [n for n, (low, high) in boxes.items() if np.any(low < high)]
    found = {n: side_form(boxes[n], k, len(wide)) for k, n in enumerate(wide)}
    found |= {n: plain_form(ends, len(wide)) for n, ends in boxes.items() if n not in found}
    for names in quaternions:
        found |= _on_the_sphere({n: (boxes[n], found[n]) for n in names}, shell)
    return found


def _on_the_sphere(
    each: Mapping[str, tuple[Interval, Affine]], shell: tuple[float, float]
) -> dict[str, Affine]:
    """Return the forms of a quaternion's components, of which one may follow from the others."""
    boxes = [ends for ends, _ in each.values()]
    least = np.array([np.minimum(np.abs(a), np.abs(b)) * (a * b > 0) for a, b in boxes])
    largest, made = np.argmax(least, axis=0), dict[str, Affine]()
    for k, (name, (ends, form)) in enumerate(each.items()):
        others = [square_form(f) for n, (_, f) in each.items() if n != name]
        unit = tuple(np.full_like(ends[0], end) for end in shell)
        left = difference_of_forms(
            plain_form((unit[0], unit[1]), len(form.parts)), reduce(sum_of_forms, others)
        )
        low, high = left.ends
        root = root_form(left, (np.maximum(low, 0.0), high))
        root = chosen_form(root, opposite(root), ends[0] > 0)
        says = (largest == k) & (low > 0) & (root.rest < form.spread / 2)
        made[name] = chosen_form(root, form, says)
    return made
