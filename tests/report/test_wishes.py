"""What a scene could want is what its rules admit, no more and no less."""

import re

import pytest

from derive.emit.c.source import c_files
from derive.library.library import library
from derive.report.wishes import ORDERS, STEPS, in_other_form, wished
from derive.scene import parse_scene
from tests.made import library_of, scene_of


@pytest.mark.long
def test_a_body_without_torque_could_want_every_step() -> None:
    found = wished(library_of("tumbling_disc"))
    assert {*found.steps} == {s for s in STEPS if "taylor" not in s or s in ORDERS}
    assert found.own == ("flow_exact", "step_dmv", "step_split", "step_rk4")
    assert all(found.library[name].name == name for name in found.steps)


@pytest.mark.long
def test_a_machine_has_the_steps_that_need_its_rate_alone() -> None:
    found = wished(library_of("sleeping_top"))
    assert found.steps == ("step_rk4", "step_taylor", "step_taylor12", "step_rk4_compensated")
    assert {*found.refused} == {*STEPS} - {s for s in STEPS if s in found.steps or "taylor" in s}


def test_a_machine_in_which_nothing_is_free_has_none_and_it_is_said_why() -> None:
    found = wished(library_of("edge_runner_flat"))
    assert found.steps == ()
    assert "nothing is" in found.refused["step_rk4"]


@pytest.mark.long
def test_the_other_form_has_the_same_functions() -> None:
    other = in_other_form(scene_of("heavy_top"))
    assert other is not None
    assert other.scene.form == "accurate"
    assert [p.name for p in other.functions] == [p.name for p in library_of("heavy_top").functions]
    assert all(p.arithmetic == "pairs" for p in other.functions)
    assert in_other_form(scene_of("attitude")) is None


@pytest.mark.parametrize("kind", ['"spherical"\nmoment = 1', '"principal"\nmoments = [1, 1, 2]'])
def test_no_step_of_a_body_of_numbers_makes_a_name_that_nothing_reads(kind: str) -> None:
    text = f'wanted = ["kinetic_energy"]\n[body]\nkind = {kind}\n'
    source = c_files(wished(library(parse_scene(text, "ball"))).library, ())["ball_f64.c"]
    bodies = re.split(r"^}$", source, flags=re.M)
    made = [(n, b) for b in bodies for n in re.findall(r"const double (\w+) =", b)]
    assert len(made) > 100
    assert [n for n, b in made if len(re.findall(rf"\b{n}\b", b)) < 2] == []


@pytest.mark.long
@pytest.mark.parametrize("name", ["skewed_disc", "reaction_wheel_satellite"])
def test_what_is_wanted_as_a_group_stays_one_in_the_other_form(name: str) -> None:
    other = in_other_form(scene_of(name))
    assert other is not None
    assert [p.name for p in other.functions] == [p.name for p in library_of(name).functions]


@pytest.mark.long
@pytest.mark.whole
def test_a_scene_that_wants_a_group_could_want_every_step_of_a_machine() -> None:
    assert "step_taylor12" in wished(library_of("quadrotor")).steps
