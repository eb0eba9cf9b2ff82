"""Derivatives of a step are its slopes, keep its structure, and cost what they were given for."""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest

from derive.lower.signs import with_signs_outside
from derive.motion.runge_kutta import step
from derive.motion.runge_kutta.dependence import free_omega
from derive.motion.runge_kutta.system import System
from derive.program.arithmetic import EXACT, working
from derive.program.program import Op, Program
from derive.program.recorded import needed
from derive.program.run import run
from tests.made import thinned
from tests.motion.rates import BODY, body, hanging
from tests.motion.slopes import with_slopes
from tests.motion.systems import (
    CONTEXT,
    EVERY,
    Values,
    at,
    mpf,
    start,
    system,
    unit,
    without_slopes,
)

SMALL = mpf(10) ** -12  # a central difference over it errs by its fourth power: 1e-46
EXACTLY = mpf(10) ** -40
TOP = (Fraction(7, 5), Fraction(3, 2), Fraction(9, 5))


def hung() -> tuple[System, Values]:
    """Return a body whose moment rests on its attitude, and values to step from."""
    rate = body(TOP, hanging, (Fraction(0),) * 3)
    slopes = with_slopes(rate, [c for q in BODY for c in q.components])
    parts = dict(zip("wxyz", (0.7, -0.3, 0.5, 0.4), strict=True))
    values = unit({f"attitude_{k}": mpf(v) for k, v in parts.items()})
    values |= {f"omega_{k}": mpf(v) for k, v in zip("xyz", (1.1, -2.3, 0.7), strict=True)}
    return System(BODY, rate, slopes), values | {"time_step": mpf("0.05")}


CASES = (*EVERY, "hung")


@cache
def case(name: str) -> tuple[System, Values]:
    """Return a motion that is tested, and values to step from."""
    return hung() if name == "hung" else (system(name), start(name))


def entries(program: Program, values: Values) -> dict[tuple[str, str], Any]:
    """Return the derivatives that a program returns, by the names of row and column."""
    pattern = (program.sparsity or {})["jacobian"]
    found = at(program, values)[-len(pattern.row) :]
    named = ((pattern.rows[i], pattern.columns[k]) for i, k in pattern.places())
    return dict(zip(named, found, strict=True))


def slopes(program: Program, values: Values, column: str) -> list[Any]:
    """Return the derivatives of a program's results by one of its inputs: central differences."""
    before2, before, after, after2 = (
        at(program, dict(values) | {column: values[column] + part * SMALL})
        for part in (-2, -1, 1, 2)
    )
    terms = zip(before2, before, after, after2, strict=True)
    return [(8 * (c - b) - (d - a)) / (12 * SMALL) for a, b, c, d in terms]


def worst(made: Program, plain: Program, values: Values) -> Any:
    """Return the largest error of the derivatives, with what is left out taken for zero."""
    pattern = (made.sparsity or {})["jacobian"]
    found, error = entries(made, values), mpf(0)
    for column in pattern.columns:
        pairs = zip(pattern.rows, slopes(plain, values, column), strict=True)
        error = max(error, *(abs(found.get((row, column), 0) - slope) for row, slope in pairs))
    return error


@pytest.mark.parametrize("name", thinned(CASES, 6))
def test_the_jacobian_is_the_slope_of_the_step(name: str) -> None:
    given, values = case(name)
    assert worst(step(given, "step_rk4_jacobian"), step(given, "step_rk4"), values) < EXACTLY


def test_the_jacobian_is_the_slope_where_the_attitude_is_off_the_sphere_too() -> None:
    given, values = case("principal")
    off = dict(values) | {"attitude_x": values["attitude_x"] + mpf("0.01")}
    assert worst(step(given, "step_rk4_jacobian"), step(given, "step_rk4"), off) < EXACTLY


@pytest.mark.parametrize("name", thinned(CASES, 6))
def test_the_step_is_the_same_with_its_jacobian(name: str) -> None:
    given, values = case(name)
    alone, with_jacobian = step(given, "step_rk4"), step(given, "step_rk4_jacobian")
    count = len(given.names)
    pairs = zip(at(alone, values), at(with_jacobian, values)[:count], strict=True)
    assert max(abs(a - b) for a, b in pairs) < EXACTLY


