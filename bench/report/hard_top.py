"""Hard cases of a heavy top: its slow precession, and how far a small tilt lets it sink.

The slow root is found from the emitted residual alone, by secants from rest in the precision of the
function: the residual cancels nothing there, so the root is as good as the residual's terms.
"""

import random
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from bench.motion.ours import emission
from bench.report.formula_samples import Row
from bench.report.hard import Hard
from bench.report.hard_formulas import Formula, Functions, callable_by_precision, rows

SECANTS = 8
TILT = 1e-4  # rad
NAMES = ("r", "l", "n", "theta", "g")


def tops(folder: Path) -> Iterator[Hard]:
    """Yield the rows of the top: largest relative errors over samples."""
    return rows(ANSWERS, callable_by_precision(emission("top"), folder))


def _sample(dice: random.Random, _: str) -> Row:
    lengths = dice.uniform(0.04, 0.06), dice.uniform(0.05, 0.07)
    turning = dice.uniform(3e3, 1e4), TILT * dice.uniform(1, 2)
    return [*lengths, *turning, dice.uniform(9.7, 9.9)]


def _moments(r: Any, l: Any) -> tuple[Any, Any]:  # noqa: E741 - as in the scene
    """Return the moments of a disc on its stem across the axis and along it, over its mass."""
    square = r * r
    return square / 4 + l * l, square / 2


def _printed_root(given: Row, real: Any) -> Row:
    import numpy as np

    r, l, n, theta, g = given  # noqa: E741
    across, along = _moments(r, l)
    twice, spin = 2 * across * np.cos(theta), along * n
    inner = spin * spin - 2 * twice * l * g
    return [(spin - np.sqrt(inner)) / real(twice)]


def _by_secants(own: Functions, given: Row, real: Any) -> Row:
    constants = _constants(own, given)

    def residual(rate: Any) -> Any:
        asked = {"constants": constants, "theta": [float(given[3])], "W": [float(rate)]}
        return real(own["steady"](asked)["steady"][0])

    last, rate = real(0), real(1e-2)
    before, here = residual(last), residual(rate)
    for _ in range(SECANTS):
        if here == before or here == 0:
            break
        last, rate = rate, rate - here * (rate - last) / (here - before)
        before, here = here, residual(rate)
    return [rate]


def _constants(own: Functions, given: Row) -> list[float]:
    named = dict(zip(NAMES, given, strict=True))
    names = [a.name for a in own["setup"].arguments if not a.output]
    return own["setup"]({name: [float(named[name])] for name in names})["constants"]


def _slow_root(given: Row) -> Sequence[Any]:
    import mpmath

    r, l, n, theta, g = map(mpmath.mpf, given)  # noqa: E741
    across, along = _moments(r, l)
    weight, spin = l * g, along * n
    inner = spin * spin - 4 * across * mpmath.cos(theta) * weight
    return [2 * weight / (spin + mpmath.sqrt(inner))]


def _one_minus_cosine(given: Row, real: Any) -> Row:
    import numpy as np

    return [given[1] * (real(1) - np.cos(given[3]))]


def _sunk(own: Functions, given: Row, _: Any) -> Row:
    return own["sunk"]({"constants": _constants(own, given), "theta": [float(given[3])]})["sunk"]


def _sunk_truly(given: Row) -> Sequence[Any]:
    import mpmath

    return [given[1] * (1 - mpmath.cos(mpmath.mpf(given[3])))]


ANSWERS = (
    Formula("slow precession of a fast top", "(C n - sqrt(C^2 n^2 - 4 A m g l cos)) / (2 A cos)",
            _printed_root, "steady, by secants", _by_secants, _sample, _slow_root, 8.0,
            "the residual's rounding beside its largest term"),
    Formula("1 - cos at a tilt of 1e-4 rad", "l (1 - cos)", _one_minus_cosine, "sunk, a result",
            _sunk, _sample, _sunk_truly, 4.0, "a few roundings"),
)  # fmt: skip
