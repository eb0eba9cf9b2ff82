"""A Taylor step has the terms of the solution and the order that it says."""

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import flint
import pytest

from derive.motion.taylor import taylor_step
from derive.motion.taylor.series import Convolution, TaylorStep, in_loops
from derive.program.arithmetic import EXACT
from derive.program.program import Op
from derive.program.run import run
from tests.made import thinned
from tests.motion.rates import BODY, quantity, rate
from tests.motion.solution import (
    FLOATS,
    FREE,
    STATE,
    TOP,
    catalogued,
    faults,
    handmade,
    largest,
    run_series,
    series_terms,
    state_names,
    truncation,
)


@pytest.mark.parametrize("name", ["heavy_top", "gyrostat", "rigid_body"])
def test_the_terms_of_a_scene_of_the_catalogue_are_those_of_iterated_integrals(name: str) -> None:
    assert faults(*catalogued(name)) == []


@pytest.mark.parametrize("name", ["free", "top", "everything"])
def test_the_terms_of_a_rate_by_hand_are_those_of_iterated_integrals(name: str) -> None:
    assert faults(*handmade(name)) == []


def test_the_terms_of_a_free_body_are_exact_in_fractions() -> None:
    step = taylor_step(FREE, BODY, (), 12)
    terms = series_terms(step, EXACT, [*STATE, Fraction(1)])
    series = {
        "number": lambda q: flint.fmpq_series([flint.fmpq(q.numerator, q.denominator)], prec=13)
    }
    flint.ctx.cap = 13
    start = [series["number"](q) for q in STATE]
    now = start
    for _ in range(12):
        rates = run(FREE, FLOATS | series, now)
        now = [x + f.integral() for x, f in zip(start, rates, strict=True)]
    for x, true in zip(state_names(step), now, strict=True):
        assert [flint.fmpq(t.numerator, t.denominator) for t in terms[x]] == [
            true[k] for k in range(13)
        ]


def mutants(step: TaylorStep) -> dict[str, TaylorStep]:
    """Return steps with one thing wrong each."""
    found: dict[str, TaylorStep] = {}
    swapped = {"add": "sub", "sub": "add", "mul": "add"}
    for i, op in enumerate(step.each):
        if op.operator in swapped:
            wrong = Op(op.result, swapped[op.operator], op.operands)
            each = (*step.each[:i], wrong, *step.each[i + 1 :])
            found[f"{wrong}"] = replace(step, each=each)
    for i, c in enumerate(step.products):
        for what, wrong_sum in (
            ("signs", Convolution(c.result, c.minus, c.plus)),
            (
                "first product twice",
                Convolution(c.result, (*c.plus, (c.plus + c.minus)[0]), c.minus),
            ),
        ):
            products = (*step.products[:i], wrong_sum, *step.products[i + 1 :])
            found[f"{c.result}: {what}"] = replace(step, products=products)
    for x, (first, kth) in step.rates.items():
        if kth != 0:
            found[f"{x}: no rate"] = replace(step, rates=step.rates | {x: (first, Fraction(0))})
    return found


@pytest.mark.parametrize("name", ["heavy_top", "everything"])
def test_every_wrong_recurrence_is_noticed(name: str) -> None:
    made = catalogued(name) if name == "heavy_top" else handmade(name)
    step, rate, values = made
    short = replace(step, order=6)
    wrong = mutants(short)
    assert len(wrong) > 20
    assert [what for what, mutant in wrong.items() if not faults(mutant, rate, values)] == []


@pytest.mark.parametrize("name", thinned(["top", "free", "heavy_top", "gyrostat"], 2))
@pytest.mark.parametrize("order", [12, 20])
def test_the_measured_order_is_the_claimed_one(name: str, order: int) -> None:
    made = catalogued(name) if "_" in name or name == "gyrostat" else handmade(name)
    step, rate, values = replace(made[0], order=order), *made[1:]
    h = Fraction(1, 2**11)
    ratio = largest(truncation(step, rate, values, h)) / largest(
        truncation(step, rate, values, h / 2)
    )
    # A step of order p is wrong by a multiple of h^(p + 1), and at these lengths by little else.
    assert math.log2(ratio) - 1 == pytest.approx(order, abs=0.1)


def test_a_rate_that_has_no_recurrence_is_refused() -> None:
    states = (BODY[1],)
    program = replace(
        rate(states, lambda v: (v["omega_x"] * 2, 0, 0)),
        ops=(Op("t0", "atan2", ("omega_x", Fraction(1))),),
    )
    with pytest.raises(ValueError, match="'atan2' has no Taylor recurrence"):
        taylor_step(program, states, (), 12)


def test_a_name_that_the_step_needs_itself_is_refused() -> None:
    states = (quantity("t0_end0", ""), quantity("y", ""))
    program = rate(states, lambda v: (v["t0_end0"] * v["y"], v["y"]))
    with pytest.raises(ValueError, match="'t0_end0' is also the name of a value"):
        taylor_step(program, states, (), 12)


def test_cost_is_that_of_the_operations() -> None:
    counted = {"n": 0}

    def count(a: Any, b: Any) -> float:
        counted["n"] += 1
        return 1.0

    step = taylor_step(TOP, BODY, (), 12)
    table = FLOATS | dict.fromkeys(("add", "sub", "mul", "div"), count)
    run_series(step, table, [1.0] * 8, 53)
    assert in_loops(step).flops() == counted["n"]
