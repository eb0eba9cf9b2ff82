"""Set-up tells parameters that no body has from others, by the same number in every language."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from random import Random

import casadi
import numpy as np
import pytest

from derive.check.admission import extremes_of, fault, hostile, replayed_statuses
from derive.check.compiler import find_compiler
from derive.check.emitted import Files, loaded
from derive.check.refusals import casadi_status, refuses_alike
from derive.cli import main
from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.library.library import Library, library
from derive.program.arithmetic import extended, paired
from derive.program.precision import F32, F64, PRECISIONS, Precision
from derive.program.program import Program
from derive.program.run import run
from derive.program.status import INERTIA, LENGTH, MASS, PARAMETER, RIGHT, possible
from derive.program.status import refusal as why
from derive.scene import catalogue, load, parse_scene
from tests.check.mutants import printed
from tests.made import library_of, thinned

DRAWS = 120
SKEWED_ROD = """
wanted = ["kinetic_energy"]
[parameters]
J = { unit = "kg m^2", range = [1, 2] }
I_xy = { unit = "kg m^2", range = [-1, 1] }
[speeds]
p = { unit = "rad/s", range = [1, 9], rate = 0 }
q = { unit = "rad/s", range = [1, 9], rate = 0 }
[frames]
rod.angular_velocity = ["p", "q", "0"]
[bodies.rod]
frame = "rod"
kind = "general"
mass = 1
moments = ["J", "J", "2*J"]
products = ["I_xy", 0, 0]
"""


@cache
def made(name: str) -> Library:
    return library(load(name))


WITH_SET_UP = [name for name in catalogue() if name != "attitude"]


def names(setup: Program) -> list[str]:
    return [c for q in setup.inputs for c in q.components]


def drawn(lib: Library, precision: Precision) -> list[dict[str, float]]:
    return hostile(lib.setup, precision, DRAWS, Random(lib.scene.name))


def faults(lib: Library, setup: Program, precision: Precision) -> list[str]:
    """Return what is wrong with the statuses of a set-up, and check that they are not all alike."""
    each = drawn(lib, precision)
    found = replayed_statuses(setup, each, precision)
    columns = np.array([[v[n] for v in each] for n in names(setup)], precision.dtype)
    with np.errstate(all="ignore"):
        results = run(setup, extended(precision.dtype), paired(columns))
    finite = np.all([np.isfinite(np.broadcast_to(r[0], len(each))) for r in results], axis=0)
    return [
        f"{says} at {values}"
        for values, status, ok in zip(each, found, finite, strict=True)
        if (says := fault(lib.scene, values, precision, status,
                          extremes_of(values, precision, finite=bool(ok))))
    ]  # fmt: skip


@pytest.mark.long
@pytest.mark.whole
@pytest.mark.parametrize("name", thinned(reversed(WITH_SET_UP), 12))
def test_a_set_up_refuses_what_the_declaration_refuses_and_nothing_else(name: str) -> None:
    lib = made(name)
    for precision in PRECISIONS:
        assert faults(lib, lib.setup, precision) == []
        found = set(replayed_statuses(lib.setup, drawn(lib, precision), precision))
        assert {RIGHT, PARAMETER} < found <= set(possible(lib.setup))


RULED = ("edge_runner_flat", "rigid_body_steps", "heavy_top", "gyrostat")


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(RULED, 2))
def test_a_set_up_without_one_of_its_rules_is_caught(name: str) -> None:
    lib = made(name)
    assert lib.setup.rules
    for left_out in lib.setup.rules:
        rules = tuple(rule for rule in lib.setup.rules if rule is not left_out)
        assert faults(lib, replace(lib.setup, rules=rules), F64) != []


@pytest.mark.long
def test_a_rule_that_lets_zero_pass_is_caught() -> None:
    lib = made("rigid_body_steps")
    lax = tuple(replace(rule, relation="not negative") for rule in lib.setup.rules)
    assert faults(lib, replace(lib.setup, rules=lax), F64) != []


def test_a_rule_that_refuses_too_much_is_caught() -> None:
    lib = made("chandler_rigid_earth")
    strict = tuple(replace(rule, value="A", relation="positive") for rule in lib.setup.rules)
    shifted = replace(lib.setup, rules=(*strict, replace(strict[0], value=lib.setup.results[0])))
    assert faults(lib, shifted, F64) != []


@pytest.mark.long
@pytest.mark.parametrize(
    ("values", "status"),
    [
        ((0, 1, 1, 1, 0, 0, 0), MASS),
        ((-5, 1, 1, 1, 0, 0, 0), MASS),
        ((1, 1, 1, 100, 0, 0, 0), RIGHT),  # a broken triangle inequality is a warning
        ((1, 1, 1, -1, 0, 0, 0), INERTIA),
        ((1, 1, 1, 1, 1, 0, 0), INERTIA),
        ((1, 1, 1, 1, 0, float("nan"), 0), PARAMETER),
        ((1e300, 1e-3, 1e3, 1e3, 0, 0, 0), RIGHT),  # far outside the ranges, and a body
    ],
)
def test_a_status_names_the_rule(values: Sequence[float], status: int) -> None:
    setup = made("rigid_body_steps").setup
    given = dict(zip(names(setup), map(float, values), strict=True))
    assert replayed_statuses(setup, [given], F64) == [status]


@pytest.mark.long
@pytest.mark.parametrize(("precision", "condition"), [(F64, 1e12), (F32, 1e6)])
def test_no_definite_tensor_is_refused_for_being_close_to_singular(
    precision: Precision, condition: float
) -> None:
    setup, dice = made("free_body").setup, np.random.default_rng(9)
    each: list[Mapping[str, float]] = []
    for _ in range(200):
        turn, _ = np.linalg.qr(dice.normal(size=(3, 3)))
        small = [1, dice.choice([1, 1 / condition]), 1 / condition]
        own = (turn * small) @ turn.T
        # Rounding the entries may take the tensor out of the definite ones: raise it by that.
        own = own + np.eye(3) * (0 if precision is F64 and condition < 1e13 else 1 / condition)
        keys = {"I_xx": own[0, 0], "I_yy": own[1, 1], "I_zz": own[2, 2],
                "I_xy": -own[0, 1], "I_xz": -own[0, 2], "I_yz": -own[1, 2]}  # fmt: skip
        each.append({k: float(precision.dtype(x)) for k, x in keys.items()})
    scene = made("free_body").scene
    found = replayed_statuses(setup, each, precision)
    assert found.count(RIGHT) > 190
    wrong = [fault(scene, v, precision, s, extremes_of(v, precision, finite=True))
             for v, s in zip(each, found, strict=True)]  # fmt: skip
    assert [w for w in wrong if w] == []


def test_a_rod_in_axes_of_its_own_is_taken_and_what_is_less_than_a_rod_is_not() -> None:
    lib = library(parse_scene(SKEWED_ROD, "rod"))
    given = {"J": 1.0, "I_xy": 1.0}
    for precision in PRECISIONS:
        rows = [given, {"J": 0.1, "I_xy": 0.1}, {"J": 0.0, "I_xy": 0.0}, {"J": 1.0, "I_xy": 1.01}]
        held = [{n: float(precision.dtype(r[n])) for n in names(lib.setup)} for r in rows]
        assert replayed_statuses(lib.setup, held, precision) == [RIGHT, RIGHT, RIGHT, INERTIA]


@pytest.mark.parametrize("name", thinned(["edge_runner_flat", "rigid_body_steps"], 2))
def test_c_and_casadi_give_the_status_of_the_program(name: str, tmp_path: Path) -> None:
    lib = made(name)
    found = Files(printed(lib), "made in memory")
    for one in loaded(lib, found, tmp_path, find_compiler()):
        row = refuses_alike(one, ())
        assert (row.outcome, row.check) == ("holds", "refuses what is no body"), row.says
        if one.precision is F64:
            module = imported(f"{name}_casadi", casadi_file(lib), tmp_path)
            assert casadi_status(one, module).outcome == "holds"
            vars(module)["setup_status"] = lambda: lambda _: casadi.DM(0)
            assert casadi_status(one, module).outcome == "FAILS"


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(WITH_SET_UP, 4))
def test_casadi_gives_the_status_of_the_program(name: str, tmp_path: Path) -> None:
    lib = made(name)
    module = imported(f"{name}_casadi", casadi_file(lib), tmp_path)
    each = drawn(lib, F64)
    given = casadi.DM([[v[n] for v in each] for n in names(lib.setup)])
    status = module.setup_status()(given).full().ravel()
    assert status.tolist() == replayed_statuses(lib.setup, each, F64)
    constants = module.setup()(given).full()
    assert np.all(np.isnan(constants[:, status != RIGHT]))


def test_derive_solve_says_the_rule_and_warns_of_what_only_warns(
    capsys: pytest.CaptureFixture[str],
) -> None:
    given = ["r=0.6", "width=0.3", "L=0.9", "W=3.2", "g=9.81"]
    assert main(["solve", "edge_runner_flat", "--set", "m=-5", *given]) == 2
    assert "body 'roller'.mass must be positive, and is not so at m = -5" in capsys.readouterr().err
    flat = ["I_xx=1", "I_yy=1", "I_zz=100", "omega_x=1", "omega_y=1", "omega_z=1"]
    moment = ["moment_x=0", "moment_y=0", "moment_z=0"]
    rates = ["omega_dot_x=0", "omega_dot_y=0", "omega_dot_z=0"]
    assert main(["solve", "free_body_principal", "--set", *flat, *moment, *rates]) == 0
    told = " ".join(capsys.readouterr().err.split())
    assert "breaks the triangle inequality at I_xx = 1, I_yy = 1, I_zz = 100" in told


def test_a_clause_names_the_quantity_of_the_rule() -> None:
    setup = made("edge_runner_flat").setup
    assert why(setup, (1200.0, -0.6, 0.9, 9.81)).startswith("body 'roller'.radius must be positive")
    assert why(setup, (1200.0, 0.6, 0.9, 9.81)) == ""
    assert f"(status {LENGTH})" in why(setup, (1200.0, 0.0, 0.9, 9.81))


@pytest.mark.parametrize("set_", [{"m": -5.0}, {"l": -1.0}])
def test_a_parameter_that_stands_in_formulas_only_is_not_tried(set_: dict[str, float]) -> None:
    setup = made("heavy_top").setup
    middle = {q.name: float(sum(q.ends) / 2) for q in setup.inputs}
    assert why(setup, [*(middle | set_).values()]) == ""
    assert "(status 4)" in why(setup, [*(middle | {"A": -1.0}).values()])


@pytest.mark.long
def test_numbers_of_springs_are_not_tried_and_masses_beside_them_are() -> None:
    trial = Path(__file__).parents[1] / "data" / "trials" / "spring_at_rest.toml"
    setup = library_of(str(trial)).setup
    middle = {q.name: float(sum(q.ends) / 2) for q in setup.inputs}
    for name in ("k", "c"):
        assert why(setup, [*(middle | {name: -1.0}).values()]) == ""
    assert "(status 2)" in why(setup, [*(middle | {"m": -1.0}).values()])