@pytest.mark.parametrize("name", thinned(["principal", "rigid_body", "heavy_top"], 2))
def test_the_sensitivity_is_the_slope_by_what_the_rates_are_made_of(name: str) -> None:
    given, values = case(name)
    constants = [c for q in given.rate.inputs if q.role == "constants" for c in q.components]
    used = [c for c in constants if any(c in op.operands for op in given.rate.ops)]
    sensitive = replace(given, slopes=with_slopes(given.rate, [*given.names, *used]))
    assert worst(step(sensitive, "step_rk4_sensitivity"), step(given, "step_rk4"), values) < EXACTLY


def exponential(delta: list[Any]) -> list[Any]:
    """Return exp(delta / 2) as a quaternion."""
    angle = CONTEXT.sqrt(sum(d * d for d in delta)) / 2
    ratio = CONTEXT.sin(angle) / angle / 2 if angle else mpf(1) / 2
    return [CONTEXT.cos(angle), *(d * ratio for d in delta)]


def times(p: list[Any], q: list[Any]) -> list[Any]:
    """Return the Hamilton product."""
    (a, b, c, d), (w, x, y, z) = p, q
    return [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y + c * w + d * x - b * z,
        a * z + d * w + b * y - c * x,
    ]


def moved(given: System, values: Values, name: str, by: Any) -> dict[str, Any]:
    """Return values with one of them changed; an error of attitude turns it from the right."""
    if not name.startswith("attitude_error"):
        return dict(values) | {name: values[name] + by}
    names = [f"attitude_{k}" for k in "wxyz"]
    delta = [by if name.endswith(k) else mpf(0) for k in "xyz"]
    turned = times([values[c] for c in names], exponential(delta))
    return dict(values) | dict(zip(names, turned, strict=True))


def errors(given: System, after: list[Any], reference: list[Any]) -> list[Any]:
    """Return how far ``after`` is from ``reference``, the attitude by three errors."""
    place = given.quaternion
    q, p = reference[place], after[place]
    turn = times([q[0], *(-x for x in q[1:])], p)
    apart = [a - b for a, b in zip(after, reference, strict=True)]
    return [*apart[: place.start], *(2 * x for x in turn[1:]), *apart[place.stop :]]


@pytest.mark.parametrize("method", ["rk4", "lie"])
@pytest.mark.parametrize("name", thinned(["principal", "rigid_body", "hung"], 2))
def test_the_tangent_jacobian_is_the_slope_through_the_exponential_map(
    name: str, method: str
) -> None:
    given, values = case(name)
    plain, tangent = (step(given, f"step_{method}{kind}") for kind in ("", "_tangent"))
    reference, found = at(plain, values), entries(tangent, values)
    pattern = (tangent.sparsity or {})["jacobian"]
    for column in pattern.columns:
        ends = [
            errors(given, at(plain, moved(given, values, column, part * SMALL)), reference)
            for part in (1, -1)
        ]
        for row, forth, back in zip(pattern.rows, *ends, strict=True):
            # a difference over 1e-12 errs by its square
            slope = (forth - back) / (2 * SMALL)
            assert abs(found.get((row, column), 0) - slope) < mpf(10) ** -18, (row, column)


@pytest.mark.long
def test_the_tangent_jacobian_has_three_columns_for_the_attitude() -> None:
    pattern = (step(system("rigid_body"), "step_rk4_tangent").sparsity or {})["jacobian"]
    assert len(pattern.rows) == 12
    assert len(pattern.columns) == 12 + 6


def test_a_motion_without_a_quaternion_has_no_tangent_space() -> None:
    with pytest.raises(ValueError, match="needs one attitude quaternion"):
        step(system("heavy_top"), "step_rk4_tangent")


def test_derivatives_of_a_step_need_those_of_its_rates() -> None:
    with pytest.raises(ValueError, match="need the Jacobian of 'state_rate'"):
        step(without_slopes(system("principal")), "step_rk4_jacobian")


def by_states(program: Program, count: int) -> Program:
    """Return a step with the columns of its states only."""
    pattern = (program.sparsity or {})["jacobian"]
    kept = len(program.results) - len(pattern.row) + pattern.colind[count]
    results = program.results[:kept]
    return replace(program, ops=needed(program.ops, results), results=results)


def test_the_step_of_a_principal_body_with_its_jacobian_costs_at_most_840_operations() -> None:
    program = step(system("principal"), "step_rk4_jacobian")
    assert by_states(program, 7).flops() <= 781  # SymForce: 1626; 840 were asked for
    assert program.flops() <= 898  # with the columns of the moment


