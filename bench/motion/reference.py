"""End states of cases to 40 digits, by Taylor series in arithmetic of 420 bits.

``python -m bench.motion.reference`` prints the entries that ``cases.json`` has beyond the
shared ones. The series are those of the vector equations, found by repeated integration; nothing
is shared with the steppers under test.
"""

import json
from dataclasses import replace
from fractions import Fraction
from typing import Any

from flint import arb, arb_series, ctx, fmpq

from bench.motion.case import Case, case
from bench.truth import applied, cross, dot
from derive.program.added import added

BITS, TERMS, DIGITS = 420, 60, 40
TURN = Fraction(1, 2)  # rad a step, about
PERTURBED = Fraction(1, 10**40)
MORE = 1 + PERTURBED

BEYOND: tuple[dict[str, Any], ...] = (
    {
        "id": "heavy_top_asymmetric",
        "note": "heavy asymmetric top about a fixed point, mass centre off its axes",
        "inertia": [["2.0", "0", "0"], ["0", "2.5", "0"], ["0", "0", "1.0"]],
        "omega0": ["0.5", "0.25", "4.0"],
        "q0": ["0.5", "0.5", "-0.5", "0.5"],
        "weight": ["0.25", "0", "2.0"],
        "T": "20.0",
    },
    {
        "id": "separatrix_40",
        "note": "exactly on the separatrix, twice as long: one rounding at the start decides",
        "inertia": [["3.0", "0", "0"], ["0", "4.0", "0"], ["0", "0", "6.0"]],
        "omega0": ["2.0", "1.0", "1.0"],
        "q0": ["1.0", "0", "0", "0"],
        "T": "40.0",
    },
    {
        "id": "rod_7e-9",
        "note": "I3/I1 = 2^-27 = 7.5e-9, exact in float",
        "inertia": [["1.0", "0", "0"], ["0", "1.0000001192092896", "0"],
                    ["0", "0", "7.450580596923828e-09"]],
        "omega0": ["0.25", "0.5", "3.0"],
        "q0": ["0.5", "-0.5", "0.5", "0.5"],
        "T": "50.0",
    },
    {
        "id": "spin_1e4",
        "note": "1e4 rad/s about the smallest axis",
        "inertia": [["1.5", "0", "0"], ["0", "1.25", "0"], ["0", "0", "1.0"]],
        "omega0": ["0", "0.5", "10000.0"],
        "q0": ["1.0", "0", "0", "0"],
        "T": "0.125",
    },
)  # fmt: skip

Row = list[Any]


def end(case: Case) -> tuple[Row, Row]:
    """Return omega (3) and attitude (4) of a case after its time."""
    ctx.prec, ctx.cap = BITS, TERMS
    steps = max(1, int(float(case.time) * _fastest(case) / float(TURN)) + 1)
    h = _arb(case.time) / steps
    inverse = _inverse(case)
    q, w = [_arb(x) for x in case.q0], [_arb(x) for x in case.omega0]
    for _ in range(steps):
        q, w = _step(case, inverse, q, w, h)
    return w, q


def kappa(case: Case) -> tuple[float, float]:
    """Return the change of omega (relative) and attitude (rad) for a relative change of inputs.

    Every input number and the time is changed by itself; what follows is added up.
    """
    w, q = end(case)
    size = _norm(w)
    changes = [end(changed) for changed in _changed(case)]
    omega = [_norm([a - b for a, b in zip(v, w, strict=True)]) / size for v, _ in changes]
    angle = [2 * _norm([a - b for a, b in zip(p, q, strict=True)]) for _, p in changes]
    scale = 1 / float(PERTURBED)
    return added(float(x) * scale for x in omega), added(float(x) * scale for x in angle)


def _changed(case: Case) -> list[Case]:
    found = []
    for name in ("inertia", "omega0", "moment", "wheel", "weight"):
        values = getattr(case, name)
        for n, x in enumerate(values):
            if x:
                changes: dict[str, Any] = {name: (*values[:n], x * MORE, *values[n + 1 :])}
                found.append(replace(case, **changes))
    return [*found, replace(case, time=case.time * MORE)]


def _fastest(case: Case) -> float:
    """Return a bound of how fast anything turns, in rad/s."""
    spread = float(max(case.inertia[:3]) / min(case.inertia[:3]))
    torque = max(abs(float(x)) for x in (*case.moment, *case.wheel, *case.weight))
    smallest = float(min(case.inertia[:3]))
    return case.rate * min(spread, 2.5) + torque / smallest


def _step(case: Case, inverse: list[Row], q: Row, w: Row, h: Any) -> tuple[Row, Row]:
    """Return attitude and omega after h: the series in tau = t/h, one more term in each pass."""
    series = [arb_series([x], prec=TERMS) for x in (*q, *w)]
    start = [*q, *w]
    for terms in range(2, TERMS + 1):
        rates = _rates(case, inverse, [_cut(s, terms - 1) for s in series])
        series = [_integral(r, x, h) for r, x in zip(rates, start, strict=True)]
    ends = [sum((s[k] for k in range(TERMS)), arb(0)).mid() for s in series]
    return ends[:4], ends[4:]


def _integral(rate: Any, start: Any, h: Any) -> Any:
    return (rate * h).integral() + start if isinstance(rate, arb_series) else start


def _cut(series: Any, terms: int) -> Any:
    return arb_series([series[k] for k in range(terms)], prec=terms)


def _rates(case: Case, inverse: list[Row], state: Row) -> Row:
    q, w = state[:4], state[4:]
    momentum = [a + _arb(b) for a, b in zip(applied(_tensor(case), w), case.wheel, strict=True)]
    turning = cross(momentum, w)
    load = [a + _arb(b) for a, b in zip(turning, case.moment, strict=True)]
    if any(case.weight):
        down = cross(_third_row(q), [_arb(x) for x in case.weight])
        load = [a + b for a, b in zip(load, down, strict=True)]
    half = arb(1) / 2
    vector = [q[0] * a + b for a, b in zip(w, cross(q[1:], w), strict=True)]
    return [-dot(q[1:], w) * half, *(x * half for x in vector), *applied(inverse, load)]


def _third_row(q: Row) -> Row:
    """Return the inertial z axis along body axes."""
    a, b, c, d = q
    return [(b * d - a * c) * 2, (c * d + a * b) * 2, a * a - b * b - c * c + d * d]


def _tensor(case: Case) -> list[Row]:
    xx, yy, zz, xy, xz, yz = (_arb(x) for x in case.inertia)
    return [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]


def _inverse(case: Case) -> list[Row]:
    rows = _tensor(case)
    cofactors = [cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])]
    determinant = dot(rows[0], cofactors[0])
    return [[x / determinant for x in row] for row in cofactors]


def _norm(a: Row) -> Any:
    return sum((x * x for x in a), arb(0)).sqrt()


def _arb(x: Any) -> Any:
    return arb(fmpq(x.numerator, x.denominator)) if isinstance(x, Fraction) else arb(x)


def entry(given: dict[str, Any]) -> dict[str, Any]:
    """Return an entry of the data with its end state and condition numbers."""
    found = case(given)
    w, q = end(found)
    omega, angle = kappa(found)
    return given | {
        "omega_T": [_digits(x) for x in w],
        "q_T": [_digits(x) for x in q],
        "cond_omega_rel_per_unit_rel_input": f"{omega:.4g}",
        "cond_angle_rad_per_unit_rel_input": f"{angle:.4g}",
    }


def _digits(x: Any) -> str:
    return str(x.mid().str(DIGITS, radius=False))


if __name__ == "__main__":
    print(json.dumps([entry(given) for given in BEYOND], indent=1))
