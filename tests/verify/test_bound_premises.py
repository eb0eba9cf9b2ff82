"""What proved bounds rest on: errors of pairs, and results that no scaling changes."""

from collections.abc import Callable
from fractions import Fraction
from random import Random
from typing import Any

import numpy as np
import pytest
from flint import arb, ctx

from derive.library.library import Library
from derive.program.arithmetic import extended
from derive.program.precision import F64
from derive.program.program import Program
from derive.verify.draw import with_motion
from derive.verify.measure import results
from derive.verify.operators import LONG_FLOATS
from derive.verify.proved import enclosed
from derive.verify.sample import samples
from tests.made import library_of

U = Fraction(1, 2**24)
SCALED = ("free_body", "gyrostat", "rigid_body", "t_handle_flip", "attitude")
EXACTLY: dict[str, Callable[[Fraction, Fraction], Fraction]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
}


def pairs(dice: Random, count: int) -> tuple[Any, Any]:
    """Return pairs of floats, of all sizes next to one, a low part beside each high one."""
    high = np.array([dice.uniform(-2, 2) * 2.0 ** dice.randrange(-3, 4) for _ in range(count)])
    first = high.astype(np.float32)
    low = first * np.float32(2.0**-25) * np.array([dice.uniform(-1, 1) for _ in range(count)])
    return first, low.astype(np.float32)


def whole(pair: tuple[Any, Any], n: int) -> Fraction:
    """Return what a pair is."""
    return Fraction(float(pair[0][n])) + Fraction(float(pair[1][n]))


@pytest.mark.parametrize("operator", EXACTLY)
def test_pairs_err_by_less_than_bounds_take_them_to(operator: str) -> None:
    dice, count = Random(operator), 1000
    a, b = pairs(dice, count), pairs(dice, count)
    found = extended(np.float32)[operator](a, b)
    worst = Fraction(0)
    for n in range(count):
        true = EXACTLY[operator](whole(a, n), whole(b, n))
        worst = max(worst, abs((whole(found, n) - true) / true) if true else Fraction(0))
    assert worst / U**2 < enclosed.PAIR_ERROR[operator]


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_sines_of_pairs_err_by_less_than_bounds_take_them_to(name: str) -> None:
    dice, count = Random(name), 300
    angles = np.array([dice.uniform(-9, 9) for _ in range(count)]).astype(np.float32)
    high, low = extended(np.float32)[name]((angles, angles * 0))
    with ctx.workprec(200):
        for x, first, second in zip(angles, high, low, strict=True):
            true = getattr(arb(float(x)), name)()
            gap = abs(float(arb(float(first)) + arb(float(second)) - true))
            assert gap < enclosed.PAIR_WAVE * float(U**2) * (1 + abs(float(x)))


def scaled_by(library: Library, program: Program, values: dict[str, Any], by: int) -> list[Any]:
    """Return what a program gives where every power of two that it scales by is others."""
    own = LONG_FLOATS["power_of_two"]
    LONG_FLOATS["power_of_two"] = lambda x: own(x) * by  # type: ignore[index]
    try:
        return list(results(library, program, values).values())
    finally:
        LONG_FLOATS["power_of_two"] = own  # type: ignore[index]


@pytest.mark.parametrize(
    "name", [SCALED[0], *(pytest.param(name, marks=pytest.mark.long) for name in SCALED[1:])]
)
def test_results_do_not_depend_on_the_power_of_two_that_programs_scale_by(name: str) -> None:
    library = library_of(name)
    each = with_motion(library, samples(library.mechanism, F64, 3, 0).each[:3], F64)
    with ctx.workprec(300):
        for sample in each:
            values = {c: arb(x) for c, x in sample.values.items()}
            for program in library.printed():
                if any(q.role == "plan" for q in (*program.inputs, *program.outputs)):
                    continue
                one, other = (scaled_by(library, program, values, by) for by in (1, 4))
                for a, b in zip(one, other, strict=True):
                    assert abs(float(a - b)) <= 1e-60 * max(1.0, abs(float(a)))
