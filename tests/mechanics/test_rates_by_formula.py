"""A coordinate whose rate is a formula of coordinates and free speeds is a state: Kane's speeds."""

from dataclasses import replace
from pathlib import Path

import pytest

from derive.check.particles import clouds
from derive.library.library import Library, library
from derive.mechanics.mechanism import mechanism
from derive.program.precision import F64
from derive.program.program import component_names
from derive.scene import SceneError, parse_scene
from derive.verify.equations import equations_of
from derive.verify.reference import reference
from derive.verify.sample import samples
from tests.made import library_of, scene_of

ROOT = Path(__file__).parents[2]
TOP = (ROOT / "tests/data/long_form/heavy_top.toml").read_text()
SLEIGH = """
wanted = ["state_rate"]
[parameters]
m = { unit = "kg", range = [1, 2] }
a = { unit = "m", range = [0.2, 0.5] }
I = { unit = "kg m^2", range = [0.1, 0.2] }
[coordinates]
x   = { unit = "m", range = [-1, 1], rate = "v*cos(psi)" }
psi = { unit = "rad", range = [-3, 3], rate = "w" }
y   = { unit = "m", range = [-1, 1], rate = "v*sin(psi)" }
[speeds]
v = { unit = "m/s", range = [-2, 2] }
w = { unit = "rad/s", range = [-3, 3] }
[frames.edge]
turned = ["z psi"]
origin = ["x", "y", "0"]
[bodies.sleigh]
frame  = "edge"
kind   = "principal"
moments = ["I", "I", "I"]
mass   = "m"
centre = ["a", "0", "0"]
[loads.runner]
on     = "sleigh"
force  = ["0", "?side", "?up"]
couple = ["?roll", "?pitch", "0"]
"""
"""Chaplygin's: a knife edge, which cannot move across itself, at a distance from the centre."""


@pytest.fixture(scope="module", name="top")
def the_top() -> Library:
    return library(parse_scene(TOP.replace('"state_rate"', '"state_rate", "tip"'), "top"))


def refused(text: str) -> str:
    with pytest.raises(SceneError) as refusal:
        library(parse_scene(text, "top"))
    return str(refusal.value).removeprefix("scene 'top': ")


def test_what_a_formula_moves_is_a_state_and_costs_no_more_than_by_hand() -> None:
    rate = library_of("tests/data/long_form/heavy_top.toml")["state_rate"]
    assert rate.flops() <= 8
    states = ("psi", "theta", "w_x", "w_y", "n")
    assert component_names(rate) == [f"{name}_rate" for name in states]


def test_every_answer_agrees_with_the_cloud_of_particles(top: Library) -> None:
    sleigh = library(parse_scene(SLEIGH, "sleigh"))
    for made in (top, sleigh):
        verdicts = list(clouds(made, samples(made.mechanism, F64, 1, 0).each))
        assert {v.function for v in verdicts} == set(made.problems)
        assert {v.outcome for v in verdicts} == {"holds"}


def test_another_rate_does_not_agree_with_the_cloud_of_particles(top: Library) -> None:
    """Both rates are integrals of the same speeds, but the second acceleration is another."""
    text = top.scene.text.replace("w_y/sin(theta)", "w_y/sin(theta) + w_x*theta")
    other = replace(top, mechanism=replace(top.mechanism, scene=parse_scene(text, "top")))
    each = samples(top.mechanism, F64, 1, 0).each
    outcomes = {v.function: v.outcome for v in clouds(other, each)}
    assert outcomes["state_rate"] == outcomes["tip"] == "FAILS"


def test_the_top_has_the_rates_of_the_body_whose_omega_the_speeds_are() -> None:
    machine, body = (mechanism(s) for s in (parse_scene(TOP, "top"), scene_of("heavy_top")))
    (sample,) = samples(machine, F64, 1, 0).each
    omega = {f"omega_{axis}": sample.values[n] for axis, n in zip("xyz", OMEGA, strict=True)}
    values = {**sample.values, **omega, "phi": 0.3}
    ours, theirs = (
        {n: float(x.value) for n, x in
         reference(equations_of(k, k.problem("state_rate")), values, ()).items()}
        for k in (machine, body)
    )  # fmt: skip
    pairs = {"psi_rate": "psi_dot", "theta_rate": "theta_dot"}
    pairs |= {f"{n}_rate": f"omega_dot_{axis}" for axis, n in zip("xyz", OMEGA, strict=True)}
    assert {n: ours[n] for n in pairs} == pytest.approx({n: theirs[m] for n, m in pairs.items()})


