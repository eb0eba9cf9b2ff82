"""A machine told along other axes gives the answers of the machine, and wrong code does not."""

from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from derive.check.description import CYCLE, TURN, Description
from derive.check.turned import turned_axes
from derive.library.library import Library, library
from derive.program.precision import F64
from derive.scene import load, parse_scene
from derive.verify.sample import samples
from tests.check.mutants import first_sign_flipped
from tests.check.replayed import Replayed
from tests.made import library_of, scene_of, thinned

LONG_FORM = Path(__file__).parents[1] / "data" / "long_form"
BODIES = sorted(path.stem for path in LONG_FORM.glob("*.toml"))
SCENES = ("edge_runner_flat", "skewed_disc", "free_body_principal")
"""`derive check` turns all of the catalogue."""


def outcomes(made: Library, emitted: Library) -> dict[tuple[str, str], str]:
    one = cast("Any", Replayed(made, emitted))
    found = turned_axes(one, samples(made.mechanism, F64, 3, 0).each, {})
    return {(row.check, row.function): row.outcome for row in found}


@pytest.mark.long
@pytest.mark.parametrize("name", SCENES)
def test_a_scene_of_the_catalogue_is_the_same_along_other_axes(name: str) -> None:
    found = outcomes(library_of(name), library_of(name))
    assert set(found.values()) <= {"holds", "skipped"}
    assert {check for check, _ in found} == {"cyclic relabelling", "rotation of axes"}


@pytest.mark.parametrize("name", thinned(BODIES, len(BODIES)))
def test_a_body_in_long_form_is_the_same_along_other_axes(name: str) -> None:
    made = library(load(LONG_FORM / f"{name}.toml"))
    assert "FAILS" not in outcomes(made, made).values()


HELD = Path(__file__).parents[1] / "mechanics" / "scenes"
BLADE = """
wanted = ["accelerations"]
parameters.m = { unit = "kg", range = [1, 2] }
parameters.a = { unit = "m", range = [0.1, 0.3] }
speeds.u = { unit = "m/s", range = [-1, 1] }
speeds.v = { unit = "m/s", range = [-1, 1] }
speeds.w = { unit = "rad/s", range = [-1, 1] }
frames.sled = { angular_velocity = ["0", "0", "w"], velocity = ["u", "v", "0"] }

[constraints.blade]
on    = "sled"
at    = ["a", "0", "0"]
along = "sled"
axes  = ["y"]
equal = "velocities"

[bodies.sled]
frame  = "sled"
kind   = "principal"
mass   = "m"
moments = [1, 1.5, 2]

[loads]
ice = { on = "sled", force = ["0", "0", "?N"], couple = ["?c_x", "?c_y", "0"] }
wind = { on = "sled", force = [1, 2, 0] }
"""


@pytest.mark.long
@pytest.mark.parametrize("along", ["inertial", "bar"])
def test_points_that_meet_meet_along_other_axes(along: str) -> None:
    text = (HELD / "four_bar_closed.toml").read_text(encoding="utf-8")
    text = text.replace("[constraints.d]", f'[constraints.d]\nalong = "{along}"')
    made = library(parse_scene(text.replace('"energy", ', ""), "four"))
    found = outcomes(made, made)
    assert found["cyclic relabelling", "accelerations"] == "holds"
    assert found["cyclic relabelling", "d_x"] == "holds"


def test_a_blade_runs_along_other_axes() -> None:
    made = library(parse_scene(BLADE, "blade"))
    assert {check: row for (check, _), row in outcomes(made, made).items()} == {
        "cyclic relabelling": "holds", "rotation of axes": "holds"}  # fmt: skip


GIVEN = """
wanted = ["moment"]
body = { kind = "principal", moments = [1, 1.5, 2] }
speeds.w = { unit = "rad/s", range = [1, 2], rate = { range = [-1, 1] } }
known.angular_velocity = [1, "w", 0]
"""


def test_what_is_denormal_is_lost_in_no_sum_along_other_axes() -> None:
    made = library(parse_scene(GIVEN, "given"))
    one = cast("Any", Replayed(made, made))
    each = samples(made.mechanism, F64, 1, 2).each
    assert "denormal" in {s.kind for s in each}
    assert {row.outcome for row in turned_axes(one, each, {})} == {"holds"}


def test_a_flipped_sign_is_seen_along_other_axes() -> None:
    made = library(load(LONG_FORM / "free_body_principal.toml"))
    wrong = replace(made, functions=tuple(map(first_sign_flipped, made.functions[:1])))
    found = outcomes(replace(made, functions=made.functions[:1]), wrong)
    assert set(found.values()) == {"FAILS"}
    assert len(found) == 2


@pytest.mark.parametrize("turn", [CYCLE, TURN])
def test_the_rows_of_a_turn_are_orthonormal_and_right_handed(turn: Any) -> None:
    rows = np.array(Description(scene_of("skewed_disc"), turn, frozenset()).rows)
    assert (rows @ rows.T == np.eye(3)).all()
    assert (np.cross(rows[0], rows[1]) == rows[2]).all()
