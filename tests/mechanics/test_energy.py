"""A machine's energy grows by the power of the loads that are not in it, and by nothing else."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import pytest

from bench.chains import chain
from derive.check.energy import emitted_balance, energy_balance
from derive.library.library import Library, library
from derive.mechanics import loads
from derive.mechanics.mechanism import mechanism
from derive.program.precision import F64
from derive.scene import SceneError, catalogue, load, parse_scene
from derive.verify.cloud import balance
from derive.verify.equations import equations_of
from derive.verify.reference import reference
from derive.verify.sample import Sample, samples
from tests.check.mutants import first_sign_flipped
from tests.check.replayed import Replayed
from tests.made import library_of, thinned

SCENES = Path(__file__).parent / "scenes"
TRIALS = Path(__file__).parents[1] / "data" / "trials"
LONG_FORM = Path(__file__).parents[1] / "data" / "long_form"
BODY = (LONG_FORM / "free_body_principal.toml").read_text(encoding="utf-8")
BODY = BODY.replace('"acceleration_jacobian: W_x_dot, W_y_dot, W_z_dot"', '"kinetic_energy"')
BODY = BODY.replace('\nacceleration = ["0", "0", "0"]', '\nvelocity = ["0", "0", "0"]')
ROLLING = (TRIALS / "rolling_disc_energy.toml").read_text(encoding="utf-8")
WITH_ENERGY = ("spring_pendulums", "hoop_pole", "top_on_lift", "rolling_coin", "rolling_ball")


def one(made: Library) -> tuple[Sample, ...]:
    """Return one sample of a scene."""
    return samples(made.mechanism, F64, 1, 0).each


def outcomes(made: Library) -> set[str]:
    """Return how the energies of a machine came out beside the power of its loads."""
    found = list(energy_balance(made, one(made)))
    assert found
    return {v.outcome for v in found}


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(WITH_ENERGY, 7))
def test_an_energy_changes_by_the_power_of_the_loads_that_are_not_in_it(name: str) -> None:
    assert outcomes(library(load(SCENES / f"{name}.toml"))) == {"holds"}


AT_ONCE = ("skewed_disc", "tumbling_disc")
NOT_TOLD = {
    "centrifuge_gondola": "its velocity is not given",
    "ship_turbine_three_motions": "the transverse moment of inertia",
    "ship_turbine_turn_port": "the transverse moment of inertia",
    "eulers_disk": "the loads contradict each other",
    "top_steady_precession": "the loads contradict each other",
}
"""Why the power of scenes is not balanced: an energy that they do not tell, a motion not found."""


@pytest.mark.parametrize(
    "name", [n if n in AT_ONCE else pytest.param(n, marks=pytest.mark.long) for n in catalogue()]
)
def test_every_scene_has_its_power_balanced_or_says_what_it_does_not_tell(name: str) -> None:
    made = library_of(name)
    found = list(energy_balance(made, one(made)))
    reason = NOT_TOLD.get(name, "")
    assert {v.outcome for v in found} == {"skipped" if reason else "holds"}
    assert all(reason in v.says for v in found)


# Programs of one machine beside the loads of another: what is told apart, a machine, its edit.
SPOILT = (
    ("a stiffer spring", "spring_pendulums", 'spring = "k"', 'spring = "2*k"'),
    ("a weight upwards", "hoop_pole", 'gravity = ["0", "0", "-g"]', 'gravity = ["0", "0", "g"]'),
    ("a dropped weight", "hoop_pole", 'gravity = ["0", "0", "-g"]', 'gravity = ["0", "0", "0*g"]'),
    ("a dropped rest length", "spring_pendulums", 'length = "l0"', "length = 0"),
)  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("row", thinned(SPOILT, 4), ids=[row[0] for row in SPOILT])
def test_an_energy_of_other_loads_is_noticed(row: tuple[str, str, str, str]) -> None:
    _, name, old, new = row
    right = load(SCENES / f"{name}.toml")
    assert old in right.text
    made = library(parse_scene(right.text.replace(old, new), name))
    assert outcomes(replace(made, mechanism=replace(made.mechanism, scene=right))) == {"FAILS"}


@pytest.mark.long
def test_the_balance_of_a_body_turned_by_a_quaternion_has_all_digits() -> None:
    assert outcomes(library_of("rigid_body")) == {"holds"}


@pytest.mark.parametrize(("spoilt", "outcome"), [(0, "holds"), (1, "FAILS")])
def test_a_prescribed_motion_changes_its_energy_by_the_power_of_what_it_needs(
    spoilt: int, outcome: str
) -> None:
    made = library_of("unsymmetrical_rotor_in_carrier_axes")
    energy = made["kinetic_energy"]
    wrong = first_sign_flipped(energy) if spoilt else energy
    assert outcomes(replace(made, functions=(wrong,))) == {outcome}


@pytest.mark.long
def test_an_energy_that_leaves_out_a_part_of_what_springs_pull_with_is_noticed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    by_lecture, by_particles = loads._spring, balance._spring
    monkeypatch.setattr(
        loads, "_spring", lambda *of: (replace(w, force=2 * w.force) for w in by_lecture(*of))
    )
    monkeypatch.setattr(
        balance, "_spring", lambda *of: ((on, at, 2 * f, M) for on, at, f, M in by_particles(*of))
    )
    text = load(SCENES / "spring_pendulums.toml").text
    alone = re.sub("^wanted = .*", 'wanted = ["energy"]', text, flags=re.M)
    assert outcomes(library(parse_scene(alone, "springs"))) == {"FAILS"}


@pytest.mark.parametrize(("flipped", "outcome"), [(0, "holds"), (1, "FAILS")])
def test_a_flipped_sign_in_emitted_accelerations_is_noticed(flipped: int, outcome: str) -> None:
    made = library(parse_scene(BODY, "body"))
    wrong = [first_sign_flipped(f) for f in made.functions[:flipped]] + [*made.functions[flipped:]]
    emitted = cast("Any", Replayed(made, replace(made, functions=tuple(wrong))))
    assert {v.outcome for v in emitted_balance(emitted, one(made))} == {outcome}


def test_the_energy_of_a_disc_whose_height_is_not_known_is_refused() -> None:
    with pytest.raises(SceneError, match="the height of frame 'disc' is not known"):
        library(parse_scene(ROLLING, "disc"))


@pytest.mark.long
def test_an_energy_without_the_height_of_a_rolling_disc_is_noticed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(loads, "vanishes", lambda *_: True)
    found = energy_balance(made := library(parse_scene(ROLLING, "disc")), one(made))
    assert {v.function: v.outcome for v in found} == {
        "potential_energy": "FAILS", "kinetic_energy": "holds", "energy": "FAILS"
    }  # fmt: skip


def test_the_height_may_be_added_where_the_kinetic_energy_stands() -> None:
    text = ROLLING.replace('"potential_energy", "kinetic_energy", "energy"', '"total"')
    results = '[results]\ntotal = "kinetic_energy + m*g*r*cos(lean)"\n'
    made = library(parse_scene(text + results, "disc"))
    assert "total" in made.problems


def test_a_disc_that_rolls_upright_keeps_its_height_and_has_an_energy() -> None:
    text = ROLLING.replace('"z yaw", "x lean"', '"z yaw"')
    text = "\n".join(line for line in text.splitlines() if not line.startswith("lean"))
    text += '\nhold = { on = "disc", couple = ["?hold", "0", "0"] }\n'
    assert outcomes(library(parse_scene(text, "disc"))) == {"holds"}


# Energies of what has none, or of what is nowhere: an edit of the rolling disc and its sentence.
NOWHERE = (
    ('rolls  = { body = "disc", at = ["0", "0", "-r"] }', 'velocity = ["0", "w*r", "0"]',
     "the height of frame 'disc' is not known"),
    ('gravity = ["0", "0", "-g"]', 'gravity = ["0", "0", "-g"], along = "disc"',
     "for its gravity change with the motion"),
    ('gravity = ["0", "0", "-g"]', 'gravity = ["0", "0", "-g*cos(lean)"]',
     "for its gravity change with the motion"),
)  # fmt: skip


@pytest.mark.parametrize(("old", "new", "says"), NOWHERE)
def test_what_has_no_energy_is_refused(old: str, new: str, says: str) -> None:
    assert old in ROLLING
    with pytest.raises(SceneError, match=says):
        library(parse_scene(ROLLING.replace(old, new), "disc"))


def test_a_momentum_about_a_point_that_is_nowhere_is_refused() -> None:
    text = ROLLING.replace('"potential_energy", "kinetic_energy", "energy"', '"angular_momentum"')
    text += '[angular_momentum]\nframe = "inertial"\n'
    with pytest.raises(SceneError, match="the origin of frame 'disc' is needed as a place"):
        library(parse_scene(text, "disc"))


@pytest.mark.long
def test_weights_up_a_long_chain_have_the_energy_of_places_carried_up_and_few_terms(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    text = chain("yxy" * 2).replace('"accelerations"', '"potential_energy"')
    values: list[float] = []
    terms: list[int] = []
    for few in (loads.FEW, 6):
        monkeypatch.setattr(loads, "FEW", few)
        known = mechanism(parse_scene(text, "chain"))
        equations = equations_of(known, known.problem("potential_energy"))
        at = samples(known, F64, 1, 0).each[0].values
        values.append(float(reference(equations, at, ())["potential_energy"].value))
        terms.append(sum(len(s) for b in equations.blocks for s in b.right))
    assert values[0] == pytest.approx(values[1], rel=1e-12)
    assert terms[0] < 80