OMEGA = ("w_x", "w_y", "n")


def test_a_sleigh_moves_as_chaplygin_says() -> None:
    known = mechanism(parse_scene(SLEIGH, "sleigh"))
    (sample,) = samples(known, F64, 1, 0).each
    m, a, moment, v, w = (sample.values[n] for n in ("m", "a", "I", "v", "w"))
    found = reference(equations_of(known, known.problem("state_rate")), sample.values, ())
    assert float(found["v_rate"].value) == pytest.approx(a * w**2)
    assert float(found["w_rate"].value) == pytest.approx(-m * a * v * w / (moment + m * a**2))


def test_a_comment_says_where_a_rate_has_no_value(top: Library) -> None:
    (place,) = top["state_rate"].singular
    assert (place.where, place.outputs) == ("theta = k pi", ("psi_rate", "w_x_rate", "w_y_rate"))


RATE = '"w_y/sin(theta)"'
SCOPE = "; only parameters, coordinates and speeds may stand here"
FREE = "needs coordinates that are free, but the rate of '{}' is '{}'; let it be free"
PSI, THETA = FREE.format("psi", "w_y/sin(theta)"), FREE.format("theta", "w_x")
"""Of psi, which nothing depends on, small motion needs nothing."""
REFUSED = (
    ('"w_q/sin(theta)"', "rate uses 'w_q', which the scene does not declare (did you mean 'w_y'?)"),
    ('"w_y*l"', "rate = 'w_y*l' is in m/s, not rad/s"),
    ('"u/sin(theta)"', f"rate uses 'u', an input, whose rate is not known{SCOPE}"),
    ('"theta_dot"', f"rate uses 'theta_dot', a rate{SCOPE}"),
    ('"w_y/sin(theta - 1)"', "the divisor 'sin(theta - 1)' must not vanish, but does at theta = 1"),
    (f"{RATE}, acceleration = 1", "its acceleration follows from the rate 'w_y/sin(theta)'"),
)
UNANSWERED = (
    ("psi_ddot", "wanted has 'psi_ddot', which is no answer"),
    ("linearised", f"'linearised' {THETA}"),
    ("steady", f"'steady' {PSI}, or say what vanishes by steady.vanishes"),
)


@pytest.mark.parametrize(("rate", "says"), REFUSED, ids=[row[0] for row in REFUSED])
def test_a_formula_that_is_no_rate_is_refused(rate: str, says: str) -> None:
    text = TOP.replace("[speeds]", '[inputs]\nu = { unit = "rad/s", range = [1, 2] }\n[speeds]')
    assert refused(text.replace(RATE, rate)) == f"coordinate 'psi': {says}"


@pytest.mark.parametrize(("wanted", "says"), UNANSWERED, ids=[row[0] for row in UNANSWERED])
def test_what_such_a_coordinate_has_no_answer_to_is_refused(wanted: str, says: str) -> None:
    steady = '[steady]\nunknown = "w_y"\n' if wanted == "steady" else ""
    assert refused(TOP.replace('"state_rate"', f'"{wanted}"') + steady).startswith(says)


@pytest.mark.parametrize(
    ("rate", "motion", "state"),
    [
        ("W", "", False),
        ("W", "free", True),
        ("W*cos(theta)", "", True),
        ("W*cos(theta)", "prescribed", False),
        ("n", "", True),
        ("n", "prescribed", False),
    ],
)
def test_a_coordinate_is_given_if_its_rate_is_or_the_scene_says_so(
    rate: str, motion: str, state: bool,  # noqa: FBT001
) -> None:  # fmt: skip
    said = f'"{rate}"' + (f', motion = "{motion}"' if motion else "")
    text = TOP.replace(RATE, said)
    text = text.replace("[speeds]", '[speeds]\nW = { unit = "rad/s", range = [1, 2], rate = 0 }')
    words = mechanism(parse_scene(text, "top")).vocabulary
    assert ("psi" in {q.name for q in words.states}) == state
    assert ("psi" in {q.name for q in words.inputs}) != state
