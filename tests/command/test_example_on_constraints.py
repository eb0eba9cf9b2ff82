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
