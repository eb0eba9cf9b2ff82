"""Where a residual is zero within a step: halves of halves of it are taken, by all who look for it.

A residual that has another sign at the end of the step is zero between. One that turns back within
the step is followed to where it turns, and may be beyond zero there.
"""

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

HALVINGS = 52
"""Of a step: what is left of it is below the roundings of any time in it."""
TURNS = 26
"""Halvings until a residual that turns back is where it turns: it is flat there."""
BESIDE = 2.0**-10
"""Of half a step, a little further on, where it is seen which way a residual goes."""


class Walker(Protocol):
    """Motions side by side within a step, all at one time."""

    def on(self, length: float) -> None:
        """Go on by so many seconds."""

    def residual(self) -> NDArray[np.float64]:
        """Return what is zero when the event happens."""

    def here(self) -> Any:
        """Return where all are."""

    def to(self, places: Any, which: NDArray[np.bool_]) -> None:
        """Take some of them to where they were."""


def crossed_in(
    of: Walker, left: NDArray[np.float64], length: float, turns: NDArray[np.bool_]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Go to where residuals are zero first; return how long that takes, and which of them are.

    left : at the start of the step        turns : those that have the same sign at its end
    """
    sign, time, follows = np.sign(left), np.zeros(len(left)), turns.copy()
    for k in range(HALVINGS):
        length /= 2
        start = of.here()
        of.on(length)
        value = sign * of.residual()
        stays = value > 0
        follows &= stays
        if follows.any() and k < TURNS:
            middle = of.here()
            of.on(length * BESIDE)
            rises = sign * of.residual() >= value
            of.to(middle, np.ones(len(left), bool))
            stays &= ~(follows & rises)
        of.to(start, ~stays)
        time[stays] += length
    of.on(length)
    return time + length, ~follows


def turn_back(
    before: NDArray[np.float64], here: NDArray[np.float64], after: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Tell which residuals, a step apart, come so near to zero that they may have crossed it.

    A parabola through the three lies below the middle one by an eighth of what they bend, at most.
    """
    sign = np.sign(here)
    down, up = sign * (before - here), sign * (after - here)
    inward = (down >= 0) & (up >= 0) & (sign * after > 0)
    found: NDArray[np.bool_] = inward & (sign != 0) & (np.abs(here) <= (down + up) / 2)
    return found
