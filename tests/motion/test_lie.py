"""The Lie-group step is of order four, and exact where a body turns steadily."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from derive.motion.runge_kutta import step
from derive.program.arithmetic import working
from derive.program.program import Op
from derive.program.run import run
from tests.made import thinned
from tests.motion.systems import at, mpf, start, system
from tests.motion.test_runge_kutta import order
from tests.motion.test_step_jacobian import EXACTLY, case, rounding, worst

QUATERNIONS = ("principal", "rigid_body", "hung")


@pytest.mark.parametrize("name", thinned(QUATERNIONS, 3))
def test_the_order_is_four(name: str) -> None:
    given, values = case(name)
    # an order is a limit: at h = T/16 the next power still has a few per cent
    assert order(step(given, "step_lie"), given, values) == pytest.approx(4, abs=0.15)


def test_the_order_is_four_without_torque() -> None:
    given, still = system("principal"), dict(start("principal"))
    still |= {f"moment_{axis}": mpf(0) for axis in "xyz"}
    assert order(step(given, "step_lie"), given, still) == pytest.approx(4, abs=0.15)


def test_exponentials_in_the_wrong_order_are_found() -> None:
    given, values = case("principal")
    program = step(given, "step_lie")
    quarter, twelfth = Fraction(1, 4), Fraction(-1, 12)
    swapped = {quarter: twelfth, twelfth: quarter, Fraction(1, 12): quarter}
    ops = tuple(
        replace(op, operands=tuple(swapped.get(o, o) for o in op.operands))
        if isinstance(op, Op)
        else op
        for op in program.ops
    )
    assert ops != program.ops
    assert order(replace(program, ops=ops), given, values) < 3


def test_a_steady_turn_is_exact_however_long_the_step() -> None:
    given, values = system("principal"), dict(start("principal"))
    values |= {f"moment_{axis}": mpf(0) for axis in "xyz"} | {"time_step": mpf(3)}
    values |= {"omega_x": mpf(2), "omega_y": mpf(0), "omega_z": mpf(0)}
    values |= dict(zip((f"attitude_{k}" for k in "wxyz"), map(mpf, (1, 0, 0, 0)), strict=True))
    after = at(step(given, "step_lie"), values)
    cos, sin = values["time_step"].context.cos(3), values["time_step"].context.sin(3)
    assert max(abs(a - b) for a, b in zip(after, (cos, sin, 0, 0), strict=False)) < mpf(10) ** -50
    coarse = at(step(given, "step_rk4"), values)
    assert abs(coarse[0] - cos) > 0.1


def test_a_body_at_rest_stays_at_rest() -> None:
    given, values = case("principal")
    program = step(given, "step_lie")
    floats = {c: 0.0 if c[:3] in ("ome", "mom") else float(v) for c, v in values.items()}
    names = [c for q in program.inputs for c in q.components]
    after = run(program, working(np.float64), [np.float64(floats[c]) for c in names])
    before = [floats[c] for c in given.names]
    assert max(abs(float(a) - b) for a, b in zip(after, before, strict=True)) <= 2.0**-52


def test_a_motion_without_a_quaternion_has_no_such_step() -> None:
    with pytest.raises(ValueError, match="needs an attitude quaternion"):
        step(system("heavy_top"), "step_lie")


@pytest.mark.parametrize("name", thinned(QUATERNIONS, 2))
def test_the_jacobian_is_the_slope_of_the_step(name: str) -> None:
    given, values = case(name)
    assert worst(step(given, "step_lie_jacobian"), step(given, "step_lie"), values) < EXACTLY


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("speed", thinned(["1e-30", "1", "1e-6"], 2))
def test_rounding_leaves_a_few_u_also_where_a_body_hardly_turns(speed: str, dtype: type) -> None:
    given, values = case("principal")
    slow = {c: v * mpf(speed) if c[:2] in ("om", "mo") else v for c, v in values.items()}
    # a few hundred roundings, most of them of terms that the step's length makes small
    assert rounding(step(given, "step_lie_jacobian"), slow, dtype) <= 8


@pytest.mark.long
def test_a_mutant_of_the_jacobian_is_found() -> None:
    given, values = case("principal")
    made = step(given, "step_lie_jacobian")
    for place, op in list(enumerate(made.ops))[-300::37]:
        if isinstance(op, Op) and op.operator in ("add", "sub"):
            flipped = replace(op, operator="sub" if op.operator == "add" else "add")
            ops = (*made.ops[:place], flipped, *made.ops[place + 1 :])
            assert worst(replace(made, ops=ops), step(given, "step_lie"), values) > mpf(10) ** -9, (
                op
            )
