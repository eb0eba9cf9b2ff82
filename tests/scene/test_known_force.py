"""Known forces, moments and inputs as formulas, beside a cloud of particles that feels them."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from flint import arb, ctx
from mpmath import mp, mpf

from derive.check.particles import digits
from derive.emit.c.source import c_files
from derive.library.library import Library, library
from derive.program.precision import PRECISIONS
from derive.program.program import Quantity, component_names
from derive.program.run import run
from derive.scene import parse_scene
from derive.verify.cloud import answers
from derive.verify.convergence import unit_attitude
from derive.verify.equations import equations_of
from derive.verify.operators import LONG_FLOATS
from derive.verify.reference import BITS, reference
from derive.verify.sample import samples

if TYPE_CHECKING:
    from collections.abc import Mapping

DATA = Path(__file__).parents[1] / "data"
DOCS = (Path(__file__).parents[2] / "docs" / "scenes.md").read_text(encoding="utf-8")
ROCKET = next(t for t in re.findall(r"```toml\n(.*?)```", DOCS, re.DOTALL) if "Rocket" in t)
INPUT_IN_A_MOMENT = """
wanted = ["step_rk4"]
inputs = { u = { unit = "N m", range = [-1, 1] } }
body   = { kind = "principal", moments = [1, 2, 2.5] }
known  = { moment = ["u", "-u/4", "0"] }
"""
AGREE = mpf(10) ** -25  # the cloud has so many digits


def body(text: str, wanted: str) -> Library:
    """Return the programs of a scene of one body that wants one function."""
    return library(replace(parse_scene(text, "example"), wanted=(wanted,)))


def rocket_by_particles(values: Mapping[str, Any]) -> list[Any]:
    """Return velocity_rate and omega_dot of the rocket, from its cloud of particles."""
    machine = parse_scene((DATA / "rocket_machine.toml").read_text(), "rocket_machine")
    named = {f"attitude_hull_{p}": f"attitude_{p}" for p in "wxyz"}
    named |= {f"w_{p}": f"omega_{p}" for p in "xyz"}
    named |= {p.upper(): f"position_{p}" for p in "xyz"}
    named |= {f"{p.upper()}_dot": f"velocity_{p}" for p in "xyz"}
    with mp.workdps(60):
        given = {name: digits(x) for name, x in values.items()}
        found = answers(machine, given | {new: given[old] for new, old in named.items()}).unknowns
    return [*(found[f"{p}_ddot"] for p in "XYZ"), *(found[f"w_{p}_dot"] for p in "xyz")]


@pytest.mark.long
def test_a_force_of_state_and_inputs_moves_the_body_as_it_moves_its_particles() -> None:
    made = body(ROCKET, "state_rate")
    equations = equations_of(made.mechanism, made.problems["state_rate"])
    names = [f"{name}_{p}" for name in ("velocity_rate", "omega_dot") for p in "xyz"]
    for sample in samples(made.mechanism, PRECISIONS[1], 3, 0).each:
        with ctx.workprec(BITS):
            values = unit_attitude(made, {c: arb(x) for c, x in sample.values.items()})
        true = reference(equations, values, ())
        with mp.workdps(60):
            pairs = zip(names, rocket_by_particles(values), strict=True)
            assert all(abs(digits(true[n].value) - x) < AGREE * (1 + abs(x)) for n, x in pairs)


@pytest.mark.long
def test_a_step_and_its_taylor_series_feel_the_force() -> None:
    for wanted in ("step_rk4", "step_taylor12"):
        made = body((DATA / "trials" / "force_by_attitude.toml").read_text(), wanted)
        at_rest = dict.fromkeys(("attitude_x", "attitude_y", "attitude_z"), arb(0))
        given = {c: arb(0) for q in made[wanted].inputs for c in q.components}
        given |= {"attitude_w": arb(1), "time_step": arb("0.5"), "m": arb(1), "I": arb("0.005")}
        with ctx.workprec(BITS):
            given |= at_rest
            constants = run(made.setup, LONG_FLOATS, [given[c] for c in inputs(made.setup)])
            given |= dict(zip(component_names(made.setup), constants, strict=True))
            results = run(made[wanted], LONG_FLOATS, [given[c] for c in inputs(made[wanted])])
            found = dict(zip(component_names(made[wanted]), results, strict=True))
            assert abs(found["velocity_z_next"] + arb("4.905")) < 1e-30
            assert abs(found["position_z_next"] + arb("1.22625")) < 1e-30


def inputs(program: Any) -> list[str]:
    """Return the components of a program's inputs."""
    return [c for q in program.inputs for c in q.components]


@pytest.mark.parametrize("name", ["force_by_attitude", "force_by_parameters"])
def test_what_formulas_give_is_no_argument(name: str) -> None:
    made = body((DATA / "trials" / f"{name}.toml").read_text(), "state_rate")
    every = (*made.vocabulary.states, *made.vocabulary.inputs)
    assert {"force", "moment"} & {q.name for q in every} == set()
    assert "force" not in inputs(made["state_rate"])


@pytest.mark.long
def test_an_input_is_a_column_of_the_jacobian_and_held_during_a_step() -> None:
    made = body(ROCKET, "state_rate_jacobian")
    pattern = (made["state_rate_jacobian"].sparsity or {})["jacobian"]
    assert pattern.columns[-2:] == ("thrust", "tilt")
    made = body(INPUT_IN_A_MOMENT, "step_rk4")
    assert inputs(made["step_rk4"]).count("u") == 1


def test_a_quantity_with_an_empty_range_cannot_be_made() -> None:
    with pytest.raises(ValueError, match="'force' ranges over 0 to 0 only"):
        Quantity("force", ("force",), (), "N", "", Fraction(0), Fraction(0), "")


def test_a_quantity_without_a_range_is_not_sampled() -> None:
    with pytest.raises(ValueError, match="'force' has no range to draw samples from"):
        Quantity("force", ("force",), (), "N", "", None, None, "").ends  # noqa: B018


def test_the_header_says_which_forces_act_and_along_which_axes() -> None:
    header = c_files(library(parse_scene(INPUT_IN_A_MOMENT, "turned")), ())["turned_f64.h"]
    assert " * The external moment is (u, -u/4, 0) along xyz.\n" in header
    assert " * The axes xyz are fixed in the body.\n" in header
    assert " *\n *\n" not in header
