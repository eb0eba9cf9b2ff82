"""What a report says in its sentence is true of states that it did not look at."""

import json
from dataclasses import replace
from math import inf, nan
from pathlib import Path

import numpy as np
import pytest

from derive.library.library import library
from derive.program.precision import F64
from derive.report.apart import errors_at_end, true_ends
from derive.report.courses import Attempt, StepErrors, followed_to_the_end, time_of
from derive.report.driver import drivers
from derive.report.hardest import hardest
from derive.report.march import ended
from derive.report.sentence import cheapest, choice, least, motion_sentence
from derive.report.states import Begun, begun, fastest, nearby
from derive.report.whole import report
from derive.report.wishes import wished
from derive.scene import SceneError, parse_scene
from tests.made import library_of, text_of

REPORTS = Path(__file__).parents[2] / "generated"
NOBODY = Begun((), np.zeros((0, 1)))


def made_up(**errors: list[float]) -> StepErrors:
    """Return steps with these errors at 1, 2, 4, ... steps of a motion of 1 s."""
    attempts = tuple(
        Attempt(step, precision, 2.0**-n, 2**n, (error,))
        for step, each in errors.items()
        for precision, factor in (("f64", 1.0), ("f32", 1e5))
        for n, error in enumerate(x * factor for x in each)
    )
    costs = {"step_a": 10, "step_b": 35, "flow_exact": 5}
    own = {step: costs[step] for step in errors}
    floors = {"f64": (1e-15,), "f32": (1e-6,)}
    return StepErrors(
        time=1.0, given=True, fast=1.0, start=NOBODY, hard=1, tried=8, aside={},
        work=0, attempts=attempts, costs=own, floors=floors,
    )  # fmt: skip


def test_a_length_is_named_once_it_and_two_finer_ones_keep_to_half_of_the_error() -> None:
    found = made_up(step_a=[1e-7, 1e-5, 6e-7, 4e-7, 1e-8, 1e-9, 1e-9])
    chosen = choice(found, "step_a", "f64", 1e-6)
    assert chosen is not None
    assert chosen.attempt.count == 8
    assert chosen.operations == 80
    assert choice(found, "step_a", "f32", 1e-6) is None


def test_the_cheapest_step_for_a_second_is_named_not_that_of_a_step() -> None:
    found = made_up(step_a=[1.0] * 5 + [1e-7] * 3, step_b=[1e-7] * 4)
    best = cheapest(found, "f64", 1e-6)
    assert best is not None
    assert best.attempt.step == "step_b"
    said = motion_sentence(found)
    assert said.startswith("for 1e-6 over 1 s: step_b at 1 s in double, 35 weighted operations a s")
    assert said.endswith("in float no step tried keeps below 0.01")


def test_an_error_that_no_step_keeps_to_is_not_named() -> None:
    found = made_up(step_a=[1.0, 1e-3, 1e-3, 1e-3, 1e-3])
    assert motion_sentence(found).startswith("for 1e-2 over 1 s: step_a at 500 ms in double")
    lost = replace(found, attempts=tuple(replace(a, errors=(1.0,)) for a in found.attempts))
    assert "in double no step tried ends near the true motion" in motion_sentence(lost)


