"""How far the ends of motions are from where they truly are, one number a state.

Attitudes and angles in rad, all else beside the largest size on the way of what has its unit; the
largest counts.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from derive.program.program import Quantity, placed
from derive.report.reference import End
from derive.verify.operators import Column

COUNTED = ("rad",)
"""Units of what is counted as it is: an angle's size says nothing of how far it may be off."""


@dataclass(frozen=True)
class Ends:
    """Where motions truly end: (components, states), in two doubles, and what gaps are beside."""

    high: Column
    low: Column
    sizes: Column


def true_ends(states: Sequence[Quantity], each: Sequence[End]) -> Ends:
    """Return the true ends of several motions."""
    names = [c for q in states for c in q.components]
    high, low = (np.array([[end.state[c][k] for end in each] for c in names]) for k in (0, 1))
    sizes = np.array([[end.sizes[c] for end in each] for c in names])
    return Ends(high, low, beside_what(states, sizes))


def beside_what(states: Sequence[Quantity], sizes: Column) -> Column:
    """Return what gaps of each component are taken beside, from its own largest size."""
    spans = list(placed(states))
    of_unit = {q.unit: np.max([sizes[s].max(axis=0) for r, s in spans if r.unit == q.unit], axis=0)
               for q in states}  # fmt: skip
    beside = np.ones_like(sizes)
    for q, span in spans:
        if q.unit not in COUNTED and not q.is_quaternion:
            beside[span] = np.where(of_unit[q.unit] > 0, of_unit[q.unit], 1.0)
    return beside


def errors_at_end(states: Sequence[Quantity], found: Column, true: Ends) -> Column:
    """Return the error of each state's end; infinite where one is no number.

    found : (components, states), in double
    """
    found = found.astype(np.float64)
    each = []
    with np.errstate(all="ignore"):
        for q, span in placed(states):
            high, low = true.high[span], true.low[span]
            if q.is_quaternion:
                each.append(_angle(found[span], high, low))
            else:
                gaps = np.abs((found[span] - high) - low) / true.sizes[span]
                each.append(np.max(gaps, axis=0))
    worst = np.max(np.array(each), axis=0)
    return np.where(np.isfinite(worst), worst, np.inf)


def _angle(found: Column, high: Column, low: Column) -> Column:
    """Return the angle between attitudes, whatever their lengths and signs: 2 atan2(|v|, |s|).

    v and s are of q* (q + gap): what is the same cancels before it is rounded.
    """
    sign = np.where(np.sum(found * high, axis=0) < 0, -1.0, 1.0)
    gap = (sign * found - high) - low
    v = high[0] * gap[1:] - gap[0] * high[1:] - np.cross(high[1:], gap[1:], axis=0)
    s = np.sum(high * high, axis=0) + np.sum(high * gap, axis=0)
    angle: Column = 2 * np.arctan2(np.sqrt(np.sum(v * v, axis=0)), np.abs(s))
    return angle
