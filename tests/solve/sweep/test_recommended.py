"""The step of a sweep is found at members that are drawn, and keeps to its error at others.

What is stated is held against the lecture's equations in long floats, which no sweep uses.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import derive
from bench.sweep import examples
from derive.report.reference import end_of
from derive.solve.sweep import recommended
from derive.solve.sweep.design import Design
from derive.solve.sweep.judged import Gap, other_members, tried_members
from derive.solve.sweep.vary import Spread
from tests.solve.sweep.swept_tops import HELD, VARIED, swept_top
from tests.solve.sweep.test_sweep import columns

STATE = ("alpha", "beta", "alpha_dot", "beta_dot")
HARDER = 50.0
"""Times faster spins than those that a length is chosen by."""


def found(folder: Path, **more: Any) -> derive.Ensemble:
    """Return a sweep without an event, by a step that is found."""
    keep = [f"{name}@end" for name in STATE]
    told = {"step": None, "stop": None, "samples": 2000, "chunk": 2000, "keep": keep}
    return swept_top(folder, **told | more)


def worst_beside_the_lecture(own: derive.Ensemble, until: float) -> float:
    """Return the largest error of members that none was chosen by, from all places of a sweep."""
    library, table = derive.load("sleeping_top").library, columns(own)
    worst = 0.0
    for k in range(66, 2000, 125):
        values = HELD | {name: float(table[name][k]) for name in VARIED}
        end = end_of(library, values, until, 60.0)
        for name in STATE:
            size = 1.0 if name in ("alpha", "beta") else max(
                end.sizes[n] for n in ("alpha_dot", "beta_dot"))  # fmt: skip
            worst = max(worst, abs(table[f"{name}@end"][k] - end.state[name][0]) / size)
    return worst


@pytest.mark.long
@pytest.mark.parametrize("error", [1e-5, 1e-8])
def test_members_that_nobody_tried_keep_to_the_error(error: float, tmp_path: Path) -> None:
    own = found(tmp_path / "runs", error=error)
    worst = worst_beside_the_lecture(own, 0.2)
    assert error / 30 < worst < error  # no promise, and no waste: RK4 gains 16 by half the length


@pytest.mark.long
def test_a_length_that_is_not_judged_keeps_to_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recommended, "gap_between", lambda *_: Gap(0.0, 0, 1))
    assert worst_beside_the_lecture(found(tmp_path / "runs"), 0.2) > 1e-6


@pytest.mark.long
def test_a_length_is_shortened_until_it_keeps_to_the_error_at_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def easy(design: Design) -> Any:
        return {n: x / HARDER if n == "n" else x for n, x in tried_members(design).items()}

    fast = VARIED | {"n": "uniform(150, 200)"}
    usual = found(tmp_path / "usual", vary=fast)
    monkeypatch.setattr(recommended, "tried_members", easy)
    shortened = found(tmp_path / "shortened", vary=fast)
    monkeypatch.setattr(recommended, "other_members", easy)
    fooled = found(tmp_path / "fooled", vary=fast)
    assert worst_beside_the_lecture(usual, 0.2) < 1e-6
    assert worst_beside_the_lecture(shortened, 0.2) < 1e-6
    assert worst_beside_the_lecture(fooled, 0.2) > 1e-6


@pytest.mark.long
def test_a_step_that_is_cheaper_for_its_error_is_taken(tmp_path: Path) -> None:
    held = {"I_xx": 1.44, "I_yy": 1.64, "I_zz": 1.84, "omega_x": 1, "omega_y": 1,
            "attitude_w": 1, "attitude_x": 0, "attitude_y": 0, "attitude_z": 0}  # fmt: skip
    for error, step in ((1e-1, "step_split2"), (1e-10, "step_split6")):
        own = derive.load("tumbling_body").sweep(
            {"omega_z": "uniform(0.5, 1)"}, tmp_path / step, 2.0, ["omega@end"], held, 64,
            error=error, workers=1,
        )  # fmt: skip
        assert own.says.startswith(step)


@pytest.mark.long
def test_where_no_length_keeps_to_the_error_it_is_refused(tmp_path: Path) -> None:
    with pytest.raises(derive.DeriveError) as refused:
        found(tmp_path / "runs", error=1e-17)
    assert "over 0.2 s none of step_rk4 was seen to keep below 1e-17: the best keeps below" in str(
        refused.value
    )
    assert "--step sets a length all the same" in str(refused.value)


@pytest.mark.parametrize("spread", [
    (Spread("a", "uniform", (0.0, 1.0)),),
    (Spread("g", "grid", (0.0, 1.0), 1000), Spread("a", "uniform", (0.0, 1.0))),
])  # fmt: skip
def test_members_that_are_tried_are_from_all_places(spread: tuple[Spread, ...]) -> None:
    for samples in (1, 5, 100, 4000):
        design = Design(spread, samples, 0, 1)
        first, others = tried_members(design), other_members(design)
        assert {len(x) for x in first.values()} == {min(128, design.members)}
        assert {len(x) for x in others.values()} == {min(512, design.members)}
        if design.members > 640:
            each = zip(*(first.values()), strict=True), zip(*(others.values()), strict=True)
            assert {*each[0]}.isdisjoint(each[1])
            assert np.ptp(first["a"]) > 0.9 or samples < 100
            assert "g" not in first or np.ptp(first["g"]) > 0.9


@pytest.mark.long
def test_members_that_all_become_no_numbers_by_a_length_do_not_speak_for_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (scenes, _) = examples()[-1]
    (tmp_path / "damped.toml").write_text(scenes["damped.toml"], encoding="utf-8")
    tumbling = derive.load(str(tmp_path / "damped.toml"))
    vary = {"omega_x": "uniform(10, 20)", "omega_z": "uniform(10, 20)"}
    held = {"I_xx": 1.4, "I_yy": 1.6, "I_zz": 1.8, "damp": 0.01, "omega_y": 5, "attitude_w": 1,
            "attitude_x": 0, "attitude_y": 0, "attitude_z": 0}  # fmt: skip
    told: Any = (200.0, ["omega_x@end"], held, 300)
    assert tumbling.sweep(vary, tmp_path / "runs", *told, workers=1).ended == {"until": 300}
    monkeypatch.setattr(Gap, "is_judged", True)
    monkeypatch.setattr(recommended, "_gains", lambda _: True)
    assert tumbling.sweep(vary, tmp_path / "fooled", *told, workers=1).ended == {"not finite": 300}


def test_members_that_no_length_gives_an_end_are_told(tmp_path: Path) -> None:
    values = HELD | {"alpha": 0.1, "m": 0.5, "n": 40}
    del values["alpha_dot"]
    vary = {"alpha_dot": "0..1e200:5"}
    own = found(tmp_path / "runs", vary=vary, values=values, samples=1)
    assert own.ended == {"not finite": 4, "until": 1}
    assert own.says.endswith("4 of them become no numbers, by shorter steps neither")
