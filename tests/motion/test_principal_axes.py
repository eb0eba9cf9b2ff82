"""Principal axes and moments of any tensor come out to the last digit of a pair of floats."""

from fractions import Fraction
from typing import Any

import flint
import numpy as np
import pytest

from derive.motion.exact.diagonal import diagonalised
from derive.motion.exact.inertia import Inertia
from derive.program.arithmetic import MANTISSA, extended, paired
from derive.program.program import Program
from derive.program.recorded import needed
from derive.program.run import run
from derive.program.tape import Tape, number
from tests.motion.free import Rows
from tests.motion.stepped import TENSOR, quantity

MOMENTS = (
    (1.0, 2.0, 3.0),
    (1.0, 1.0 + 2.0**-20, 3.0),
    (1.0, 3.0, 3.0 + 2.0**-20),
    (1.0, 1.0 + 2.0**-40, 1.0 + 2.0**-39),
    (2.0**-22, 1.0, 1.0 + 2.0**-20),
    (2.0, 2.0, 2.0),
    (1.0, 1.0, 2.0),
)
PRECISIONS = (np.float64, np.float32)
ROOM = 64  # u^2: some thirty turns, each of a few operations that are right to a few u^2


def found(dtype: type, tensors: Rows) -> list[Any]:
    """Return the moments and the axes of tensors (n, 6), in pairs."""
    tape = Tape("p")
    xx, yy, zz, xy, xz, yz = (tape.input(name) for name in TENSOR)
    axes = diagonalised(Inertia((xx, yy, zz, xy, xz, yz), "general", None))
    results = tuple(x.operand for x in (*axes.moments, *(x for row in axes.axes for x in row)))
    names = quantity("axes", [f"x{k}" for k in range(12)])
    ops = needed(tape.ops, results)
    program = Program("axes", "", (quantity("inertia", TENSOR),), (names,), ops, results)
    with np.errstate(all="ignore"):
        return run(program, extended(dtype), paired(tensors.astype(dtype).T))


def turned(dtype: type) -> Rows:
    """Return tensors with those moments about axes of any direction, and about x, y, z."""
    dice = np.random.default_rng(1)
    rows = []
    for moments in MOMENTS:
        for frame in (np.eye(3), *(np.linalg.qr(dice.normal(size=(3, 3)))[0] for _ in range(4))):
            m = frame @ np.diag(moments) @ frame.T
            rows.append([*np.diag(m), m[0, 1], m[0, 2], m[1, 2]])
    return np.array(rows).astype(dtype).astype(float)


def test_too_few_turns_are_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("derive.motion.exact.diagonal.PASSES", 3)
    with pytest.raises(AssertionError):
        test_axes_are_right_handed_and_turn_the_tensor_to_its_moments(np.float64)


@pytest.mark.parametrize("dtype", PRECISIONS)
def test_axes_are_right_handed_and_turn_the_tensor_to_its_moments(dtype: type) -> None:
    tensors = turned(dtype)
    pairs = found(dtype, tensors)
    u = 2.0 ** -MANTISSA[dtype]
    for n, row in enumerate(tensors):
        with flint.ctx.workprec(300):
            values = [flint.arb(float(p[0][n])) + flint.arb(float(p[1][n])) for p in pairs]
            axes = flint.arb_mat([values[3:6], values[6:9], values[9:12]])
            xx, yy, zz, xy, xz, yz = (flint.arb(float(x)) for x in row)
            tensor = flint.arb_mat([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            made = axes * tensor * axes.transpose()
            size = made[0, 0] / values[0]  # the power of two that moments are over
            square = axes * axes.transpose()
            for i in range(3):
                for j in range(3):
                    same = int(i == j)
                    assert abs(square[i, j] - same) < ROOM * u * u
                    moment = values[i] * round(float(size) * 2**20) / 2**20 if same else 0
                    assert abs(made[i, j] - moment) < ROOM * u * u * (xx + yy + zz)
            assert axes.det() > 0
            assert values[0] <= values[1] <= values[2]


def test_exact_numbers_are_turned_without_an_operation() -> None:
    values = [number(Fraction(x)) for x in (2, 3, 4, "-1/4", "1/8", "-1/2")]
    tensor = (values[0], values[1], values[2], values[3], values[4], values[5])
    axes = diagonalised(Inertia(tensor, "general", None))
    exact = [m.exact for m in axes.moments]
    assert all(m is not None for m in exact)
    assert abs(sum(m for m in exact if m is not None) * 8 - 9) < Fraction(1, 2**150)
