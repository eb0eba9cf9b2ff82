"""Loops and other constraints: closed forms, clouds of particles, and mutants that they notice."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from flint import arb
from mpmath import asin, cos, diff, mpf, sin, sqrt
from sympy import Integer

from derive.check.energy import energy_balance
from derive.check.particles import clouds, on_constraints
from derive.library.library import Library, library
from derive.mechanics import constraints, enforced
from derive.mechanics.constraints import Tie
from derive.mechanics.mechanism import mechanism
from derive.program.precision import F64
from derive.scene import SceneError, parse_scene
from derive.verify.measure import results
from derive.verify.sample import samples

SCENES = Path(__file__).parent / "scenes"
NAMES = ("four_bar_closed", "slider_crank_guided", "sleigh", "five_bars", "bricard")
TEXTS = {name: (SCENES / f"{name}.toml").read_text(encoding="utf-8") for name in NAMES}
ROUNDED = 1e-12  # of an acceleration: a state on the constraint is given in doubles
FEW = 2


def made(text: str) -> Library:
    return library(parse_scene(text, "held"))


def answered(text: str, given: Mapping[str, Any]) -> dict[str, float]:
    """Return all answers of a scene where all that is not given is 0."""
    own = made(text)
    at = {c: arb(float(given.get(c, 0))) for q in own.vocabulary.given() for c in q.components}
    return {n: float(x) for p in own.functions for n, x in results(own, p, at).items()}


def verdicts(own: Library) -> set[str]:
    each = samples(own.mechanism, F64, FEW, 0).each
    return {v.outcome for v in (*clouds(own, each), *energy_balance(own, each))}


@pytest.mark.parametrize(
    "name", ["sleigh", *(pytest.param(n, marks=pytest.mark.long) for n in NAMES if n != "sleigh")]
)
def test_machines_with_constraints_agree_with_their_clouds(name: str) -> None:
    assert verdicts(made(TEXTS[name])) == {"holds"}


@pytest.mark.parametrize("q", [0.1, -0.4])
@pytest.mark.long
def test_a_parallelogram_swings_as_a_pendulum(q: float) -> None:
    given = {"m": 1.5, "l": 0.75, "g": 9.8, "q_1": q, "q_2": -q, "q_3": q}
    rates = {"q_1_dot": 0.7, "q_2_dot": -0.7, "q_3_dot": 0.7}
    found = answered(TEXTS["four_bar_closed"], given | rates)
    should = -6 / 5 * 9.8 / 0.75 * float(sin(q))
    assert found["q_1_ddot"] == pytest.approx(should, rel=ROUNDED)
    assert found["q_2_ddot"] == pytest.approx(-should, rel=ROUNDED)


@pytest.mark.long
@pytest.mark.parametrize("a", [0.2, -2.5])
def test_a_slider_crank_moves_as_its_closed_form(a: float) -> None:
    m_1, m_2, m_3, r, l, tau, rate = map(mpf, (1.5, 1.25, 1.75, 0.125, 0.4375, 5, 3))  # noqa: E741

    def b(a: Any) -> Any:
        return -asin(r * sin(a) / l)

    def inertia(a: Any) -> Any:
        x, y = (diff(lambda s, f=f: r * f(s) + l / 2 * f(b(s)), a) for f in (cos, sin))
        slide = diff(lambda s: r * cos(s) + l * cos(b(s)), a)
        rods = m_1 * r**2 / 3 + m_2 * l**2 / 12 * diff(b, a) ** 2
        return rods + m_2 * (x**2 + y**2) + m_3 * slide**2

    given = {"m_1": 1.5, "m_2": 1.25, "m_3": 1.75, "r": 0.125, "l": 0.4375, "tau": 5}
    given |= {"a": a, "b": b(a), "a_dot": 3, "b_dot": rate * diff(b, a)}
    should = (tau - diff(inertia, a) * rate**2 / 2) / inertia(a)
    found = answered(TEXTS["slider_crank_guided"], given)
    assert found["a_ddot"] == pytest.approx(float(should), rel=1e-9)


def test_a_sleigh_moves_as_chaplygin_says() -> None:
    m, I, a, psi, u, w = 1.5, 0.125, 0.25, 0.5, 2.0, 3.0  # noqa: E741
    c, s = float(cos(psi)), float(sin(psi))
    given = {"m": m, "I": I, "a": a, "psi": psi}
    given |= {"psi_dot": w, "x_dot": u * c, "y_dot": u * s}
    found = answered(TEXTS["sleigh"], given)
    assert found["psi_ddot"] == pytest.approx(-m * a * u * w / (I + m * a * a), rel=ROUNDED)
    ahead = found["x_ddot"] * c + found["y_ddot"] * s
    assert ahead == pytest.approx(a * w * w, rel=ROUNDED)


@pytest.mark.long
def test_a_blade_by_points_is_the_blade_by_its_formula() -> None:
    points = 'on = "sled"\nequal = "velocities"\nalong = "sled"\naxes = ["y"]'
    text = TEXTS["sleigh"].replace('zero = "y_dot*cos(psi) - x_dot*sin(psi)"', points)
    by_points = text.replace('"blade"', '"blade_y"')
    given = {"m": 1.5, "I": 0.125, "a": 0.25, "psi": 0.5}
    given |= {"psi_dot": 3, "x_dot": cos(0.5), "y_dot": sin(0.5)}
    one, other = answered(TEXTS["sleigh"], given), answered(by_points, given)
    assert one["blade"] == pytest.approx(other["blade_y"], rel=ROUNDED)
    assert one["psi_ddot"] == pytest.approx(other["psi_ddot"], rel=ROUNDED)
    assert verdicts(made(by_points)) == {"holds"}


@pytest.mark.long
@pytest.mark.parametrize(("name", "row"), [("five_bars", "c_3"), ("bricard", "line")])
def test_redundant_rows_are_dropped_and_named(name: str, row: str) -> None:
    (said,) = mechanism(parse_scene(TEXTS[name], "held")).redundant
    rule = "says nothing that the others do not, and is left out"
    assert said == f"constraint '{row} along z' {rule}: '{row}_z' is 0"


def _without_factor(by: Any) -> Callable[..., Any]:
    return lambda self, value, rate: Integer(0) * by(self, value, rate)


MUTANTS: Mapping[str, Callable[[Tie], Tie]] = {
    "no convective term": lambda c: replace(c, second=_linear(c)),
    "another sign": lambda c: replace(c, second=c.second - 2 * (c.second - _linear(c))),
    "no force": lambda c: replace(c, generalized=False),
}


def _linear(c: Tie) -> Any:
    """Return a second rate without what no acceleration multiplies."""
    held = [s for s in c.second.free_symbols if s.name in ACCELERATIONS]
    return c.second - c.second.xreplace(dict.fromkeys(held, Integer(0)))


ACCELERATIONS: set[str] = set()


@pytest.mark.parametrize("mutant", MUTANTS)
def test_a_wrong_constraint_is_noticed_by_the_cloud(
    mutant: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = TEXTS["sleigh"]
    scene = parse_scene(text, "held")
    sheet = library(scene).mechanism.answers.frames.sheet
    ACCELERATIONS.update(s.name for s in sheet.unknowns)
    right = constraints._made
    monkeypatch.setattr(constraints, "_made", lambda *a, **k: MUTANTS[mutant](right(*a, **k)))
    try:
        own = library(scene)
    except SceneError:
        return  # nothing holds what should enforce it
    each = samples(own.mechanism, F64, FEW, 0).each
    assert "FAILS" in {v.outcome for v in clouds(own, each)}


@pytest.mark.long
def test_states_are_brought_onto_constraints() -> None:
    scene = parse_scene(TEXTS["four_bar_closed"], "held")
    names = [c for q in library(scene).vocabulary.given() for c in q.components]
    start = {n: arb(0.25) for n in names} | {"m": arb(1), "l": arb(1), "g": arb("9.75")}
    found = on_constraints(scene, start)
    x, z = found["q_1"], found["q_3"]
    assert abs(float(x - z)) < float(sqrt(mpf(10) ** -60))
    assert abs(float(found["q_1_dot"] + found["q_2_dot"])) < float(sqrt(mpf(10) ** -60))


@pytest.mark.long
def test_the_trials_that_were_refused_have_answers_with_a_constraint() -> None:
    text = (SCENES.parents[1] / "data" / "trials" / "four_bar.toml").read_text(encoding="utf-8")
    close = ('constraints.close = { load = "d", on = "bar", at = ["l", "0", "0"], '
             'against = "right", to = ["0", "0", "-l"], axes = ["x", "z"] }\n')  # fmt: skip
    with pytest.raises(SceneError, match="closed loop"):
        made(text)
    assert verdicts(made(close + text)) == {"holds"}


def test_virtual_power_is_needed_for_a_generalized_force(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(enforced.Partials, "by", _without_factor(enforced.Partials.by))
    with pytest.raises((SceneError, ValueError)):
        made(TEXTS["sleigh"])


SLOPE = """
wanted = ["accelerations", "N", "grip_x"]
parameters.m = { unit = "kg", range = [1, 2] }
parameters.r = { unit = "m", range = [0.2, 0.3] }
parameters.beta = { unit = "rad", range = [0.1, 0.5] }
coordinates.x = { unit = "m", range = [-5, 5] }
coordinates.q = { unit = "rad", range = [-6, 6] }
frames.plane = { turned = ["z -beta"] }
frames.disc = { parent = "plane", origin = ["x", "r", "0"], turned = ["z -q"] }
bodies.disc = { frame = "disc", shape = "disc", axis = "z", radius = "r", mass = "m" }
loads.weight = { gravity = ["0", -9.81, "0"] }
[loads.ground]
on = "disc"
frame = "plane"
at = ["x", "0", "0"]
force = ["0", "?N", "?side"]
couple = ["?tilt", "?turn", "0"]
[constraints.grip]
on = "disc"
frame = "plane"
at = ["x", "0", "0"]
along = "plane"
equal = "velocities"
axes = ["x"]
"""


@pytest.mark.parametrize("q", [0.0, 1.5707963267948966, 4.0])
def test_what_a_disc_presses_on_a_slope_is_told_in_axes_that_do_not_turn_with_it(q: float) -> None:
    found = answered(SLOPE, {"m": 1.5, "r": 0.25, "beta": 0.3, "q": q})
    weight, slope = 1.5 * 9.81, mpf(0.3)
    assert found["x_ddot"] == pytest.approx(float(2 / mpf(3) * mpf("9.81") * sin(slope)), rel=1e-14)
    assert found["N"] == pytest.approx(weight * float(cos(slope)), rel=1e-14)
    assert found["grip_x"] == pytest.approx(-weight / 3 * float(sin(slope)), rel=1e-14)
