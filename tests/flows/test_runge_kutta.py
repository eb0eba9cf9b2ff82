"""The classic step is of order four, and its attitude stays on the sphere."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from derive.arithmetic import working
from derive.flows.steps import step_rk4
from derive.flows.system import System
from derive.program import Op, Program, run
from tests.flows.systems import (
    EVERY,
    Values,
    at,
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


@pytest.mark.parametrize("name", EVERY)
def test_the_order_is_four(name: str) -> None:
    given = without_slopes(system(name))
    # an order is a limit: at h = T/16 the next power still has a few per cent
    assert order(step_rk4(given), given, start(name)) == pytest.approx(4, abs=0.15)


def test_the_order_is_four_without_torque() -> None:
    given, still = without_slopes(system("principal")), dict(start("principal"))
    still |= {f"moment_{axis}": mpf(0) for axis in "xyz"}
    assert order(step_rk4(given), given, still) == pytest.approx(4, abs=0.15)


def test_a_step_with_a_wrong_weight_is_found() -> None:
    given = without_slopes(system("principal"))
    program = step_rk4(given)
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


def lengths(program: Program, given: System, dtype: type, count: int) -> float:
    """Return how far from one the attitude's length is after ``count`` steps of one program."""
    values = {c: dtype(float(v)) for c, v in start("principal").items()}
    values |= {"time_step": dtype(0.01)}
    for _ in range(count):
        given_now = [values[c] for q in program.inputs for c in q.components]
        values |= dict(zip(given.names, run(program, working(dtype), given_now), strict=False))
    q = [float(values[c]) for c in given.names if c.startswith("attitude")]
    return abs(float(np.sqrt(np.sum(np.square(q)))) - 1)


def test_the_attitude_stays_on_the_sphere() -> None:
    given = without_slopes(system("principal"))
    # one rounding of a component and of the scale: 2 u of the length, however many steps
    assert lengths(step_rk4(given), given, np.float32, 2000) <= 2 * 2.0**-24


def test_an_attitude_that_was_not_of_length_one_is_after_a_step() -> None:
    given = without_slopes(system("rigid_body"))
    values = dict(start("rigid_body"))
    values |= {c: values[c] * mpf("1.01") for c in given.names if c.startswith("attitude")}
    after = dict(zip(given.names, at(step_rk4(given), values), strict=True))
    squared = sum(v**2 for c, v in after.items() if c.startswith("attitude"))
    assert abs(squared - 1) < mpf(10) ** -55
