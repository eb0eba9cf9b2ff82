"""The classic step is of order four on every state, with torque and without."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from derive.motion.runge_kutta import step
from derive.motion.runge_kutta.system import System
from derive.program.program import Op, Program
from tests.made import thinned
from tests.motion.systems import (
    EVERY,
    Values,
    flowed,
    mpf,
    start,
    stepped,
    system,
    without_slopes,
)

TIME = mpf("0.04")  # s; short enough for the extrapolated reference to be exact


def errors(program: Program, given: System, values: Values) -> list[float]:
    """Return the errors after ``TIME`` in 8 and 16 steps, the largest of all components."""
    true = flowed(given, values, TIME)
    found = []
    for count in (8, 16):
        end = stepped(program, given.names, dict(values) | {"time_step": TIME / count}, count)
        found.append(max(abs(end[c] - y) for c, y in zip(given.names, true, strict=True)))
    return found


def order(program: Program, given: System, values: Values) -> float:
    """Return the order of convergence."""
    coarse, fine = errors(program, given, values)
    return float(np.log2(float(coarse / fine)))


@pytest.mark.parametrize("name", thinned(EVERY, 3))
def test_the_order_is_four(name: str) -> None:
    given = without_slopes(system(name))
    # an order is a limit: at h = T/16 the next power still has a few per cent
    assert order(step(given, "step_rk4"), given, start(name)) == pytest.approx(4, abs=0.15)


def test_the_order_is_four_without_torque() -> None:
    given, still = without_slopes(system("principal")), dict(start("principal"))
    still |= {f"moment_{axis}": mpf(0) for axis in "xyz"}
    assert order(step(given, "step_rk4"), given, still) == pytest.approx(4, abs=0.15)


def test_a_step_with_a_wrong_weight_is_found() -> None:
    given = without_slopes(system("principal"))
    program = step(given, "step_rk4")
    thirds = [op for op in program.ops if isinstance(op, Op) and Fraction(1, 3) in op.operands]
    assert thirds
    wrong = replace(
        program,
        ops=tuple(
            replace(op, operands=(op.operands[0], Fraction(3, 10))) if op in thirds else op
            for op in program.ops
        ),
    )
    assert order(wrong, given, start("principal")) < 2
