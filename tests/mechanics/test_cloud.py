"""Machines agree with particles of which only positions are known."""

from dataclasses import replace
from pathlib import Path

import pytest

from derive.check.particles import clouds
from derive.library.library import library
from derive.mechanics.mechanism import mechanism
from derive.program.precision import F64
from derive.scene import Scene, load, parse_scene
from derive.scene.formula import Formula
from derive.solve.instrument import opened
from derive.solve.motions import roots
from derive.verify.cloud import answers
from derive.verify.equations import equations_of
from derive.verify.reference import reference
from derive.verify.sample import samples
from tests.made import library_of, thinned

FEW = 3
ON_ONE_AXIS = Path(__file__).parent / "scenes" / "on_one_axis.toml"
MACHINES = ("edge_runner_flat", "eulers_disk", "skewed_disc")
"""`derive check` tries all of the catalogue."""


@pytest.mark.parametrize("name", MACHINES)
def test_every_answer_of_a_machine_agrees_with_its_cloud(name: str) -> None:
    made = library_of(name)
    verdicts = list(clouds(made, samples(made.mechanism, F64, FEW, 0).each))
    assert [v for v in verdicts if v.outcome != "holds"] == []
    assert {v.function for v in verdicts} == set(made.problems)


def test_accelerations_that_are_zero_are_and_those_that_should_not_be_are_noticed() -> None:
    """Where no term is left, what the cloud leaves of zero by rounding is no difference."""
    text = ON_ONE_AXIS.read_text(encoding="utf-8")
    made = library(parse_scene(text, "on_one_axis"))
    each = samples(made.mechanism, F64, FEW, 0).each
    assert [v.outcome for v in clouds(made, each)] == ["holds"]
    lying = parse_scene(text.replace('gravity = [0, 0, "-g"]', 'gravity = ["-g", 0, 0]'), "lying")
    spoilt = replace(made, mechanism=replace(made.mechanism, scene=lying))
    assert [v.outcome for v in clouds(spoilt, each)] == ["FAILS"]


# Programs of one machine beside the cloud of another: a machine, an edit of it, what it spoils.
UNLIKE = (
    ("eulers_disk", 'at = ["0", "-r", "0"]', 'at = ["0", "-0.99*r", "0"]', "steady"),
    ("top_steady_precession", '["0", "0", "l"]', '["0", "0", "1.01*l"]', "steady"),
    ("rolling_cone", '- h/cos(a)', '- h', "steady"),
    ("gyrocompass", "2*pi*sqrt", "2*sqrt", "period_s"),
    ("sleeping_top", '["0", "0", "l"]', '["0", "0", "1.01*l"]', "state_rate"),
)  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("row", thinned(UNLIKE, 2), ids=[row[0] for row in UNLIKE])
def test_another_machine_does_not_agree_with_the_cloud(
    row: tuple[str, str, str, str],
) -> None:
    name, old, new, function = row
    right = load(name)
    assert old in right.text
    other = parse_scene(right.text.replace(old, new), name)
    made = library(other)
    spoilt = replace(made, mechanism=replace(made.mechanism, scene=right))
    each = samples(made.mechanism, F64, 1, 0).each
    outcomes = {v.function: v.outcome for v in clouds(spoilt, each)}
    assert outcomes[function] == "FAILS"


STEADY = ("top_steady_precession", "eulers_disk")


@pytest.mark.parametrize("name", STEADY)
def test_at_a_root_and_nowhere_near_it_the_cloud_is_in_balance(name: str) -> None:
    found = opened(name)
    middle = {c: float(((q.low or 0) + (q.high or 0)) / 2) for q in found.quantities()
              for c in q.components}  # fmt: skip
    machine = load(name)
    every = roots(found, {n: v for n, v in middle.items() if n != "W"})
    assert every
    for root in every:
        near, off = dict(root), {"W": root["W"] * 1.01}
        assert answers(machine, middle | near).contradiction < 1e-12
        assert answers(machine, middle | off).contradiction > 1e-6


# What textbooks and programmers leave out: an edit, and the answer that it spoils.
TWO_BLADES = Path(__file__).parent / "scenes" / "two_blade.toml"
DISC = 'shape  = "disc"\naxis   = "z"\nmass   = "m"\nradius = "r"'
NO_A = 'kind = "axisymmetric"\naxis = "z"\nmass = "m"\naxial = "m*r^2/2"\ntransverse = 0'
SHORTCUTS = (
    ("the gyroscopic term is dropped", "edge_runner_flat", 'spin   = "-W*L/r"', "", "N"),
    ("two blades are a disc", TWO_BLADES, 'number = 2\naxis = "x"\nmass = "m"',
     'number = 3\naxis = "x"\nmass = "2/3*m"', "M"),
    ("C for C - A", "skewed_disc", DISC, NO_A, "M"),
    ("the spin is the other way", "disc_two_bearings", 'spin   = "w"', 'spin = "-w"', "couple"),
)  # fmt: skip


@pytest.mark.parametrize("row", SHORTCUTS, ids=[row[0] for row in SHORTCUTS])
def test_a_usual_shortcut_gives_another_answer_than_the_cloud(
    row: tuple[str, str | Path, str, str, str],
) -> None:
    _, source, old, new, function = row
    right = load(source)
    assert old in right.text
    wrong = library(parse_scene(right.text.replace(old, new), right.name))
    (sample,) = samples(mechanism(right), F64, 1, 0).each
    problem = wrong.problems[function]
    false = reference(equations_of(wrong.mechanism, problem), sample.values, ())
    names = [c for q in problem.outputs for c in q.components]
    cloud = answers(right, sample.values)
    true = [
        float(cloud.unknowns[n] if n in cloud.unknowns else cloud.result(_formula(right, n)))
        for n in names
    ]
    gaps = [abs(float(false[n].value) - t) for n, t in zip(names, true, strict=True)]
    assert max(gaps) > 1e-3 * max(map(abs, true))


def _formula(machine: Scene, name: str) -> Formula:
    return next(r.formula for r in machine.results if r.name == name)


def test_the_slow_rate_of_a_top_is_not_mgl_over_C_n() -> None:
    machine = load("top_steady_precession")
    values = {"m": 0.5, "r": 0.05, "l": 0.06, "theta": 0.5, "n": 250.0, "g": 9.81, "psi": 0.0}
    C = values["m"] * values["r"] ** 2 / 2
    shortcut = values["m"] * values["g"] * values["l"] / (C * values["n"])
    found = opened("top_steady_precession")
    slow = roots(found, values)[0]["W"]
    assert abs(slow / shortcut - 1) > 1e-3
    assert answers(machine, values | {"W": slow}).contradiction < 1e-12
    assert answers(machine, values | {"W": shortcut}).contradiction > 1e-6
