"""The forms that textbooks print break the promises, so the tests would notice them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import flint
import numpy as np
import pytest

from derive.motion.attitude.functions import FUNCTIONS
from derive.program.operations import atan2, cos, sin, sqrt
from derive.program.program import Program
from derive.program.recorded import needed
from derive.program.tape import Number, Tape, number
from tests.motion.attitude import cases, truth
from tests.motion.attitude.measured import PRECISIONS, called, error, promise
from tests.motion.attitude.truth import plain

TIMES_WORSE = 5  # than promised, so that luck does not decide


def length(v):
    return sqrt(sum((c * c for c in v[1:]), v[0] * v[0]))


def plain_normalise(q):
    return [c / length(q) for c in q]


def plain_exp(v):
    angle = length(v)
    ratio = sin(angle / 2) / angle
    return [cos(angle / 2), *(ratio * c for c in v)]


def log_by_arc_cosine(q):
    """Return 2 acos(w) u / |u|, the arc cosine as atan2: no operator is called acos."""
    w, *u = q
    ratio = 2 * atan2(sqrt(1 - w * w), w) / length(u)
    return [ratio * c for c in u]


def angles_by_matrix(q):
    """Return zyx angles from entries of the rotation matrix, the middle one by an arc sine."""
    w, x, y, z = q
    sine = 2 * (w * y - z * x)
    return [
        atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
        atan2(sine, sqrt(1 - sine * sine)),
        atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
    ]


def quaternion_by_trace(m):
    w = sqrt(1 + m[0] + m[4] + m[8]) / 2
    return [w, *((m[a] - m[b]) / (4 * w) for a, b in ((5, 7), (6, 2), (1, 3)))]


def mrp_without_shadow(q):
    return [c / (1 + q[0]) for c in q[1:]]


def unit(q: Sequence[float]) -> list[float]:
    return list(np.array(q) / np.linalg.norm(q))


HALF_TURN = unit([1e-3, 0.5, -0.7, 0.3])
MATRIX = [float(e) for e in plain(truth.by_column, HALF_TURN)]


@dataclass(frozen=True)
class Case:
    """A function, its textbook form, the truth, and samples that the form does not bear."""

    name: str
    formula: Callable[..., list[Number]]
    true: Callable[..., list[flint.arb]]
    samples: Sequence[Sequence[float]]


CASES = {
    "a small quaternion": Case(
        "normalise", plain_normalise, truth.unit, [[1e-25, 0, 1e-25, 1e-25], [1e-200] * 4]
    ),
    "a large quaternion": Case(
        "normalise", plain_normalise, truth.unit, [[1e25, 0, 1e25, 1e25], [1e200] * 4]
    ),
    "no rotation": Case("exp", plain_exp, truth.exp, [[0, 0, 0]]),
    "many turns": Case("exp", plain_exp, truth.exp, cases.vectors(20, np.float64) * 500),
    "a small angle": Case("log", log_by_arc_cosine, truth.log, [unit([1, 1e-3, 2e-3, -1e-3])]),
    "next to gimbal lock": Case(
        "to_euler_zyx",
        angles_by_matrix,
        partial(truth.to_euler, "zyx"),
        [unit([0.7, 0.1, 0.7 - 1e-4, -0.1 + 1e-4]), unit([0.6, 0.3, 0.6 + 1e-3, -0.3])],
    ),
    "next to a half turn": Case(
        "from_matrix", quaternion_by_trace, lambda *_: list(map(flint.arb, HALF_TURN)), [MATRIX]
    ),
    "next to a whole turn": Case(
        "to_mrp", mrp_without_shadow, truth.mrp, [unit([-1, 1e-3, 2e-3, 1e-3])]
    ),
}


def traced(name: str, formula: Callable[..., list[Number]]) -> Program:
    """Return a program with the inputs and outputs of an attitude function."""
    own = next(f for f in FUNCTIONS if f.name == name)
    tape = Tape("t", below=Tape("p"))
    results = formula(*([tape.input(c) for c in q.components] for q in own.inputs))
    operands = tuple(number(r).operand for r in results)
    return Program(name, own.says, own.inputs, own.outputs, needed(tape.ops, operands), operands)


def worst(function: Program | str, case: Case, dtype: type) -> float:
    with np.errstate(over="ignore"):
        given = np.array(case.samples, np.float64).astype(dtype)
    given = given[np.all(np.isfinite(given), axis=1)]
    if case.name == "normalise":
        given = given[np.any(given != 0, axis=1)]
    found = called(function, given)
    return max(error(f, plain(case.true, g), dtype) for f, g in zip(found, given, strict=True))


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_a_textbook_form_breaks_the_promise_that_ours_keeps(case, dtype):
    name = f"quaternion_{case.name}"
    assert worst(name, case, dtype) <= promise(name)
    assert worst(traced(name, case.formula), case, dtype) > TIMES_WORSE * promise(name)
