"""The example that asks for values begins where the constraints of a machine hold."""

import re
from pathlib import Path

import pytest

from derive.cli import main
from derive.command import solve

RING = """
wanted = ["accelerations", "constraint_distances"]
parameters.r = { unit = "m", range = [0.5, 1] }
parameters.m = { unit = "kg", range = [1, 2] }
coordinates.x = { unit = "m", range = [0, 2] }
coordinates.y = { unit = "m", range = [-2, 2] }
frames.bead.origin = ["x", "y", "0"]
bodies.bead = { frame = "bead", shape = "point", mass = "m" }
loads.plane = { on = "bead", force = ["0", "1", "?N"] }
constraints.ring = { zero = "x^2 + y^2 - r^2" }
"""


def example(tmp_path: Path, text: str, capsys: pytest.CaptureFixture[str]) -> dict[str, float]:
    file = tmp_path / "ring.toml"
    file.write_text(text, encoding="utf-8")
    assert main(["solve", str(file)]) == 2
    (shown,) = re.findall(r"for example: derive (solve .*)", capsys.readouterr().out)
    assert main(shown.split()) == 0
    pairs = (part.split("=") for part in shown.split()[3:])
    return {name: float(x) for name, x in pairs}


def test_an_example_fulfils_the_constraints(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    own = example(tmp_path, RING, capsys)
    assert own["x"] ** 2 + own["y"] ** 2 == pytest.approx(own["r"] ** 2, rel=1e-8)
    monkeypatch.setattr(solve, "held_example", lambda _, values: values)
    own = example(tmp_path, RING, capsys)
    assert (own["x"], own["y"], own["r"]) == (1, 0, 0.75)


def test_an_example_is_on_constraints_that_no_way_leads_to_from_the_middle(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = example(tmp_path, RING.replace("range = [0, 2]", "range = [-2, 2]"), capsys)
    assert own["x"] ** 2 + own["y"] ** 2 == pytest.approx(own["r"] ** 2, rel=1e-8)


def test_a_start_that_no_way_leads_from_is_refused_with_one_that_may_be_pasted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "ring.toml"
    wanted = '"step_rk4", "accelerations"'
    file.write_text(RING.replace('"accelerations"', wanted), encoding="utf-8")
    start = ["solve", str(file), "--set", "r=1", "m=1"]
    middle = ["x=0", "y=0", "x_dot=0", "y_dot=0"]
    assert main([*start, *middle, "--until", "0.1"]) == 2
    said = " ".join(capsys.readouterr().err.split())
    (state,) = re.findall(r"not -1; a state that fulfils all is (\S+, .*)", said)
    assert main([*start, *state.split(", "), "--until", "0.1"]) == 0
