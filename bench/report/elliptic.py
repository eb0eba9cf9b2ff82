"""The exact torque-free motion as textbooks print it, in Jacobi's functions of the squared modulus.

Landau and Lifshitz, Mechanics, section 37; the phase at the start is the incomplete integral of
an angle. Kept to show what it loses.
"""

import math
from typing import Any

from bench.motion.case import Case
from derive.program.added import added

TYPES = {"f64": "float64", "f32": "float32"}


def elliptic(case: Case, precision: str) -> float:
    """Return the relative error of omega at the end. Raises ImportError without SciPy."""
    import numpy as np

    real = np.dtype(TYPES[precision]).type
    with np.errstate(all="ignore"):
        found = [float(x) for x in _omega(case, real)]
    true = [float(x) for x in case.omega_T]
    size = math.sqrt(added(x * x for x in true)) or 1.0
    error = math.sqrt(added((a - b) ** 2 for a, b in zip(found, true, strict=True))) / size
    return error if math.isfinite(error) else math.nan


def _omega(case: Case, real: Any) -> list[Any]:
    import numpy as np
    from scipy.special import ellipj, ellipkinc

    order = sorted(range(3), key=lambda n: case.inertia[n])
    I1, I2, I3 = (real(float(case.inertia[n])) for n in order)
    w1, w2, w3 = (real(float(case.omega0[n])) for n in order)
    energy2 = I1 * w1 * w1 + I2 * w2 * w2 + I3 * w3 * w3
    square = (I1 * w1) ** 2 + (I2 * w2) ** 2 + (I3 * w3) ** 2
    swapped = square < energy2 * I2
    if swapped:
        I1, I3, w1, w3 = I3, I1, w3, w1
    a1 = np.sqrt((energy2 * I3 - square) / (I1 * (I3 - I1)))
    a2 = np.sqrt((energy2 * I3 - square) / (I2 * (I3 - I2)))
    a3 = np.sqrt((square - energy2 * I1) / (I3 * (I3 - I1)))
    rate = np.sqrt((I3 - I2) * (square - energy2 * I1) / (I1 * I2 * I3))
    m = (I2 - I1) * (energy2 * I3 - square) / ((I3 - I2) * (square - energy2 * I1))
    hand = (1 if _even(order) else -1) * (1 if w3 >= 0 else -1)
    start = ellipkinc(np.arctan2(hand * w2 / a2, w1 / a1), m)
    sn, cn, dn, _ = ellipj(rate * real(float(case.time)) + start, m)
    found = [a1 * cn, hand * a2 * sn, math.copysign(1, w3) * a3 * dn]
    if swapped:
        found = found[::-1]
    return [found[order.index(n)] for n in range(3)]


def _even(order: list[int]) -> bool:
    return order in ([0, 1, 2], [1, 2, 0], [2, 0, 1])
