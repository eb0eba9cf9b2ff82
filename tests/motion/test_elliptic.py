"""Elliptic functions and the angle of the third kind are what mpmath and an integral say."""

import operator
from collections.abc import Callable
from functools import cache
from typing import Any

import mpmath
import numpy as np
import pytest

from derive.motion.exact.elliptic import RUNGS, angle, jacobi_functions, ladder
from derive.program.arithmetic import working
from derive.program.operations import cos, sin, sqrt
from derive.program.program import Program
from derive.program.recorded import needed
from derive.program.run import run
from derive.program.tape import Number, Tape
from tests.made import thinned
from tests.motion.stepped import quantity

MANY: dict[str, Callable[..., Any]] = {
    "number": lambda q: mpmath.mpf(q.numerator) / q.denominator,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "neg": operator.neg,
    "sqrt": mpmath.sqrt,
    "sin": mpmath.sin,
    "cos": mpmath.cos,
}
DIGITS = 60
COMPLEMENTS = (1.0, 1 - 2.0**-40, 0.9, 0.5, 0.1, 2.0**-10, 2.0**-40)
PARTS = (0.0, 1e-6, 0.3, 0.99, 1.0, 1.7, -3.2, 41.3)  # of a quarter period
QUADRATURE = 1e-10  # what Gauss-Legendre on two pieces leaves where k' is small
GIVEN = ("k", "u", "pole")


def recorded(made: Callable[[list[Number]], list[Number]]) -> Program:
    tape = Tape("t")
    results = tuple(x.operand for x in made([tape.input(name) for name in GIVEN]))
    inputs, ends = (
        quantity("given", GIVEN),
        quantity("made", [f"r{k}" for k in range(len(results))]),
    )
    return Program("made", "", (inputs,), (ends,), needed(tape.ops, results), results)


@cache
def jacobi(rungs: int = RUNGS) -> Program:
    def made(given: list[Number]) -> list[Number]:
        k, u, _ = given
        means = ladder(k, rungs)
        at = jacobi_functions(means, sin(means.mean * u), cos(means.mean * u))
        return [at.sn, at.cn, at.dn]

    return recorded(made)


@cache
def third() -> Program:
    """Return rate u and the direction, for P = ``pole`` a on the first rung."""

    def made(given: list[Number]) -> list[Number]:
        k, u, pole = given
        means = ladder(k)
        a, b = means.a[1], means.b[1]
        p = pole * a
        weight = sqrt((p * p - a * a) * (p * p - b * b)) / p
        at = jacobi_functions(means, sin(means.mean * u), cos(means.mean * u))
        found = angle(means, at, weight, p)
        return [found.rate * u, *found.direction]

    return recorded(made)


@pytest.mark.parametrize("complement", COMPLEMENTS)
def test_functions_are_jacobis(complement: float) -> None:
    with mpmath.workdps(DIGITS):
        k = mpmath.mpf(complement)
        quarter = mpmath.ellipk(1 - k * k)
        for part in PARTS:
            u = quarter * part
            found = run(jacobi(), MANY, [k, u, 1])
            for name, value in zip(("sn", "cn", "dn"), found, strict=True):
                assert abs(mpmath.ellipfun(name, u, m=1 - k * k) - value) < 1e-40


@pytest.mark.parametrize("complement", thinned(COMPLEMENTS, 2))
@pytest.mark.parametrize("pole", thinned([1.4, 1.05], 2))
def test_the_angle_is_its_integral(complement: float, pole: float) -> None:
    with mpmath.workdps(20):
        k = mpmath.mpf(complement)
        a, b = (1 + k) / 2, mpmath.sqrt(k)
        p = pole * a
        weight = mpmath.sqrt((p * p - a * a) * (p * p - b * b)) / p
        m = 1 - (b / a) ** 2
        quarter = mpmath.ellipk(m) / a
        for part in (0.7, -1.6):
            u = quarter * part

            def rate(x: Any) -> Any:
                sn, cn = (mpmath.ellipfun(name, a * x, m=m) for name in ("sn", "cn"))
                return 2 * weight * (p * sn) ** 2 / ((a * cn) ** 2 + (p * sn) ** 2)

            integral = mpmath.quad(rate, mpmath.linspace(0, u, 3))
            secular, x, y = run(third(), MANY, [k, u, mpmath.mpf(pole)])
            assert abs(integral - (secular - 2 * mpmath.atan2(y, x))) < QUADRATURE * (
                1 + abs(integral)
            )


SHARP = 6  # u of the largest function and of the argument


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_functions_lose_a_few_units_of_their_argument(dtype: type) -> None:
    assert worst(dtype, RUNGS) < SHARP


def test_a_ladder_without_its_last_rungs_is_noticed() -> None:
    assert worst(np.float64, 4) > 1e3 * SHARP


def worst(dtype: type, rungs: int) -> float:
    """Return the largest error over u (1 + |u|) of a function, in its precision."""
    u = float(np.finfo(dtype).eps) / 2
    largest = 0.0
    with mpmath.workdps(DIGITS):
        for complement in COMPLEMENTS[2:]:
            k = dtype(complement)
            quarter = mpmath.ellipk(1 - mpmath.mpf(float(k)) ** 2)
            for part in PARTS:
                x = dtype(float(quarter * part))
                found = run(jacobi(rungs), working(dtype), [k, x, dtype(1)])
                for name, value in zip(("sn", "cn", "dn"), found, strict=True):
                    m = 1 - mpmath.mpf(float(k)) ** 2
                    true = mpmath.ellipfun(name, mpmath.mpf(float(x)), m=m)
                    wrong = abs(true - mpmath.mpf(float(value)))
                    largest = max(largest, float(wrong / (u * (1 + abs(float(x))))))
    return largest