@pytest.mark.long
@pytest.mark.parametrize("name", ["sleeping_top", "heavy_top"])
def test_the_sentence_holds_from_the_hardest_states_of_another_search(
    name: str, tmp_path: Path
) -> None:
    file = REPORTS / name / f"{name}_report.json"
    if not file.is_file():
        pytest.skip(f"no report of '{name}' is committed")
    said = json.loads(file.read_text(encoding="utf-8"))["motion"]
    chosen, time, fast = said["said"]["choices"]["f64"], said["time"], said["rate"]
    library = wished(library_of(name)).library
    (driver,) = drivers(library, (F64,), tmp_path)
    found = hardest(driver, "another", time, fast)
    followed = followed_to_the_end(library, found, time, fast)
    start, true = followed.start, true_ends(library.vocabulary.states, followed.ends)

    def error(count: int) -> float:
        end = ended(driver, chosen["step"], start, time, count)
        return float(max(errors_at_end(library.vocabulary.states, end, true)))

    count = round(time / chosen["length"])
    assert error(count) <= said["said"]["error"]
    assert error(count // 4) > said["said"]["error"]


def test_what_no_step_keeps_below_does_not_rest_on_one_lucky_length() -> None:
    found = made_up(step_a=[1.0, 1e-3, 1e-3, 1e-9, 1e-3, 1e-3, 1e-3], step_b=[1.0, 1e-9])
    for precision, factor in (("f64", 1.0), ("f32", 1e5)):
        assert least(found, precision, found.costs) == pytest.approx(1e-3 * factor)
    assert choice(found, "step_b", "f64", 1e-6) is None  # its half and quarter were not tried


def test_a_time_that_is_out_of_all_bounds_is_refused_in_one_sentence() -> None:
    own = library_of("tumbling_disc")
    for until in (1e-300, 1e-9, 1e300, -1.0, 0.0, inf, nan):
        with pytest.raises(SceneError, match=r"^scene 'tumbling_disc': until must be .*, not "):
            time_of(own, until, 10.0)
    for until in (1e-5, 0.5, 60000.0):
        assert time_of(own, until, 10.0) == pytest.approx(until)


@pytest.mark.long
def test_scenes_that_differ_in_name_only_have_the_same_limit() -> None:
    text = text_of("tumbling_disc")
    own, other = (library(parse_scene(text, name)) for name in ("tumbling_disc", "plate"))
    assert fastest(own) == fastest(other) > 0
    wider = text.replace("[-10, 10] }\nmoment", "[-50, 50] }\nmoment")
    assert fastest(library(parse_scene(wider, "plate"))) != fastest(other)


@pytest.mark.long
def test_the_scene_says_to_what_time_unless_the_command_does() -> None:
    text = text_of("tumbling_disc")
    own = library(parse_scene(f"horizon = 0.25\n{text}", "tumbling_disc"))
    assert time_of(own, None, 10.0) == 0.25
    assert time_of(own, 0.5, 10.0) == 0.5
    for said in ("-1", "0", "0.0"):
        with pytest.raises(SceneError, match=rf"horizon must be above 0, not {said}$"):
            parse_scene(f"horizon = {said}\n{text}", "tumbling_disc")
    long = library(parse_scene(f"horizon = 1e9\n{text}", "tumbling_disc"))
    with pytest.raises(SceneError, match=r"^scene 'tumbling_disc': horizon must be from .* s to "):
        time_of(long, None, 10.0)
    still = library(parse_scene(f"horizon = 1\n{text_of('top_steady_precession')}", "still"))
    with pytest.raises(SceneError, match=r"^scene 'still': horizon is of motion, but "):
        report(still)


@pytest.mark.long
def test_states_of_a_motion_hold_what_moves_it_and_nothing_else() -> None:
    text = """
    wanted = ["state_rate", "angular_momentum", "moment"]
    axes = { attitude = "quaternion" }
    body = { kind = "spherical", moment = 2 }
    known = { moment = ["M", "0", "0"] }
    inputs = { M = { unit = "N m", range = [0, 1], meaning = "moment" } }
    """
    own = wished(library(parse_scene(text, "ball"))).library
    every = begun(own, "names", 4)
    attitude = {f"attitude_{c}" for c in "wxyz"}
    assert {*every.names} == {"M", "omega_x", "omega_y", "omega_z"} | attitude
    assert nearby(own, every, "names", 4, 0.1).names == every.names


def test_states_that_are_left_aside_are_in_the_sentence_with_their_share_and_the_reason() -> None:
    found = replace(made_up(step_a=[1e-7] * 4), aside={"becomes infinite": 6})
    said = "left aside: of 8 states tried, 6 (75 %) whose motion becomes infinite"
    assert motion_sentence(found).endswith(f"; {said}")
    assert "aside" not in motion_sentence(replace(found, aside={}))
