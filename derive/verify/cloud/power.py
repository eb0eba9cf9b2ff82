"""The power of a machine's loads, summed over the points of its bodies that they act on.

Loads that the energy counts, weights and springs without their dampers, are told from the others.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from mpmath import mp
from numpy.typing import NDArray

from derive.scene.formula import ZERO
from derive.scene.machine import Spring, Weight
from derive.verify.cloud.balance import acting, along, at_instant
from derive.verify.cloud.history import History
from derive.verify.cloud.series import DIGITS, crossed, each
from derive.verify.cloud.solution import CloudAnswers


@dataclass(frozen=True)
class Powers:
    """Terms of the power of all loads, and of those that have a potential energy, in W."""

    every: tuple[Any, ...]
    conservative: tuple[Any, ...]


def powers(answers: CloudAnswers) -> Powers:
    """Return the powers of a machine's loads, reactions included.

    Of reactions that the particles do not tell apart any will do: together they do the same work.
    """
    with mp.workdps(DIGITS):
        history = answers.history(answers.some)
        every = [
            p
            for load in history.machine.loads
            for body, place, force, couple in acting(history, load)
            for p in _power(history, body, place, force, couple)
        ]
        every += answers.allowed.powers(history)
        return Powers(tuple(every), tuple(_conservative(history)))


def _power(
    history: History, body: str, place: NDArray[Any], force: NDArray[Any], couple: NDArray[Any]
) -> list[Any]:
    """Return the powers of a force on the body's particle at a place, and of a couple."""
    centre, Q = history.centre(body), history.body(body)
    spin = each(lambda x: x.velocity, Q) @ at_instant(Q).T
    omega = np.array([spin[2, 1], spin[0, 2], spin[1, 0]], dtype=object)
    arm = place - at_instant(centre)
    v = each(lambda x: x.velocity, centre) + crossed(omega, arm)
    return [force @ v, couple @ omega]


def _conservative(history: History) -> list[Any]:
    found: list[Any] = []
    for load in history.machine.loads:
        if isinstance(load, Weight):
            g = along(history, load.along, load.gravity)
            for body in load.on:
                v = each(lambda x: x.velocity, history.centre(body))
                found.append(history.mass(body) * (g @ v))
        elif isinstance(load, Spring):
            ends = ((load.frame, load.at), (load.to_frame, load.to))
            start, end = (history.place(frame, at) for frame, at in ends)
            _, _, force, _ = next(acting(history, replace(load, damping=ZERO)))
            found.append(-force @ each(lambda x: x.velocity, end - start))
    return found
