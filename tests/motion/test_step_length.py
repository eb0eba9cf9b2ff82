"""Jacobians of steps have a column by the step's length where a scene asks for it, and no other."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.library.library import Library, library
from derive.motion.runge_kutta import step
from derive.motion.runge_kutta.system import System
from derive.program.precision import F64
from derive.program.program import Op, Program
from derive.scene import parse_scene
from derive.verify.differences import GAP, slopes
from derive.verify.draw import with_motion
from derive.verify.sample import Sample, samples
from tests.made import CATALOGUE, thinned
from tests.motion.systems import Values, at, mpf
from tests.motion.test_step_jacobian import EXACTLY, SMALL, case, entries, errors, moved, worst

TRIAL = Path(__file__).parents[1] / "data" / "trials" / "minimum_time.toml"
ROUNDED = 1e-13  # of the largest entry: some hundreds of roundings, in two orders
KINDS = ("rk4", "rk4_unit", "lie")
CASES = [(name, kind) for name in ("principal", "rigid_body") for kind in KINDS]
CASES += [("hung", "rk4"), ("hung", "lie")]


def made_of(name: str, method: str, kind: str) -> tuple[Program, Program, System, Values]:
    """Return a step with a column by its length, the step alone, its motion and a start."""
    given, values = case(name)
    with_column = replace(given, column=True)
    made = step(with_column, f"step_{method}_{kind}")
    return made, step(given, f"step_{method}"), with_column, values


def drawn(made: Library) -> tuple[Sample, ...]:
    return with_motion(made, samples(made.mechanism, F64, 1, 0).each, F64)


@cache
def trial() -> Library:
    return library(parse_scene(TRIAL.read_text(encoding="utf-8"), "minimum_time"))


@pytest.mark.parametrize("of", thinned(CASES, 4))
def test_the_column_is_the_slope_of_the_step_by_its_length(of: tuple[str, str]) -> None:
    made, plain, given, values = made_of(*of, "jacobian")
    assert (made.sparsity or {})["jacobian"].columns[-1] == "time_step" == given.columns[-1]
    assert worst(made, plain, values) < EXACTLY


@pytest.mark.long
@pytest.mark.parametrize("name", ["heavy_top", "gyrostat"])
def test_so_it_is_of_states_without_a_quaternion_and_with_wheels(name: str) -> None:
    made, plain, _, values = made_of(name, "rk4", "jacobian")
    assert worst(made, plain, values) < EXACTLY


@pytest.mark.long
@pytest.mark.parametrize("of", thinned(CASES, 4))
def test_the_column_of_a_tangent_is_the_rate_of_the_errors(of: tuple[str, str]) -> None:
    made, plain, given, values = made_of(*of, "tangent")
    here, found = at(plain, values), entries(made, values)
    ends = [
        errors(given, at(plain, moved(given, values, "time_step", side * SMALL)), here)
        for side in (1, -1)
    ]
    for row, forth, back in zip((made.sparsity or {})["jacobian"].rows, *ends, strict=True):
        # a difference over 1e-12 errs by its square
        slope = (forth - back) / (2 * SMALL)
        assert abs(found.get((row, "time_step"), 0) - slope) < mpf(10) ** -18, row


@pytest.mark.long
@pytest.mark.parametrize("method", KINDS)
def test_mutants_of_the_column_are_found(method: str) -> None:
    made, plain, given, values = made_of("principal", method, "jacobian")
    without = step(replace(given, column=False), f"step_{method}_jacobian")
    known = {(op.operator, op.operands) for op in without.ops if isinstance(op, Op)}
    own = [
        (place, op)
        for place, op in enumerate(made.ops)
        if isinstance(op, Op) and op.operator in ("add", "sub") and place > len(known) // 2
    ]
    for place, op in own[-120::17]:
        flipped = replace(op, operator="sub" if op.operator == "add" else "add")
        ops = (*made.ops[:place], flipped, *made.ops[place + 1 :])
        assert worst(replace(made, ops=ops), plain, values) > mpf(10) ** -9, op


@pytest.mark.parametrize("method", KINDS)
def test_other_columns_and_the_state_are_what_they_are_without_it(method: str) -> None:
    made, _, given, values = made_of("principal", method, "jacobian")
    plain = step(replace(given, column=False), f"step_{method}_jacobian")
    with_it, without = entries(made, values), entries(plain, values)
    assert {place for place in with_it if place[1] == "time_step"} == with_it.keys() - without
    assert max(abs(with_it[place] - without[place]) for place in without) < EXACTLY


@pytest.mark.long
def test_the_column_costs_a_principal_body_at_most_276_operations() -> None:
    for method in KINDS:
        made, _, given, _ = made_of("principal", method, "jacobian")
        plain = step(replace(given, column=False), f"step_{method}_jacobian")
        assert made.flops() - plain.flops() <= 276


@pytest.mark.long
@pytest.mark.parametrize("length", [0.0, 0.05])
def test_casadi_differentiates_the_step_to_the_same_column(length: float, tmp_path: Path) -> None:
    module = imported("minimum_time_casadi", casadi_file(trial()), tmp_path)
    plain, made = module.step_rk4_unit(), module.step_rk4_unit_jacobian()
    dice = np.random.default_rng(1)
    values = {n: dice.uniform(0.5, 1.5, plain.size_in(n)) for n in plain.name_in()}
    values["parameters"], values["time_step"] = np.array([1.4, 1.6, 1.8]), np.array([[length]])
    given = {n: ca.MX.sym(n, *plain.size_in(n)) for n in plain.name_in()}
    found = plain(**given)
    after = ca.vertcat(*(found[n] for n in plain.name_out()))
    theirs = ca.Function(
        "slope", list(given.values()), [ca.jacobian(after, given["time_step"])]
    ).call([values[n] for n in given])[0]
    ours = made(**values)["jacobian"][:, -1]
    assert float(ca.norm_inf(ours - theirs)) <= ROUNDED * float(ca.norm_inf(theirs))


@pytest.mark.parametrize("name", ["step_rk4_unit_jacobian", "step_rk4_unit_tangent"])
def test_differences_in_five_hundred_bits_agree(name: str) -> None:
    (sample, *_) = (s for s in drawn(trial()) if s.kind == "ordinary")
    found = list(slopes(trial(), trial()[name], sample.values))
    assert {one.column for one in found} >= {"time_step", "omega_x", "moment_z"}
    assert max(one.gap for one in found) < GAP


@pytest.mark.long
def test_a_machine_has_the_column_too() -> None:
    text = (CATALOGUE / "acrobot.toml").read_text(encoding="utf-8")
    start, end = text.index("wanted"), text.index("]", text.index("wanted")) + 1
    text = f'{text[:start]}wanted = ["step_rk4_jacobian"]{text[end:]}'
    text = text.replace("[motion]", '[motion]\ncolumn = "time_step"')
    made = library(parse_scene(text, "acrobot"))
    (sample, *_) = (s for s in drawn(made) if s.kind == "ordinary")
    found = list(slopes(made, made["step_rk4_jacobian"], sample.values))
    assert max(one.gap for one in found) < GAP
    assert any(one.column == "time_step" and one.found for one in found)


def test_a_column_that_nothing_wanted_has_is_told() -> None:
    text = TRIAL.read_text(encoding="utf-8").replace(
        'wanted = ["step_rk4_unit", "step_rk4_unit_jacobian", "step_rk4_unit_tangent"]',
        'wanted = ["step_rk4", "step_rk4_sensitivity"]',
    )
    says = "motion.column is given, but nothing that is wanted takes it"
    assert says in parse_scene(text, "idle").warnings
