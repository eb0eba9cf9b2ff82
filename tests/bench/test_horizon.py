"""The measurement of a horizon's derivatives has a row a way, and their derivatives agree."""

import re

import pytest

from bench import control, horizon, nmpc

CLOSE = 1e-13
"""As `derive check` has it: some hundreds of roundings."""


@pytest.mark.long
def test_every_way_is_timed_and_what_is_ours_agrees(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(horizon, "N", 3)
    monkeypatch.setattr(horizon, "ROUNDS", 1)
    monkeypatch.setattr(horizon, "CALLS", 2)
    monkeypatch.setattr(nmpc, "main", lambda: 0)
    monkeypatch.setattr("sys.argv", ["control"])
    monkeypatch.setenv("XDG_CACHE_HOME", "")
    assert control.main() == 0
    rows = [line for line in capsys.readouterr().out.splitlines() if line.startswith(" ")][1:]
    assert len(rows) == 7
    ours = [row.split()[-1] for row in rows if re.match(r" (emitted|external)", row)]
    assert len(ours) == 3
    assert all(float(gap) < CLOSE for gap in ours)
