"""Machines move in time as single bodies do, by steps that need only the rate of a state."""

from functools import cache
from math import fsum
from pathlib import Path

import numpy as np
import pytest

from derive.check.motion import orders_hold, step_slopes_hold
from derive.cli import main
from derive.library.library import Library, library
from derive.program.arithmetic import working
from derive.program.precision import F32, F64, Precision
from derive.program.program import component_names
from derive.scene import CATALOGUE, SceneError, parse_scene
from derive.scene.wanted import OF_MACHINES
from derive.verify.draw import Dice, Sampled, complete, with_motion
from derive.verify.draw import drawn as drawn_in_columns
from derive.verify.measure import replayed
from derive.verify.sample import Sample, samples

TWO_HUBS = """
title  = "Two satellites on a tether that damps"
wanted = [{wanted}]
emission = "{emission}"

[parameters]
J = {{ unit = "kg m^2", range = [1, 2], meaning = "moment across" }}
C = {{ unit = "kg m^2", range = [1.5, 1.9], meaning = "moment along z" }}
k = {{ unit = "N m s", range = [2, 4], meaning = "how the tether damps the spin about x" }}

[speeds]
a_x = {{ unit = "rad/s", range = [-1, 1] }}
a_y = {{ unit = "rad/s", range = [-1, 1] }}
a_z = {{ unit = "rad/s", range = [-1, 1] }}
b_x = {{ unit = "rad/s", range = [-1, 1] }}
b_y = {{ unit = "rad/s", range = [-1, 1] }}
b_z = {{ unit = "rad/s", range = [-1, 1] }}

[frames.hub]
angular_velocity = ["a_x", "a_y", "a_z"]
attitude = "quaternion"

[frames.pod]
angular_velocity = ["b_x", "b_y", "b_z"]
attitude = "quaternion"

[bodies.hub]
frame = "hub"
kind  = "axisymmetric"
axis  = "z"
axial = "C"
transverse = "J"

[bodies.pod]
frame = "pod"
kind  = "principal"
moments = ["J", "C", "J"]

[loads]
tether = {{ on = "hub", against = "pod", couple = ["-k*(a_x - b_x)", "0", "0"], along = "hub" }}
"""
FEW = ("--samples", "256")
STEPS = [n for n in OF_MACHINES if not ("tangent" in n or "unit" in n or n == "step_taylor")]
ON_SPHERE = 4.0
"""Length of a quaternion after a step, in u from 1: one normalisation and its roundings."""


def two_hubs(*wanted: str, emission: str = "fast") -> Library:
    names = ", ".join(f'"{name}"' for name in wanted)
    text = TWO_HUBS.format(wanted=names, emission=emission)
    return library(parse_scene(text, "two_hubs"))


@pytest.mark.long
def test_samples_have_every_quaternion_of_length_one_and_at_half_a_turn() -> None:
    made = two_hubs("step_rk4")
    of = Sampled(made, F64)
    at = complete(of, drawn_in_columns(of, Dice("two hubs"), 64)).wide
    (turned,) = (s.values for s in samples(made.mechanism, F64, 0, 1).each if s.kind == "half turn")
    for frame in ("hub", "pod"):
        parts = [f"attitude_{frame}_{part}" for part in "wxyz"]
        assert np.allclose(sum(at[part] ** 2 for part in parts), 1, rtol=0, atol=1e-15)
        assert [turned[part] for part in parts] == [0, 1, 0, 0]


@cache
def top() -> Library:
    text = (CATALOGUE / "sleeping_top.toml").read_text(encoding="utf-8")
    old = '["linearised", "accelerations", "step_rk4", "energy"]'
    assert old in text
    names = ", ".join(f'"{name}"' for name in STEPS)
    return library(parse_scene(text.replace(old, f"[{names}]"), "sleeping_top"))


def drawn(made: Library, precision: Precision, count: int) -> tuple[Sample, ...]:
    return with_motion(made, samples(made.mechanism, precision, count, 0).each, precision)


@pytest.mark.long
@pytest.mark.whole
@pytest.mark.parametrize("of", ["top", "two hubs"])
def test_steps_of_machines_have_their_orders_and_their_slopes(of: str) -> None:
    hubs = ("step_rk4", "step_rk4_jacobian", "step_taylor12")
    made = top() if of == "top" else two_hubs(*hubs)
    verdicts = [
        check for one in (orders_hold, step_slopes_hold) for check in one(made, drawn(made, F64, 1))
    ]
    assert {v.function for v in verdicts} >= {"step_rk4", "step_rk4_jacobian", "step_taylor12"}
    assert [v for v in verdicts if v.outcome != "holds"] == []


OTHERS = (("step_rk4", F64), ("step_rk4_compensated", F32), ("step_rk4_compensated", F64))


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "precision"),
    [("step_rk4", F32), *(pytest.param(*row, marks=pytest.mark.long) for row in OTHERS)],
)
def test_a_step_brings_every_quaternion_back_to_length_one(name: str, precision: Precision) -> None:
    made = two_hubs(name)
    each = drawn(made, precision, 8)
    columns = replayed(made, each, precision, working(precision.dtype))[name]
    found = dict(zip(component_names(made[name]), columns, strict=True))
    u = 2.0**-24 if precision is F32 else 2.0**-53
    for frame in ("hub", "pod"):
        for n in range(len(each)):
            parts = [float(found[f"attitude_{frame}_{part}_next"][n]) for part in "wxyz"]
            assert abs(fsum(x * x for x in parts) - 1) <= 2 * ON_SPHERE * u


@pytest.mark.long
@pytest.mark.parametrize(
    ("wanted", "emission", "says"),
    [
        pytest.param(
            "step_rk4_tangent",
            "fast",
            "is over the errors of one quaternion, and the state has 2",
            marks=pytest.mark.long,
        ),
        ("step_rk4_unit", "fast", "keeps the length of one quaternion, and the state has 2"),
        ("step_rk4", "compact", "is for one quaternion at most, and the state has 2"),
    ],
)
def test_a_step_of_one_quaternion_is_refused_to_two(wanted: str, emission: str, says: str) -> None:
    with pytest.raises(SceneError, match=says):
        two_hubs(wanted, emission=emission)


def test_a_machine_is_not_moved_by_what_needs_a_single_free_body() -> None:
    with pytest.raises(SceneError, match="wanted has 'flow_exact', which is no answer"):
        two_hubs("flow_exact")


def test_a_step_is_no_answer_beside_others() -> None:
    with pytest.raises(SceneError, match="wanted has 'step_rk4' within 'both', but a step stands"):
        two_hubs("both: accelerations, step_rk4")


@pytest.mark.long
def test_a_machine_may_want_steps_and_nothing_else(tmp_path: Path) -> None:
    names = TWO_HUBS.format(wanted='"step_rk4"', emission="fast")
    scene = tmp_path / "two_hubs.toml"
    scene.write_text(names, encoding="utf-8")
    assert main(["generate", *FEW, str(scene), "--out", str(tmp_path / "out")]) == 0
    assert (tmp_path / "out" / "two_hubs" / "two_hubs_f64.c").is_file()
