"""Taylor steps as long as they propose meet reference motions, and their tolerance."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import flint
import numpy as np
import pytest

from derive.motion.taylor import taylor_step
from derive.motion.taylor.series import TaylorStep
from derive.program.arithmetic import working
from derive.program.program import Op, Program
from tests.made import thinned
from tests.motion.rates import BODY, body, constant
from tests.motion.solution import (
    BALLS,
    CHOICES,
    FLOATS,
    FREE,
    STATE,
    U,
    ball,
    catalogued,
    handmade,
    largest,
    run_series,
    truncation,
)

CASES = {
    case["id"]: case
    for case in json.loads(
        (Path(__file__).parent.parent / "data" / "rotations.json").read_text(encoding="utf-8")
    )["cases"]
}


def driven(step: TaylorStep, state: Sequence[float], time: float) -> list[float]:
    """Return the state after a time, every step as long as the one before proposes."""
    now, passed, h = list(state), 0.0, time / 256
    while passed < time:
        h = min(h, time - passed)
        *new, proposed = run_series(step, FLOATS, [*now, h], 53)
        if proposed < 0.8 * h:  # too long: once more
            h = proposed
            continue
        now, passed, h = new, passed + h, proposed
    return now


# The file has no kappa for these: largest change of the end, relative and in rad, by a relative
# change of one input, by steps of order 24 in balls of 200 bits.
KAPPA = {"gyrostat_wheel": (3.8, 21.2), "const_body_torque": (5.8, 47.8)}


def case_rate(case: Mapping[str, Any]) -> Program:
    inertia = [Fraction(case["inertia"][i][i]) for i in range(3)]
    moment = constant([Fraction(m) for m in case.get("M", ("0", "0", "0"))])
    return body(inertia, moment, [Fraction(x) for x in case.get("h", ("0", "0", "0"))])


def ended(case: Mapping[str, Any], found: Sequence[float]) -> tuple[float, float]:
    """Return the errors of omega, relative, and of the attitude, in rad, in units of u."""
    q, w = ([Fraction(x) for x in part] for part in (found[:4], found[4:]))
    r, v = ([Fraction(x) for x in case[name]] for name in ("q_T", "omega_T"))
    own = math.sqrt(sum((a - b) ** 2 for a, b in zip(w, v, strict=True)))
    turn = (
        q[0] * r[1] - q[1] * r[0] - q[2] * r[3] + q[3] * r[2],
        q[0] * r[2] - q[2] * r[0] - q[3] * r[1] + q[1] * r[3],
        q[0] * r[3] - q[3] * r[0] - q[1] * r[2] + q[2] * r[1],
    )
    return own / math.hypot(*v) / U, 2 * math.hypot(*map(float, turn)) / U


@pytest.mark.long
@pytest.mark.parametrize(
    "name",
    [
        "separatrix_exact",
        "tiny_scale_f32",
        pytest.param("gyrostat_wheel", marks=pytest.mark.long),
        "const_body_torque",
        pytest.param("nontriangle", marks=pytest.mark.long),
    ],
)
def test_a_reference_case_is_met_to_a_few_times_what_rounded_inputs_allow(name: str) -> None:
    case = CASES[name]
    step = taylor_step(case_rate(case), BODY, (), 20)
    state = [float.fromhex(x) for part in ("q0_hex", "omega0_hex") for x in case[part]]
    kappas = KAPPA.get(name) or tuple(
        float(case[f"cond_{which}_per_unit_rel_input"]) for which in ("omega_rel", "angle_rad")
    )
    # Every step rounds about as much as the inputs do, and a few roundings add up.
    for error, kappa in zip(
        ended(case, driven(step, state, float(case["T"]))), kappas, strict=True
    ):
        assert error < 4 * kappa


def in_float(name: str, order: int) -> tuple[float, float]:
    """Return the errors, in u of float, of a case moved as proposed; no step is redone."""
    case, table = CASES[name], working(np.float32)
    step = taylor_step(case_rate(case), BODY, (), order)
    now = [np.float32(float.fromhex(x)) for part in ("q0_hex", "omega0_hex") for x in case[part]]
    passed, time = 0.0, float(case["T"])
    h = np.float32(time / 128)
    while passed < time:
        h = min(h, np.float32(time - passed))
        *now, proposed = run_series(step, table, [*now, h], 24)
        passed, h = passed + float(h), np.float32(proposed)
    omega, angle = ended(case, list(map(float, now)))
    return omega / 2**29, angle / 2**29


@pytest.mark.parametrize("order", [12, 20])
def test_float_is_met_too_at_an_order_that_is_higher_than_it_needs(order: int) -> None:
    errors = in_float("const_body_torque", order)
    for error, kappa in zip(errors, KAPPA["const_body_torque"], strict=True):
        assert error < 4 * kappa


def test_float_is_missed_if_terms_may_fall_as_slowly_as_they_like(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("derive.motion.taylor.series.SLOWEST", Fraction(1))
    assert in_float("const_body_torque", 20)[1] > 100 * KAPPA["const_body_torque"][1]


@pytest.mark.parametrize("tolerance", [U, 1e-11])
@pytest.mark.parametrize("name", thinned(["free", "top", "heavy_top"], 3))
def test_a_step_as_long_as_proposed_leaves_out_what_it_may(name: str, tolerance: float) -> None:
    step, rate, values = catalogued(name) if name == "heavy_top" else handmade(name)
    stretch = (tolerance / U) ** (1 / step.order)
    h = 1e-3
    for _ in range(8):
        *_, proposed = run_series(step, BALLS | CHOICES, [*map(ball, values), flint.arb(h)], 53)
        h = float(proposed) * stretch
    error = largest(truncation(step, rate, values, Fraction(h)))
    # The last term is 0.9^20 = 0.12 of the tolerance, the sum of those left out a fifth of it or
    # less; the largest state is about 1, the rates are of several sizes.
    assert tolerance / 1e4 < error < tolerance


def test_a_step_too_long_is_told_and_rest_is_stable() -> None:
    step = taylor_step(FREE, BODY, (), 20)
    fit = run_series(step, FLOATS, [*map(float, STATE), 0.1], 53)[-1]
    assert run_series(step, FLOATS, [*map(float, STATE), 3 * fit], 53)[-1] < 1.5 * fit
    still = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    *state, proposed = run_series(step, FLOATS, [*still, 0.25], 53)
    assert (state, proposed) == (still, pytest.approx(1.0, rel=0.05))  # 4 times
    assert run_series(step, FLOATS, [*map(float, STATE), 0.0], 53)[-1] == 0


def test_a_proposal_that_does_not_read_the_last_terms_is_noticed() -> None:
    step = taylor_step(FREE, BODY, (), 20)
    ends = {f"{x}_{end}": f"{x}_first" for x in step.rates for end in ("last", "before")}

    def blind(op: Op) -> Op:
        return Op(op.result, op.operator, tuple(ends.get(str(o), o) for o in op.operands))

    wrong = replace(step, close=tuple(map(blind, step.close)))
    state = [*map(float, STATE), 0.1]
    assert run_series(wrong, FLOATS, state, 53)[-1] < run_series(step, FLOATS, state, 53)[-1] / 2
