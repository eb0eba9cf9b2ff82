"""Hard cases of a heavy top: its slow precession, and how far a small tilt lets it sink.

The slow root is found from the emitted residual alone, by secants from rest in the precision of the
function: the residual cancels nothing there, so the root is as good as the residual's terms.
"""

import random
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from bench.motion.ours import emission
from bench.motion.wrong import ROUNDOFF
from bench.report.case_run import PRECISIONS
from bench.report.hard import Hard
from bench.report.hard_formulas import DIGITS, SAMPLES, callable_by_precision
from derive.check.call import CFunction
from derive.program.largest import largest

SECANTS = 8
TILT = 1e-4  # rad
Given = Mapping[str, float]
Form = Callable[[Given, Any], float]


@dataclass(frozen=True)
class Answer:
    """A number that the top answers with: a naive form, ours, and what it should be."""

    name: str
    naive_says: str
    naive: Form
    ours_says: str
    ours: Callable[[Mapping[str, CFunction], Given, Any], float]
    true: Callable[[Given], Any]
    bound: float  # in u
    why: str


def tops(folder: Path) -> Iterator[Hard]:
    """Yield the rows of the top: largest relative errors over samples."""
    called = callable_by_precision(emission("top"), folder)
    for answer in ANSWERS:
        yield _row(answer, called)


def _row(answer: Answer, called: Mapping[str, Mapping[str, CFunction]]) -> Hard:
    """Return the row of an answer; the digits of references end with it."""
    import mpmath

    with mpmath.workdps(DIGITS):
        naive = {p: (_largest(answer, answer.naive, p),) for p in PRECISIONS}
        ours = {p: (_largest(answer, partial(answer.ours, own), p),) for p, own in called.items()}
    bound = {p: answer.bound * ROUNDOFF[p] for p in PRECISIONS}
    return Hard(answer.name, "relative", answer.naive_says, naive, answer.ours_says, ours,
                bound, answer.why)  # fmt: skip


def _largest(answer: Answer, form: Form, precision: str) -> float:
    import numpy as np

    real: Any = np.float32 if precision == "f32" else np.float64
    dice = random.Random(answer.name)
    errors = []
    for _ in range(SAMPLES):
        given = {name: float(real(x)) for name, x in _sample(dice).items()}
        true = answer.true(given)
        found = form({name: real(x) for name, x in given.items()}, real)
        errors.append(abs((float(found) - true) / true))
    return largest(errors)


def _sample(dice: random.Random) -> dict[str, float]:
    lengths = {"r": dice.uniform(0.04, 0.06), "l": dice.uniform(0.05, 0.07)}
    turning = {"n": dice.uniform(3e3, 1e4), "theta": TILT * dice.uniform(1, 2)}
    return lengths | turning | {"g": dice.uniform(9.7, 9.9)}


def _moments(given: Given) -> tuple[Any, Any]:
    """Return the moments of a disc on its stem across the axis and along it, over its mass."""
    square = given["r"] * given["r"]
    return square / 4 + given["l"] * given["l"], square / 2


def _printed_root(given: Given, real: Any) -> float:
    import numpy as np

    across, along = _moments(given)
    twice, spin = 2 * across * np.cos(given["theta"]), along * given["n"]
    inner = spin * spin - 2 * twice * given["l"] * given["g"]
    return float((spin - np.sqrt(inner)) / real(twice))


def _by_secants(own: Mapping[str, CFunction], given: Given, real: Any) -> float:
    constants = _constants(own, given)

    def residual(rate: Any) -> Any:
        asked = {"constants": constants, "theta": [given["theta"]], "W": [float(rate)]}
        return real(own["steady"](asked)["steady"][0])

    last, rate = real(0), real(1e-2)
    before, here = residual(last), residual(rate)
    for _ in range(SECANTS):
        if here == before or here == 0:
            break
        last, rate = rate, rate - here * (rate - last) / (here - before)
        before, here = here, residual(rate)
    return float(rate)


def _constants(own: Mapping[str, CFunction], given: Given) -> list[float]:
    names = [a.name for a in own["setup"].arguments if not a.output]
    return own["setup"]({name: [float(given[name])] for name in names})["constants"]


def _slow_root(given: Given) -> Any:
    import mpmath

    exact = {name: mpmath.mpf(x) for name, x in given.items()}
    across, along = _moments(exact)
    weight, spin = exact["l"] * exact["g"], along * exact["n"]
    inner = spin * spin - 4 * across * mpmath.cos(exact["theta"]) * weight
    return 2 * weight / (spin + mpmath.sqrt(inner))


def _one_minus_cosine(given: Given, real: Any) -> float:
    import numpy as np

    return float(given["l"] * (real(1) - np.cos(given["theta"])))


def _sunk(own: Mapping[str, CFunction], given: Given, real: Any) -> float:
    asked = {"constants": _constants(own, given), "theta": [float(given["theta"])]}
    return float(real(own["sunk"](asked)["sunk"][0]))


def _sunk_truly(given: Given) -> Any:
    import mpmath

    return given["l"] * (1 - mpmath.cos(mpmath.mpf(given["theta"])))


ANSWERS = (
    Answer("slow precession of a fast top", "(C n - sqrt(C^2 n^2 - 4 A m g l cos)) / (2 A cos)",
           _printed_root, "steady, by secants", _by_secants, _slow_root, 8.0,
           "the residual's rounding beside its largest term"),
    Answer("1 - cos at a tilt of 1e-4 rad", "l (1 - cos)", _one_minus_cosine, "sunk, a result",
           _sunk, _sunk_truly, 4.0, "a few roundings"),
)  # fmt: skip
