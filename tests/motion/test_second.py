"""Second derivatives of the step that keeps the length of q: slopes of its Jacobian, and few."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest

from derive.motion.runge_kutta import step
from derive.motion.runge_kutta.second import second_derivatives
from derive.motion.runge_kutta.system import System
from derive.program.program import Op, Program
from tests.motion.systems import Values, at, mpf
from tests.motion.test_step_jacobian import case

NEAR = mpf(10) ** -30  # a central difference over 1e-16 errs by its square
BY = mpf(10) ** -16


def weights(given: System) -> dict[str, Any]:
    return {f"adjoint_{k}": mpf(3 * k * k - 10 * k + 4) / 7 for k in range(len(given.names))}


def gradient(jacobian: Program, given: System, values: Values) -> dict[str, Any]:
    """Return the derivatives of the weighed sum of what a step returns."""
    pattern = (jacobian.sparsity or {})["jacobian"]
    found, weigh = dict.fromkeys(pattern.columns, mpf(0)), list(weights(given).values())
    for (i, k), slope in zip(
        pattern.places(), at(jacobian, values)[len(given.names) :], strict=True
    ):
        found[pattern.columns[k]] += weigh[i] * slope
    return found


def gap(made: Program, given: System, values: Values) -> Any:
    """Return the largest error of second derivatives, what is left out taken for zero."""
    jacobian = step(given, "step_rk4_unit_jacobian")
    pattern = (made.sparsity or {})["hessian"]
    found: dict[tuple[int, int], Any] = {}
    for (i, k), x in zip(pattern.places(), at(made, dict(values) | weights(given)), strict=True):
        found[i, k] = found[k, i] = x
    worst = mpf(0)
    for k, name in enumerate(pattern.columns):
        after, before = (
            gradient(jacobian, given, dict(values) | {name: values[name] + side * BY})
            for side in (1, -1)
        )
        for i, row in enumerate(pattern.rows):
            slope = (after[row] - before[row]) / (2 * BY)
            worst = max(worst, abs(slope - found.get((i, k), 0)))
    return worst


def off_the_sphere() -> tuple[System, Mapping[str, Any]]:
    given, values = case("principal")
    return given, dict(values) | {"attitude_x": values["attitude_x"] + mpf("0.3")}


@pytest.mark.long
def test_they_are_the_slopes_of_the_jacobian_on_the_sphere_and_off_it() -> None:
    given, off = off_the_sphere()
    made = second_derivatives(given)
    assert gap(made, given, case("principal")[1]) < NEAR
    assert gap(made, given, off) < NEAR


def test_there_are_45_a_step_and_none_by_the_attitude_twice() -> None:
    pattern = (second_derivatives(case("principal")[0]).sparsity or {})["hessian"]
    assert len(pattern.row) == 45
    assert not [(i, k) for i, k in pattern.places() if i < 4 and k < 4]


@pytest.mark.long
def test_mutants_are_found() -> None:
    given, off = off_the_sphere()
    made = second_derivatives(given)
    assert gap(made, given, off) < NEAR
    for place, op in list(enumerate(made.ops))[150::397]:
        if isinstance(op, Op) and op.operator in ("add", "sub", "mul"):
            other = {"add": "sub", "sub": "add", "mul": "add"}[op.operator]
            ops = (*made.ops[:place], replace(op, operator=other), *made.ops[place + 1 :])
            assert gap(replace(made, ops=ops), given, off) > mpf(10) ** -9, op


@pytest.mark.parametrize("name", ["hung", pytest.param("rigid_body", marks=pytest.mark.long)])
def test_a_rate_that_rests_on_the_attitude_has_none(name: str) -> None:
    with pytest.raises(ValueError, match=r"keeps the length of a quaternion|rests on 'attitude_w'"):
        second_derivatives(case(name)[0])
