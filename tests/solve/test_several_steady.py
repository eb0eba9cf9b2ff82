"""Several unknowns of a steady motion, and several steady motions of one scene."""

import re
from math import acos
from pathlib import Path
from typing import Any

import pytest

from derive import Handle, load
from derive.check import proof
from derive.cli import main
from derive.scene import SceneError
from tests.scene.fuzzed import ODD, fault
from tests.scene.mutated import written
from tests.solve.test_carried import HOOP, VALUES

BOTH = HOOP | {
    "wanted": ["steady_angle", "steady_speed", "N"],
    "steady": {"angle": {"unknown": "theta"}, "speed": {"unknown": "W"}},
}
COSINE = 9.8 / (8.0**2 * 0.25)
DOUBLE = HOOP | {
    "wanted": ["steady", "a_ddot"],
    "coordinates": {
        "a": {"unit": "rad", "range": [0.2, 1.5]},
        "b": {"unit": "rad", "range": [-1.5, 1.5]},
    },
    "frames": {
        "hoop": {"angular_velocity": [0, 0, "W"]},
        "arm": {"parent": "hoop", "turned": ["y -a"]},
        "two": {"parent": "arm", "origin": [0, 0, "-r"], "turned": ["y -b"]},
    },
    "bodies": {
        name: {"frame": frame, "shape": "point", "mass": "m", "centre": [0, 0, "-r"]}
        for name, frame in (("bead", "arm"), ("bob", "two"))
    },
    "loads": HOOP["loads"]
    | {"pin": {"on": "bob", "against": "bead", "force": "?P", "couple": ["?D", 0, "?E"]}},
    "steady": {"unknown": ["a", "b"]},
    "linearised": {},
}
"""Two pendulums on a post that turns: at which two angles do they hang?"""


def scene(document: dict[str, Any], **changed: Any) -> Handle:
    return load(document | changed, "hoop")


def test_each_steady_motion_is_found_where_its_own_unknown_is_not_set() -> None:
    values = {n: x for n, x in VALUES.items() if n != "W"}
    angle = scene(BOTH).solve(VALUES)
    assert angle["theta"] == pytest.approx(acos(COSINE), rel=1e-12)
    found = {row.of for row in angle.rows if "N" in row.name or "theta" in row.name}
    assert found == {"steady_angle, motion 1", "N in steady_angle, motion 1"}
    (left,) = [row.value for row in angle.rows if row.name.startswith("steady_speed")]
    assert abs(left) < 1e-9  # at the root of one, the other's balance holds
    speed = scene(BOTH).solve(values | {"theta": acos(COSINE)})
    assert speed["W"] == pytest.approx(8.0, rel=1e-12)
    assert speed["N"] == pytest.approx(angle["N"], rel=1e-12)
    (root,) = scene(BOTH).roots(VALUES, "steady_angle")
    assert root["theta"] == pytest.approx(acos(COSINE), rel=1e-12)


@pytest.mark.long
def test_several_steady_motions_are_proved() -> None:
    assert proof(scene(BOTH).library).outcome == "holds"


@pytest.mark.long
def test_two_unknowns_are_found_by_two_balances_as_by_two_formulas() -> None:
    values = {"m": 0.7, "r": 0.25, "g": 9.8, "W": 8.0}
    by_balances = scene(DOUBLE).solve(values)
    each = {"unknown": ["a", "b"], "vanishes": ["a_ddot", "b_ddot"]}
    by_formulas = scene(DOUBLE, steady=each).solve(values | {"a_dot": 0, "b_dot": 0})
    for name in ("a", "b"):
        assert by_formulas[name] == pytest.approx(by_balances[name], rel=1e-9)
    assert abs(by_balances["a_ddot"]) < 1e-9  # of terms near 60


@pytest.mark.parametrize(
    ("document", "steady", "says"),
    [
        (DOUBLE, {"unknown": ["a", "b"], "vanishes": "a_ddot"},
         "steady.vanishes must be 2 formulas that vanish, one for each unknown, not 1"),
        (DOUBLE, {"unknown": "a", "vanishes": ["a_ddot", "b_ddot"]},
         "steady.vanishes must be 1 formula that vanishes, one for each unknown, not 2"),
        (DOUBLE, {"unknown": "a", "vanishes": []}, "1 formula that vanishes, one for each unknown"),
        (DOUBLE, {"unknown": "a", "slow": {"unknown": "b"}}, "steady has an unknown key 'slow'"),
        (DOUBLE, {"slow": {"unknown": "a"}},
         "wanted has 'steady', which needs [steady] with its unknown (known: steady_slow)"),
        (BOTH, {"angle": {"unknown": "theta"}}, "wanted has 'steady_speed', which is no answer"),
        (BOTH, {"angle": {}, "speed": {"unknown": "W"}}, "steady.angle needs 'unknown'"),
        (BOTH, {"angle": {"unknown": "q"}, "speed": {"unknown": "W"}},
         "steady.angle.unknown must be one of m, r, g, theta, theta_dot, W, not 'q'"),
        (BOTH, {"angle": {"unknown": []}, "speed": {"unknown": "W"}},
         "steady.angle.unknown is an empty list; it must name what is to be found"),
        (BOTH, {"a b": {"unknown": "W"}}, "a steady motion has the name 'a b'; a name is letters"),
    ],
)  # fmt: skip
def test_what_is_no_steady_motion_is_refused_by_one_sentence(
    document: dict[str, Any], steady: dict[str, Any], says: str
) -> None:
    with pytest.raises(SceneError) as refused:
        scene(document, steady=steady)
    assert says in str(refused.value)


def test_a_steady_motion_that_a_scene_does_not_have_has_no_roots() -> None:
    with pytest.raises(SceneError, match="steady must be one of steady_angle, steady_speed, not"):
        scene(BOTH).roots(VALUES)


def test_odd_tables_of_steady_motions_are_read_or_refused_in_one_sentence() -> None:
    speed = {"unknown": "W"}
    for odd in ODD:
        angle = {"unknown": "theta", "vanishes": odd}
        for own in ({"angle": odd, "speed": speed}, {"angle": {"unknown": odd}},
                    {"angle": angle, "speed": speed}):  # fmt: skip
            assert fault(written(BOTH | {"steady": own}), "odd", str) == ""


def test_steps_are_no_answer_of_a_steady_motion_and_the_example_leaves_one_unknown(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "hoop.toml"
    slower = {"speeds": {"W": {"unit": "rad/s", "range": [1, 20], "rate": 0}}}
    wanted = {"wanted": [*BOTH["wanted"], "step_rk4"]}
    file.write_text(written(BOTH | slower | wanted), encoding="utf-8")
    assert main(["solve", str(file)]) == 2
    (example,) = re.findall(r"for example: derive (solve .*)", capsys.readouterr().out)
    assert main(example.split()) == 0
    assert "steady_angle, motion 1" in capsys.readouterr().out


def test_a_root_at_zero_is_zero_and_its_motion_in_equilibrium() -> None:
    """A bead rests at the bottom of a hoop, which rounding misses by some 1e-23."""
    lower = {"coordinates": {"theta": {"unit": "rad", "range": [-0.3, 1.5]}}}
    wanted = ["steady_angle", "linearised"]
    answers = scene(BOTH, wanted=wanted, linearised={"theta": "theta"}, **lower).solve(VALUES)
    assert next(row.value for row in answers.rows if row.name == "theta") == 0.0
    assert answers.doubts == ()
