"""Events of members: met in the step that holds them, also where they come and go within one.

The pendulum of no gravity turns as it started, so that every event has a time in closed form.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import derive
from derive.cli import main
from derive.solve import crossing
from derive.solve.sweep import course
from derive.solve.sweep.store import parts_of
from tests.solve.test_event import turning

HELD = {"m": 1.5, "q_dot": 2.0}
VARY = {"q": "uniform(-0.4, 0.4)"}
GRAZES, BRIEFLY = "(q - 0.5)*(q - 0.5) = 0.0001", 0.49
"""For a hundredth of a second, and where it begins."""
ROUNDED = 1e-12


def swept(folder: Path, stop: str, step: float, **more: Any) -> derive.Ensemble:
    told: dict[str, Any] = {"samples": 300, "instants": 4, "workers": 1, "until": 1.0}
    keep = ["q", "q@end", "q@max", "q@0.333"]
    return turning().sweep(VARY, folder / "runs", keep=keep, values=HELD, stop=stop, step=step,
                           **told | more)  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize(("stop", "at"), [(GRAZES, BRIEFLY), ("q = 0.5", 0.5)])
@pytest.mark.parametrize("step", [0.25, 0.0625, 0.01])
def test_a_member_stops_where_an_equation_holds_first(
    stop: str, at: float, step: float, tmp_path: Path
) -> None:
    own = swept(tmp_path, stop, step)
    start, time = own.column("q"), own.column("ended_at")
    assert own.ended == {"stop": 300}
    assert np.abs(time - (at - start) / 2).max() < ROUNDED
    assert np.abs(own.column("q@end") - at).max() < ROUNDED
    assert np.abs(own.column("q@max") - at).max() < ROUNDED
    for column, times in (("q@course", np.arange(5) / 4), ("q@0.333", np.array([0.333]))):
        kept = own.column(column).reshape(300, -1)
        assert (np.isfinite(kept) == (times <= time[:, None])).all()
        assert np.nanmax(np.abs(kept - start[:, None] - 2 * times)) < ROUNDED


@pytest.mark.long
@pytest.mark.parametrize(("until", "start"), [(0.5, "uniform(0.41, 0.48)"),
                                              (0.25, "uniform(0.02, 0.09)")])  # fmt: skip
def test_what_comes_and_goes_in_the_first_or_last_step_is_met(
    until: float, start: str, tmp_path: Path
) -> None:
    vary = {"q": start}
    own = turning().sweep(vary, tmp_path / "runs", until, ["q@end"], HELD, 100, stop=GRAZES,
                          step=0.25, workers=1)  # fmt: skip
    assert own.ended == {"stop": 100}


def test_what_turns_back_before_it_holds_is_no_event(tmp_path: Path) -> None:
    own = swept(tmp_path, "(q - 0.5)*(q - 0.5) = -0.0001", 0.0625)
    assert own.ended == {"until": 300}
    assert np.isfinite(own.column("q@course")).all()


def test_without_a_look_at_turns_members_pass_through(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(course, "turn_back", lambda *three: np.zeros(len(three[0]), bool))
    assert swept(tmp_path, GRAZES, 0.0625).ended["until"] > 100


def test_a_turn_that_is_not_followed_to_its_lowest_is_missed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(crossing, "TURNS", 1)
    assert swept(tmp_path, GRAZES, 0.25).ended["until"] > 50


@pytest.mark.parametrize("stop", [GRAZES, "q = 0.5", "tan(q - 0.5) = 0.0000001"])
def test_a_member_ends_with_the_bits_of_simulate(stop: str, tmp_path: Path) -> None:
    own = swept(tmp_path, stop, 0.0625)
    for k in (0, 7, 299):
        motion = turning().simulate(HELD | {"q": float(own.column("q")[k])}, 1.0, 0.0625, stop=stop)
        assert motion.times[-1] == own.column("ended_at")[k]
        assert motion.states["q"][-1] == own.column("q@end")[k]


def test_a_pole_is_no_event_of_a_member_and_what_follows_it_is(tmp_path: Path) -> None:
    own = swept(tmp_path, "1/(q - 0.45) = 20", 0.02)
    assert own.ended == {"stop": 300}
    assert np.abs(own.column("q@end") - 0.5).max() < ROUNDED


def test_an_event_without_any_value_is_refused_in_a_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    says = "stop 'sqrt(-1 - q*q) = 0' has no value anywhere on the way"
    with pytest.raises(derive.DeriveError, match="has no value anywhere") as refused:
        swept(tmp_path, "sqrt(-1 - q*q) = 0", 0.01)
    assert str(refused.value) == f"scene 'turning': {says}"
    assert parts_of(tmp_path / "runs") == {}
    with pytest.raises(derive.DeriveError) as refused:
        turning().simulate(HELD | {"q": 0.1}, 1.0, 0.01, stop="sqrt(-1 - q*q) = 0")
    assert str(refused.value) == f"scene 'turning': {says}"
    data = ["m=0.5", "r=0.05", "l=0.06", "g=9.81", "n=99", "alpha=0.1", "beta=0", "alpha_dot=0"]
    told = ["solve", "sleeping_top", "--set", *data, "beta_dot=0", "--until=0.01"]
    assert main([*told, "--stop", "sqrt(-alpha) = 0"]) == 2
    assert "has no value anywhere on the way" in " ".join(capsys.readouterr().err.split())
