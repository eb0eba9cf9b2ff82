"""Steps of machines with constraints end on them, and motions stay there for as long as they go."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import derive
from derive.check.energy import energy_balance
from derive.check.motion import orders_hold, step_slopes_hold
from derive.check.particles import clouds
from derive.library.library import Library, library
from derive.motion import constrained
from derive.program.precision import F64
from derive.program.tape import number
from derive.scene import SceneError, parse_scene
from derive.verify.draw import with_motion
from derive.verify.sample import samples

SCENES = Path(__file__).parents[1] / "mechanics" / "scenes"
FOUR_BARS = {"m": 1.5, "l": 0.75, "g": 9.8}
START = {"q_1": 0.3, "q_2": -0.3, "q_3": 0.3, "q_1_dot": 0.5, "q_2_dot": -0.5, "q_3_dot": 0.5}
SLED = {"m": 1.5, "I": 0.125, "a": 0.25, "x": 0, "y": 0}
ROUNDED = 2e-15
"""A few units in the last place of lengths and rates near 1: what doubles leave of them."""


def text_of(name: str, *wanted: str) -> str:
    first, _, rest = (SCENES / f"{name}.toml").read_text(encoding="utf-8").partition("wanted")
    asked = ", ".join(f'"{one}"' for one in wanted)
    return f"{first}wanted = [{asked}]\n{rest.partition(chr(10))[2]}"


def made(name: str, *wanted: str) -> Library:
    return library(parse_scene(text_of(name, *wanted), "held"))


def handle(folder: Path, name: str, *wanted: str) -> derive.Handle:
    at = folder / "held.toml"
    at.write_text(text_of(name, *wanted), encoding="utf-8")
    return derive.load(str(at))


def outcomes(own: Library) -> dict[tuple[str, str], str]:
    each = with_motion(own, samples(own.mechanism, F64, 1, 0).each, F64)
    every = (*orders_hold(own, each), *step_slopes_hold(own, each))
    return {(v.function, v.check): v.outcome for v in every}


@pytest.mark.long
def test_a_sled_steps_along_its_blade_with_the_order_and_slopes_that_it_claims() -> None:
    own = made("sleigh", "step_rk4", "step_rk4_compensated", "step_rk4_jacobian")
    steps = ("step_rk4", "step_rk4_compensated")
    checks = ("order", "ends on the constraints")
    should = {(step, check): "holds" for step in steps for check in checks}
    assert outcomes(own) == should | {("step_rk4_jacobian", "slopes"): "holds"}
    assert own["step_rk4"].says.endswith("(order 4), brought back onto the constraints.")


DRIVEN = """
wanted = ["step_rk4", "step_rk4_jacobian", "energy", "c", "constraint_distances"]
motion.time_step = { range = [0.001, 0.01] }
parameters.m = { unit = "kg", range = [1, 2] }
parameters.v = { unit = "m/s", range = [0.5, 1] }
coordinates.x = { unit = "m", range = [-1, 1] }
coordinates.z = { unit = "m", range = [-1, 1] }
frames.f = { origin = ["x", "0", "z"] }
bodies.b = { frame = "f", shape = "point", mass = "m" }
loads.weight = { gravity = ["0", "0", -9.81] }
loads.wall = { on = "b", force = ["0", "?N", "0"] }
constraints.c.zero = "ZERO"
"""


@pytest.mark.long
@pytest.mark.parametrize("zero", ["z_dot - v", "x_dot^2 + z_dot^2 - v^2"])
def test_a_formula_of_rates_may_be_any_and_what_enforces_it_works(zero: str) -> None:
    own = library(parse_scene(DRIVEN.replace("ZERO", zero), "driven"))
    each = samples(own.mechanism, F64, 2, 0).each
    every = (*clouds(own, each), *energy_balance(own, each))
    found = {(v.function, v.check): v.outcome for v in every}
    assert set(found.values()) == {"holds"}
    assert ("energy", "power balance") in found
    assert set(outcomes(own).values()) == {"holds"}


@pytest.mark.long
@pytest.mark.parametrize("name", ["four_bar_closed", "slider_crank_guided", "five_bars"])
def test_loops_step_with_the_order_and_slopes_that_they_claim(name: str) -> None:
    found = outcomes(made(name, "step_rk4", "step_rk4_jacobian", "step_taylor12"))
    assert {*found.values()} == {"holds"}
    assert ("step_taylor12", "ends on the constraints") in found


def _driven_by_nothing(_: Any, __: Any, state: Any, ___: Any) -> Any:
    return dict(state)


def _half(*given: Any) -> Any:
    found, damping = CORRECTED(*given)
    return {c: x + (given[0][c] - x) * number(1) / 2 for c, x in found.items()}, damping


CORRECTED = constrained._corrected
MUTANTS = {"no correction of rates": ("_driven", _driven_by_nothing),
           "half a correction": ("_corrected", _half)}  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("mutant", MUTANTS)
def test_a_step_that_does_not_come_back_is_noticed(
    mutant: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(constrained, *MUTANTS[mutant])
    found = outcomes(made("sleigh", "step_rk4"))
    assert found["step_rk4", "ends on the constraints"] == "FAILS"


@pytest.mark.long
def test_a_step_without_corrections_of_places_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(constrained, "PASSES", 0)
    found = outcomes(made("slider_crank_guided", "step_rk4"))
    assert found["step_rk4", "ends on the constraints"] == "FAILS"


@pytest.mark.long
def test_a_minute_of_four_bars_is_that_of_a_pendulum_and_closed_to_the_last(tmp_path: Path) -> None:
    own = handle(tmp_path, "four_bar_closed", "step_rk4", "constraint_distances", "energy")
    motion = own.simulate(FOUR_BARS | START, 60, 0.01)
    assert len(motion.left) == 4
    assert max(off for _, off in motion.left) < ROUNDED
    states = motion.states
    assert np.max(np.abs(states["q_1"] + states["q_2"])) < ROUNDED
    energies = []
    for k in (0, -1):
        at = FOUR_BARS | {name: float(x[k]) for name, x in states.items()}
        energies.append(float(own.solve(at)["energy"]))
    # what RK4 of order 4 leaves of 20.9 J: without closing, as much
    assert abs(energies[1] - energies[0]) < 1e-6
    pull = 6 / 5 * FOUR_BARS["g"] / FOUR_BARS["l"]
    q, h = np.array([START["q_1"], START["q_1_dot"]]), 0.01

    def rate(q: Any) -> Any:
        return np.array([q[1], -pull * np.sin(q[0])])

    for _ in range(6000):
        a = rate(q)
        b = rate(q + h / 2 * a)
        c = rate(q + h / 2 * b)
        d = rate(q + h * c)
        q = q + h / 6 * (a + 2 * b + 2 * c + d)
    assert states["q_1"][-1] == pytest.approx(q[0], abs=1e-6)


def test_a_sled_keeps_to_its_blade_and_a_start_beside_it_is_refused(tmp_path: Path) -> None:
    own = handle(tmp_path, "sleigh", "step_rk4", "constraint_distances", "blade")
    start = SLED | {"psi": 0.5, "psi_dot": 0.5, "x_dot": 1.2, "y_dot": 1.2 * np.tan(0.5)}
    motion = own.simulate(start, 5, 0.01)
    assert max(off for _, off in motion.left) < ROUNDED
    rounded = own.simulate(start | {"y_dot": round(start["y_dot"], 4)}, 1, 0.01)
    assert rounded.states["y_dot"][0] == pytest.approx(start["y_dot"], abs=1e-4)
    assert any("so that the constraints hold" in doubt for doubt in rounded.doubts)
    rule = "a motion must begin where constraint 'blade' is 0, not -1.053; a state nearby that"
    with pytest.raises(SceneError, match=rule):
        own.simulate(start | {"y_dot": -0.5445}, 1, 0.01)


KNIFE = """
wanted = ["step_rk4", "energy"]
parameters.m = { unit = "kg", range = [1, 2] }
parameters.J = { unit = "kg m^2", range = [0.1, 0.2] }
coordinates.x = { unit = "m", range = [-5, 5] }
coordinates.y = { unit = "m", range = [-5, 5] }
coordinates.q = { unit = "rad", range = [-3, 3] }
frames.plane = { turned = ["x 0.3"] }
frames.blade = { parent = "plane", origin = ["x", "y", "0"], turned = ["z q"] }
bodies.blade = { frame = "blade", kind = "axisymmetric", axis = "z", axial = "J", transverse = "J", mass = "m" }
loads.weight = { gravity = ["0", "0", -9.81] }
loads.ice = { on = "blade", force = ["0", "0", "?N"], couple = ["?a", "?b", "0"] }
constraints.edge.zero = "y_dot*cos(q) - x_dot*sin(q)"
"""  # noqa: E501


def test_an_edge_slides_on_a_slope_as_in_its_closed_form_beside_constants_of_other_functions(
    tmp_path: Path,
) -> None:
    at = tmp_path / "knife.toml"
    at.write_text(KNIFE, encoding="utf-8")
    own, turn, pull = derive.load(str(at)), 2.0, 9.81 * np.sin(0.3)
    start = {"m": 1.5, "J": 0.15, "x": 0, "y": 0, "q": 0, "x_dot": 0, "y_dot": 0, "q_dot": turn}
    motion = own.simulate(start, 1, 0.002)
    assert motion.left[0][1] < ROUNDED
    # its speed along itself is pull/turn (cos(turn t) - 1)
    along = 0.5 + np.sin(2 * turn) / (4 * turn) - np.sin(turn) / turn
    aside = np.sin(turn) ** 2 / (2 * turn) + (np.cos(turn) - 1) / turn
    assert motion.states["x"][-1] == pytest.approx(pull / turn * along, abs=1e-9)
    assert motion.states["y"][-1] == pytest.approx(pull / turn * aside, abs=1e-9)


@pytest.mark.parametrize(("wanted", "says"), [
    ("step_rk4_sensitivity", "'step_rk4_sensitivity' is of machines without constraints"),
    ("constraint_distance", r"which is no answer \(did you mean 'constraint_distances'"),
])  # fmt: skip
def test_what_is_no_step_of_a_machine_with_constraints_is_refused(wanted: str, says: str) -> None:
    with pytest.raises(SceneError, match=says):
        made("sleigh", wanted)


def test_stages_in_loops_are_refused_where_there_are_constraints() -> None:
    text = 'emission = "compact"\n' + text_of("sleigh", "step_rk4")
    with pytest.raises(SceneError, match="emission = 'compact' is for machines without constr"):
        library(parse_scene(text, "held"))


def test_distances_are_no_answer_of_a_machine_without_constraints() -> None:
    first = text_of("sleigh", "constraint_distances").partition("[constraints")[0]
    with pytest.raises(SceneError, match="wanted has 'constraint_distances', which is no answer"):
        parse_scene(first, "free")


def test_what_vanishes_is_named_and_nobody_else_is_called_so() -> None:
    own = made("sleigh", "constraint_distances")
    (output,) = own["constraint_distances"].outputs
    assert output.components == ("distance_blade_dot",)
    text = text_of("sleigh", "constraint_distances").replace("[parameters]", "[parameters]\n"
        'distance_blade_dot = { unit = "m", range = [1, 2] }')  # fmt: skip
    with pytest.raises(SceneError, match="'distance_blade_dot' is declared twice"):
        parse_scene(text, "held")
