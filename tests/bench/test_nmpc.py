"""Predictive control by every way: they lead to one state, and a compiled horizon costs least."""

from pathlib import Path

import pytest

from bench import horizon, nmpc
from derive.library.library import library
from derive.scene import parse_scene

SAME = 1e-6
"""Of ends: one step normalises the quaternion, and the other keeps its length."""


@pytest.mark.long
@pytest.mark.parametrize("step", [horizon.runge_kutta, lambda rate, x, u: x + 0.05 * rate(x, -u)])
def test_every_way_is_a_row_for_each_solver_and_another_motion_is_noticed(
    step, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    same = step is horizon.runge_kutta
    monkeypatch.setattr(nmpc, "AHEAD", 4)
    monkeypatch.setattr(nmpc, "CYCLES", 2)
    monkeypatch.setattr(horizon, "runge_kutta", step)
    monkeypatch.setattr("sys.argv", ["nmpc"])
    monkeypatch.setenv("XDG_CACHE_HOME", "")
    assert nmpc.main() == 0
    head, _, *rows = capsys.readouterr().out.splitlines()
    assert [row.split()[0] for row in rows] == ["ipopt"] * 6 + ["fatrop"] * 6
    assert (float(head.split()[-2]) < SAME) == same


@pytest.mark.long
def test_a_horizon_in_one_call_takes_a_quarter_of_what_the_plain_loop_takes(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(nmpc, "CYCLES", 10)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    module = horizon.written(library(parse_scene(horizon.SCENE, "body")), tmp_path)
    first, *_, last = horizon.ways(module, nmpc.AHEAD)
    plain, ours = (nmpc.flown(way, "ipopt", module.external(1)) for way in (first, last))
    assert (plain.way, ours.way) == (horizon.PLAIN, "external of the horizon")
    assert ours.cycle < plain.cycle / 4
