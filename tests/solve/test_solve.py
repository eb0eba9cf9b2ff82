"""``derive solve`` answers, finds roots and limits, moves in time, and says what it still needs."""

import os
import tomllib
from math import pi
from pathlib import Path

import pytest

import derive
from derive import Handle, load
from derive.cli import main
from derive.scene import CATALOGUE, SceneError, catalogue
from derive.solve.lacking import advice_on
from derive.solve.settings import settings
from derive.solve.simulation import plot_of
from tests.made import thinned

TOP = {"m": 0.5, "r": 0.05, "l": 0.06, "g": 9.81, "n": 120.0}
START = {"alpha": 0.1, "beta": 0.0, "alpha_dot": 0.0, "beta_dot": 0.0}


def top() -> Handle:
    return load("sleeping_top")


def test_an_answer_is_printed_with_its_unit(capsys: pytest.CaptureFixture[str]) -> None:
    data = ["m=1200", "r=0.6", "L=0.9", "g=9.81", "W=3.2"]
    assert main(["solve", "edge_runner_flat", "--set", *data]) == 0
    text = capsys.readouterr().out
    assert "15458.4" in text
    assert " N " in text


def test_what_is_missing_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "edge_runner_flat", "--set", "m=1200"]) == 2
    assert "'N' needs r, g, W" in " ".join(capsys.readouterr().err.split())


def test_what_can_be_answered_is_shown_before_what_cannot(
    capsys: pytest.CaptureFixture[str],
) -> None:
    data = [f"{name}={value}" for name, value in TOP.items()]
    assert main(["solve", "sleeping_top", "--set", *data]) == 2
    shown = capsys.readouterr()
    assert "31.0104916028" in shown.out
    assert "'energy' needs alpha, alpha_dot, beta, beta_dot" in " ".join(shown.err.split())


REFUSED = {
    "step must be a positive number of seconds, not 0.0": ["--until=1", "--step=0"],
    "step must be a positive number of seconds, not -0.1": ["--until=1", "--step=-0.1"],
    "--step: must be a number of seconds, as 0.5, not 'nan'": ["--until=1", "--step=nan"],
    "--until: must be a number of seconds, as 0.5, not 'nan'": ["--until=nan"],
    "--until: must be a number of seconds, as 0.5, not 'inf'": ["--until=inf"],
    "until must be a number of seconds from 0 up, not -1.0": ["--until=-1"],
    "until must be at most 10,000,000 steps": ["--until=1e9"],
    "must stay finite, but": ["--until=1", "--step=1", "--set", "alpha_dot=1e200"],
    "output file '/nonexistent/x.svg' must be writable": [
        "--until=0.1",
        "--plot=/nonexistent/x.svg",
    ],
    "--plot x.svg: a plot shows a motion and needs --until": ["--plot=x.svg"],
    "--limit n: limits of stability are no motion": ["--limit=n", "--until=1"],
    "--step 0.1: a step is of a motion and needs --until": ["--step=0.1"],
    "m=1deg: the value is in kg, not in deg": ["--set", "m=1deg"],
    "alpha=1rpm: the value is in rad, not in rpm": ["--set", "alpha=1rpm"],
    "m=nan: a value is a finite number": ["--set", "m=nan"],
    "m=-infdeg: a value is a finite number": ["--set", "m=-infdeg"],
    "body 'disc'.mass must be positive, and is not so at m = 0": ["--set", "m=0"],
}


@pytest.mark.parametrize("sentence", thinned(REFUSED, 3))
def test_what_makes_no_sense_is_refused_in_one_sentence(
    sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    told = REFUSED[sentence]
    own = [text.partition("=")[0] for text in told]
    data = [f"{n}={value}" for n, value in (TOP | START).items() if n not in own]
    assert main(["solve", "sleeping_top", "--set", *data, *told]) == 2
    assert sentence in " ".join(capsys.readouterr().err.split())


def test_a_limit_needs_small_motion(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "edge_runner_flat", "--limit", "W"]) == 2
    assert "small motion needs a free coordinate" in " ".join(capsys.readouterr().err.split())


