"""Sine and cosine of pairs are right to nearly twice the working precision, at any angle."""

import math
import random

import numpy as np
import pytest
from flint import arb, ctx

from derive.program.arithmetic import extended
from derive.program.pairs import MANTISSA

BOUND = 16.0
"""In u^2 of the value: a dozen operations on pairs, each right to a few u^2."""


def angles(dtype: type) -> np.ndarray:
    dice = random.Random("angles of a pair")
    turns = [math.pi / 2 * n for n in (-9, -4, -3, -2, -1, 1, 2, 3, 4, 7, 1001)]
    small = [2.0**-n for n in range(1, 20)]
    return np.array([dice.uniform(-8, 8) for _ in range(200)] + turns + small, dtype)


def worst(dtype: type, name: str) -> float:
    """Return the largest relative error in u^2, against balls of 400 bits."""
    high = angles(dtype)
    low = high * dtype(2.0 ** -(MANTISSA[dtype] + 2))
    found = extended(dtype)[name]((high, low))
    errors = []
    with ctx.workprec(400):
        for a, b, x, y in zip(high, low, *found, strict=True):
            true = getattr(arb(float(a)) + arb(float(b)), name)()
            gap = (arb(float(x)) + arb(float(y)) - true) / true
            errors.append(abs(float(gap)) * 4.0 ** MANTISSA[dtype])
    return max(errors)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("name", ["sin", "cos"])
def test_a_pair_keeps_its_digits_also_next_to_quarter_turns(dtype: type, name: str) -> None:
    assert worst(dtype, name) <= BOUND


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_no_number_has_no_sine(name: str) -> None:
    nothing = np.array([np.nan, np.inf, -np.inf])
    with np.errstate(invalid="ignore"):
        high, _ = extended(np.float64)[name]((nothing, nothing * 0))
    assert np.isnan(high).all()


def test_the_sine_of_nothing_is_nothing() -> None:
    zero = np.array([0.0])
    assert extended(np.float64)["sin"]((zero, zero)) == (0.0, 0.0)
    assert extended(np.float64)["cos"]((zero, zero)) == (1.0, 0.0)
