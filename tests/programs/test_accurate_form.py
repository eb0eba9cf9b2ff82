"""The accurate form is right to the last bit even where the moment cancels the gyroscopic term."""

from fractions import Fraction

import numpy as np
import pytest

from derive.arithmetic import EXACT, extended, paired, working
from derive.library import Library, library
from derive.program import run
from derive.scene import load, parse_scene

PARAMETERS = [
    Fraction(n, 64) for n in (90, 110, 125, 7, -5, 3)
]  # I_xx .. I_yz, exact in both types
OMEGA = (1.6123456789012345, -2.6789012345678901, 4.3456789012345678)
# One rounding of the result, and what the pairs leave: far below a thousandth of it.
ROUNDED_ONCE = 0.501
CANCELS_TO = Fraction(1, 10**4)


def made(form: str) -> Library:
    text = load("free_body").text
    return library(parse_scene(f'form = "{form}"\n{text}', "free_body"))


def exact_constants(lib: Library) -> list[Fraction]:
    return run(lib.setup, EXACT | {"low": lambda a: a * 0}, PARAMETERS)


def nearly_cancelling(lib: Library, dtype: type) -> list[Fraction]:
    """Return omega and a moment that leaves one part in ten thousand of the gyroscopic term."""
    omega = [Fraction(float(dtype(w))) for w in OMEGA]
    still = run(lib["moment"], EXACT, [*exact_constants(lib), *omega, *[Fraction(0)] * 3])
    return [*omega, *(Fraction(float(dtype(float(m * (1 + CANCELS_TO))))) for m in still)]


def worst(form: str, dtype: type) -> float:
    """Return the worst error of omega_dot in ulps of the result."""
    lib = made(form)
    inputs = nearly_cancelling(made("fast"), dtype)
    truth = run(lib["acceleration"], EXACT, [*exact_constants(lib), *inputs])
    given = np.array([float(x) for x in PARAMETERS], dtype)
    constants = [high for high, _ in run(lib.setup, extended(dtype), paired(given))]
    values = np.array([*constants, *[float(x) for x in inputs]], dtype)
    if form == "accurate":
        found = [high for high, _ in run(lib["acceleration"], extended(dtype), paired(values))]
    else:
        found = run(lib["acceleration"], working(dtype), list(values))
    return max(
        float(abs(Fraction(float(f)) - t) / Fraction(float(np.spacing(abs(dtype(float(t)))))))
        for f, t in zip(found, truth, strict=True)
    )


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_accurate_form_rounds_once(dtype):
    assert worst("accurate", dtype) <= ROUNDED_ONCE


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_fast_form_does_not(dtype):
    assert worst("fast", dtype) > 10


def test_the_accurate_form_does_the_same_operations():
    fast, accurate = made("fast"), made("accurate")
    for a, b in zip(fast.functions, accurate.functions, strict=True):
        assert b.arithmetic == "pairs"
        joined = sum(name.endswith("_low") for q in b.inputs for name in q.components)
        assert len(b.ops) - len(a.ops) <= joined