def test_a_name_that_the_scene_does_not_have_is_refused_with_a_hint() -> None:
    with pytest.raises(SceneError, match=r"has no 'alhpa' to set \(did you mean 'alpha'"):
        top().solve({"alhpa": 1})
    with pytest.raises(SceneError, match="a value is a finite number"):
        top().solve({"alpha": "much"})


def test_degrees_and_turns_a_minute_may_be_set() -> None:
    found = settings("top", top().quantities, {"alpha": "3deg", "n": "60rpm"})
    assert found == {"alpha": pytest.approx(pi / 60), "n": pytest.approx(2 * pi)}


@pytest.mark.long
def test_every_root_and_every_limit_is_listed(capsys: pytest.CaptureFixture[str]) -> None:
    data = ["m=0.5", "r=0.05", "l=0.06", "g=9.81"]
    assert main(["solve", "top_steady_precession", "--set", *data, "n=250", "theta=30deg"]) == 0
    text = capsys.readouterr().out
    assert "1.92699803071" in text
    assert "83.479846524" in text
    assert main(["solve", "sleeping_top", "--set", *data, "--limit", "n"]) == 0
    assert "79.7890819598" in capsys.readouterr().out


@pytest.mark.long
def test_a_limit_that_is_nowhere_is_said_to_be(capsys: pytest.CaptureFixture[str]) -> None:
    data = ["m=0.5", "r=0.05", "l=0.06", "g=9.81", "n=150"]
    assert main(["solve", "sleeping_top", "--set", *data, "--limit", "alpha"]) == 0
    assert "none in its range" in capsys.readouterr().out


@pytest.mark.parametrize(("step", "count"), [(3e-3, 4), (0.05, 1), (1e-3, 10)])
def test_a_motion_ends_when_it_is_asked_to(step: float, count: int) -> None:
    motion = top().simulate(TOP | START, 0.01, step)
    assert motion.times[-1] == pytest.approx(0.01, abs=1e-15)
    assert len(motion.times) - 1 == count


def test_a_motion_keeps_its_energy_and_is_plotted(tmp_path: Path) -> None:
    motion = top().simulate(TOP | START, 1.0, 1e-3)
    ends = [{name: row[k] for name, row in motion.states.items()} for k in (0, -1)]
    first, last = (top().solve(TOP | end)["energy"] for end in ends)
    assert last == pytest.approx(first, rel=1e-8)
    assert plot_of(motion).count("<polyline") == len(START)
    target = tmp_path / "top.svg"
    data = [f"{name}={value}" for name, value in (TOP | START).items()]
    command = ["solve", "sleeping_top", "--set", *data, "--until", "0.1", "--plot", str(target)]
    assert main(command) == 0
    assert target.read_text(encoding="utf-8").startswith("<svg")


def test_a_value_that_is_set_twice_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "sleeping_top", "--set", "m=1", "--set", "m=2"]) == 2
    assert "--set m=2: 'm' is set twice" in capsys.readouterr().err


def test_a_plot_replaces_no_scene_and_nothing_but_a_regular_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = ("own.toml", "pipe", "linked.svg", "other.toml")
    scene, pipe, linked, other = (tmp_path / name for name in names)
    other.write_text('wanted = ["acceleration"]\n')
    scene.write_text((CATALOGUE / "sleeping_top.toml").read_text(encoding="utf-8"))
    os.mkfifo(pipe)
    linked.symlink_to(scene)
    before = scene.read_bytes()
    data = [f"{name}={value}" for name, value in (TOP | START).items()]
    for file in (scene, linked, pipe, other, tmp_path, tmp_path / ("x" * 300)):
        command = ["solve", str(scene), "--set", *data, "--until=0.1", f"--plot={file}"]
        assert main(command) == 2
        assert "derive: " in capsys.readouterr().err
    assert scene.read_bytes() == before
    assert other.read_text() == 'wanted = ["acceleration"]\n'
    assert pipe.is_fifo()
    assert linked.is_symlink()


def test_a_motion_needs_a_step_and_a_start() -> None:
    with pytest.raises(SceneError, match="begins at alpha, alpha_dot, beta, beta_dot"):
        top().simulate(TOP, 1.0, 1e-3)
    with pytest.raises(SceneError, match="needs a free coordinate or speed, and here none is"):
        load("edge_runner_flat").simulate({}, 1.0, 1e-3)