@pytest.mark.long
def test_the_step_of_thirteen_states_with_its_sensitivities_costs_at_most_2949_operations() -> None:
    assert step(system("rigid_body"), "step_rk4_jacobian").flops() <= 2947  # CasADi: 5898


def test_known_zeros_are_not_stored() -> None:
    pattern = (step(system("principal"), "step_rk4_jacobian").sparsity or {})["jacobian"]
    places = {(pattern.rows[i], pattern.columns[k]) for i, k in pattern.places()}
    assert not {p for p in places if p[0].startswith("omega") and p[1].startswith("attitude")}
    assert len(places) == 16 + 12 + 9 + 12 + 9


@pytest.mark.long
def test_an_attitude_turns_freely_if_its_angular_velocity_never_knows_it() -> None:
    found = {name: free_omega(case(name)[0]) for name in CASES}
    assert [name for name, place in found.items() if place] == ["principal", "rigid_body"]


def test_an_attitude_with_other_kinematics_is_not_taken_for_one_that_turns_freely() -> None:
    given = system("principal")
    swapped = (given.rate.results[1], given.rate.results[0], *given.rate.results[2:])
    assert not free_omega(replace(given, rate=replace(given.rate, results=swapped)))


def test_a_mutant_of_the_jacobian_is_found() -> None:
    given, values = case("principal")
    made, plain = step(given, "step_rk4_jacobian"), step(given, "step_rk4")
    for place, op in list(enumerate(made.ops))[-400::29]:
        if isinstance(op, Op) and op.operator in ("add", "sub"):
            flipped = replace(op, operator="sub" if op.operator == "add" else "add")
            ops = (*made.ops[:place], flipped, *made.ops[place + 1 :])
            assert worst(replace(made, ops=ops), plain, values) > mpf(10) ** -9, op


def rounding(program: Program, values: Values, dtype: type) -> float:
    """Return the largest error of the derivatives over the largest of them, in u."""
    names = [c for q in program.inputs for c in q.components]
    rounded = {c: dtype(float(values[c])) for c in names}
    found = run(program, working(dtype), [rounded[c] for c in names])
    true = at(program, {c: mpf(float(v)) for c, v in rounded.items()})
    scale = max(abs(float(t)) for t in true)
    unit_roundoff = float(np.finfo(dtype).eps) / 2
    apart = (abs(mpf(float(f)) - t) for f, t in zip(found, true, strict=True))
    return float(max(apart)) / scale / unit_roundoff


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("name", ["principal", "heavy_top", "hung"])
def test_rounding_leaves_a_few_u(name: str, dtype: type) -> None:
    given, values = case(name)
    # some hundred roundings, most of them of terms that the step's length makes small
    assert rounding(step(given, "step_rk4_jacobian"), values, dtype) <= 16


def test_moving_signs_changes_no_bit() -> None:
    rate = hung()[0].slopes
    assert rate is not None
    names: Mapping[str, Fraction] = {
        c: Fraction(2 * k * k - 7, 3 * k + 1)
        for k, c in enumerate(c for q in rate.inputs for c in q.components)
    }
    turned = with_signs_outside(rate, "t")
    floats = [np.float32(float(v)) for v in names.values()]
    assert run(turned, working(np.float32), floats) == run(rate, working(np.float32), floats)
    exactly = list(names.values())
    assert run(turned, EXACT, exactly) == run(rate, EXACT, exactly)


def test_operations_are_never_called_as_a_constant_is() -> None:
    given = without_slopes(system("principal"))
    awkward = replace(given, rate=_renamed(given.rate, {"one_over_I_xx": "t7"}))
    values = dict(start("principal")) | {"t7": start("principal")["one_over_I_xx"]}
    assert at(step(awkward, "step_rk4"), values) == at(step(given, "step_rk4"), values)


def _renamed(rate: Program, names: Mapping[str, str]) -> Program:
    """Return a rate with new names of constants, and with others for its operations."""
    made = {op.result: f"r{op.result}" for op in rate.ops} | dict(names)
    ops = tuple(
        Op(made[op.result], op.operator, tuple(made.get(o, o) for o in op.operands))
        for op in rate.ops
    )
    inputs = tuple(
        replace(q, components=tuple(names.get(c, c) for c in q.components)) for q in rate.inputs
    )
    results = tuple(made.get(r, r) for r in rate.results)
    return replace(rate, ops=ops, results=results, inputs=inputs)
