"""Machines that were hard once are checked as a whole, and in a time that somebody waits."""

from pathlib import Path

import pytest

from derive import load
from tests.scene.fuzzed import time_box

TRIALS = Path(__file__).parents[1] / "data" / "trials"
SECONDS, SAMPLES = 120, 256


@pytest.mark.long
@pytest.mark.whole
@pytest.mark.parametrize("name", ["straight_cat", "bent_cat", "quadrotor"])
def test_a_large_machine_is_checked_within_two_minutes(name: str, tmp_path: Path) -> None:
    with time_box(SECONDS):
        source = str(TRIALS / f"{name}.toml")
        found = list(load(source).check(tmp_path, SAMPLES))
    assert "holds" in {v.outcome for v in found}
    assert [v for v in found if v.outcome == "FAILS"] == []