def test_a_motion_outside_of_the_declared_ranges_is_doubted(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert top().simulate(TOP | START, 0.01).doubts == ()
    far = top().simulate(TOP | START | {"m": 50, "alpha_dot": 300.0}, 0.01).doubts
    assert "m is 50 kg, outside of its range, 0.4 to 0.6" in far
    assert any(says.startswith("alpha_dot is 300 rad/s, outside") for says in far)
    assert any(says.startswith("alpha is ") and " after 0." in says for says in far)
    data = [f"{name}={value}" for name, value in (TOP | START | {"m": 50}).items()]
    assert main(["solve", "sleeping_top", "--set", *data, "--until", "0.01"]) == 0
    assert "warning: m is 50 kg, outside of its range" in capsys.readouterr().err


def followed(name: str, function: str) -> tuple[str, str]:
    """Return what a scene is advised to say for a function, and what it says if it does."""
    document = tomllib.loads((CATALOGUE / f"{name}.toml").read_text(encoding="utf-8"))
    scene = load(name)
    advice = advice_on(scene.scene, function, "it")
    try:
        _ = load(document | {"wanted": [function]}, name).library
    except SceneError as error:
        return advice, str(error)
    return advice, ""


ADVISED = [
    (name, function)
    for name in catalogue()
    for function in ("linearised", "step_rk4")
    if f'"{function}"' not in (CATALOGUE / f"{name}.toml").read_text(encoding="utf-8")
]
QUICK = [("heavy_top", "linearised"), ("attitude", "step_rk4"), ("edge_runner_flat", "step_rk4"),
         ("rotor_on_turning_axes", "step_rk4")]  # fmt: skip


@pytest.mark.parametrize(
    "case",
    [pytest.param(case, marks=() if case in QUICK else pytest.mark.long) for case in ADVISED],
)
def test_advice_can_be_followed_and_is_given_where_it_can(case: tuple[str, str]) -> None:
    advice, refused = followed(*case)
    assert (f'wanted = [..., "{case[1]}"]' in advice) == (refused == "")


def test_what_only_machines_have_is_not_advised_to_one_body() -> None:
    ball = load({"wanted": ["moment"], "body": {"kind": "spherical", "moment": 0.4}}, "ball")
    for ask in (ball.frequencies, ball.roots):
        with pytest.raises(SceneError, match="is of machines, and this scene is not written as"):
            ask({})


@pytest.mark.long
def test_no_answer_is_a_zero_with_a_sign(capsys: pytest.CaptureFixture[str]) -> None:
    still = dict.fromkeys(("x", "x_dot", "theta", "theta_dot", "F"), 0.0)
    cart = {"M": 0.5, "m": 0.2, "l": 0.3, "I": 0.006, "b": 0.1, "g": 9.8} | still
    assert not [row for row in load("cart_pendulum").solve(cart).rows if str(row.value) == "-0.0"]
    data = [f"{name}={value}" for name, value in (cart | {"theta": -0.0}).items()]
    for more in (["--limit=b"], ["--until=0.01"]):
        assert main(["solve", "cart_pendulum", "--set", *data, *more]) == 0
        assert " -0 " not in capsys.readouterr().out


def test_an_answer_of_two_functions_has_its_value_and_none_a_sentence() -> None:
    wanted = {"wanted": ["acceleration", "acceleration_jacobian"]}
    body = {"kind": "principal", "moments": ["A", "B", "C"]}
    each = {n: {"unit": "kg m^2", "range": [1, 2]} for n in "ABC"}
    scene = derive.load(wanted | {"parameters": each, "body": body}, name="both")
    given = {"A": 1, "B": 1.5, "C": 2, "omega_x": 1, "omega_y": 2, "omega_z": 3}
    moments = {f"moment_{c}": 0 for c in "xyz"}
    found = scene.solve(given | moments)
    assert found["omega_dot_x"] == (1.5 - 2) * 2 * 3 / 1
    with pytest.raises(derive.DeriveError, match=r"^'nosuch' has no answer$"):
        found["nosuch"]
