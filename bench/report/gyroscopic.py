"""The gyroscopic term omega x I omega beside its exact value, from a rod to nearly a sphere."""

import math
import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from statistics import median

from bench.motion.ours import emission
from bench.motion.wrong import ROUNDOFF
from bench.report.hard_formulas import callable_by_precision, rounded
from derive.check.call import CFunction

SCENES = {"fast": "gyroscopic", "accurate": "gyroscopic_accurate"}
NAMES = ("I_xx", "I_yy", "I_zz", "I_xy", "I_xz", "I_yz")
SAMPLES = 300
ASPHERICITIES = tuple(10.0**-n for n in range(13))
Row = Sequence[float]


@dataclass(frozen=True)
class Gyroscopic:
    """Errors of the gyroscopic term: median and largest of the samples, in u of its norm.

    form : of the scene, "fast" or "accurate"      of_terms : the largest in u of the norm of the
        largest terms that it is the sum of
    """

    form: str
    precision: str
    asphericity: float
    median: float
    largest: float
    of_terms: float


def gyroscopic(folder: Path) -> Iterator[Gyroscopic]:
    """Yield the errors at every asphericity, in both forms and precisions."""
    for form, scene in SCENES.items():
        for precision, own in callable_by_precision(emission(scene), folder).items():
            for asphericity in ASPHERICITIES:
                errors = _errors(own, precision, asphericity)
                norms, terms = [e for e, _ in errors], [e for _, e in errors]
                yield Gyroscopic(form, precision, asphericity, median(norms), max(norms),
                                 max(terms))  # fmt: skip


def _errors(
    own: Mapping[str, CFunction], precision: str, asphericity: float
) -> list[tuple[float, float]]:
    """Return the errors of all samples; that of a sphere is none at all, or without bound."""
    dice = random.Random(f"{asphericity}")
    found = []
    for _ in range(SAMPLES):
        parts = [1 + asphericity * dice.uniform(-0.3, 0.3) for _ in range(3)]
        parts += [asphericity * dice.uniform(-0.1, 0.1) for _ in range(3)]
        inertia = rounded(parts, precision)
        omega = rounded([dice.uniform(-10, 10) for _ in range(3)], precision)
        true = _exact(inertia, omega)
        made = own["setup"]({n: [x] for n, x in zip(NAMES, inertia, strict=True)})
        given = {"constants": made["constants"], "omega": omega, "omega_dot": [0.0] * 3}
        apart = _distance(own["moment"](given)["moment"], true) / ROUNDOFF[precision]
        if any(true):
            found.append((apart / _norm(true), apart / _norm(_terms(inertia, omega))))
        else:
            found.append((math.inf, math.inf) if apart else (0.0, 0.0))
    return found


def _exact(inertia: Row, omega: Row) -> list[Fraction]:
    xx, yy, zz, xy, xz, yz = (Fraction(x) for x in inertia)
    w = [Fraction(x) for x in omega]
    turning = [
        xx * w[0] - xy * w[1] - xz * w[2],
        -xy * w[0] + yy * w[1] - yz * w[2],
        -xz * w[0] - yz * w[1] + zz * w[2],
    ]
    return [w[n - 2] * turning[n - 1] - w[n - 1] * turning[n - 2] for n in range(3)]


def _distance(found: Row, true: Sequence[Fraction]) -> float:
    return _norm([Fraction(a) - b for a, b in zip(found, true, strict=True)])


def _norm(a: Sequence[Fraction]) -> float:
    return math.hypot(*map(float, a))


def _terms(inertia: Row, omega: Row) -> list[Fraction]:
    """Return the largest term of each component in the form with differences of moments."""
    xx, yy, zz, xy, xz, yz = (Fraction(x) for x in inertia)
    x, y, z = (Fraction(w) for w in omega)
    rows = (
        ((yy - zz) * y * z, yz * (z - y) * (z + y), xy * x * z, xz * x * y),
        ((zz - xx) * z * x, xz * (x - z) * (x + z), yz * y * x, xy * y * z),
        ((xx - yy) * x * y, xy * (y - x) * (y + x), xz * z * y, yz * z * x),
    )
    return [max(map(abs, row)) for row in rows]
