"""How numbers scatter: read by a grammar, drawn by a sequence that the member's number enters."""

import math
from pathlib import Path

import numpy as np
import pytest
from rich.progress import Progress

import derive
from derive.cli import main
from derive.command.sweep import follower
from derive.solve.sweep.design import Design
from derive.solve.sweep.summary import _influence
from derive.solve.sweep.vary import Spread
from tests.solve.sweep.swept_tops import HELD, swept_top

EACH = (Spread("a", "uniform", (1.0, 2.0)), Spread("b", "normal", (0.0, 2.0)),
        Spread("c", "loguniform", (1.0, 100.0)))  # fmt: skip
ROUNDING = 3e-3
"""Of the mean of 4096 quasi-random members, for which it falls about as one over their number."""


@pytest.mark.parametrize(("name", "text", "says"), [
    ("m", "uniform(2, 1)", "the first end is below the second, but 2 to 1"),
    ("m", "unifrom(1, 2)", "did you mean 'uniform'"),
    ("m", "normal(1, -1)", "a deviation is above zero"),
    ("m", "normal(1)", "normal takes mean and deviation"),
    ("m", "loguniform(-1, 2)", "above zero"),
    ("m", "0..1:none", "a whole number of values"),
    ("m", "__import__('os')", "it varies as one of"),
    ("m", "uniform(1deg, 2deg)", "the value is in kg, not in deg"),
    ("m", "uniform(-1e308, 1e308)", "what is between both ends must be a number"),
    ("m", "-1e308..1e308:3", "what is between both ends must be a number"),
    ("m", "loguniform(1e-200, 1e200)", "the second end must be a number of times the first"),
    ("m", "normal(0, 1, 60, 61)", "nothing of it that numbers can tell lies between 60 and 61 kg"),
    ("q", "uniform(1, 2)", "has no 'q' to set"),
    ("r", "uniform(1, 2)", "'r' is set and varies"),
])  # fmt: skip
def test_what_cannot_be_read_is_refused_in_a_sentence(
    name: str, text: str, says: str, tmp_path: Path
) -> None:
    with pytest.raises(derive.DeriveError) as refused:
        swept_top(tmp_path / "runs", vary={name: text})
    assert says in str(refused.value)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("option", "says"), [
    ({"vary": {"alpha": "uniform(0, 1)"}}, "'step_rk4' needs m, n: set it, or let it vary"),
    ({"keep": ["theta"]}, "'theta' is no state or answer that is known"),
    ({"keep": ["alpha@0.3"]}, "a time in s up to 0.2"),
    ({"keep": []}, "takes 1 to"),
    ({"pairs": 3}, "pairs must be a power of two"),
    ({"samples": 0}, "must be a whole number above zero"),
    ({"until": -1}, "until must be a number above zero"),
    ({"step": 1e-9}, "a member moves by at most 10,000,000 steps; 0.2 s at 1e-09 s are 2"),
    ({"stop": "alpha"}, "must be an equation"),
])  # fmt: skip
def test_what_makes_no_sense_is_refused_in_a_sentence(
    option: dict[str, object], says: str, tmp_path: Path
) -> None:
    with pytest.raises(derive.DeriveError) as refused:
        swept_top(tmp_path / "runs", **option)
    assert says in str(refused.value)
    assert list(tmp_path.iterdir()) == []


def test_a_rate_that_nobody_tells_begins_at_rest_and_a_warning_says_so(tmp_path: Path) -> None:
    told = {n: x for n, x in HELD.items() if not n.endswith("_dot")}
    own, usual = (swept_top(tmp_path / name, values=values, samples=20)
                  for name, values in (("rest", told), ("usual", HELD)))  # fmt: skip
    assert own.doubts[:2] == tuple(f"{name} is not told: members begin at rest in it"
                                   for name in ("alpha_dot", "beta_dot"))  # fmt: skip
    assert own.column("ended_at").tobytes() == usual.column("ended_at").tobytes()


def test_without_the_extra_the_command_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("derive.solve.sweep.request.find_spec", lambda _: None)
    told = ["sweep", "sleeping_top", "--vary", "m=uniform(1,2)", "--until", "1", "--keep", "alpha"]
    assert main([*told, "--out", str(tmp_path / "runs")]) == 2
    assert "pip install 'derive-eom[sweep]'" in capsys.readouterr().err


def test_time_left_is_told_by_what_this_run_did_alone() -> None:
    clock = [0.0]
    shown = Progress(get_time=lambda: clock[0], disable=True)
    told = follower(shown, "top")
    told("trying half the step", 0, 1000)
    clock[0] = 500.0
    for done in (600, 601, 602, 603):
        told("moving", done, 1000)
        clock[0] += 1
    assert shown.tasks[0].speed == 1.0
    assert shown.tasks[0].elapsed == 4.0
    assert (shown.tasks[0].completed, shown.tasks[0].total) == (603, 1000)


def test_the_number_of_a_member_alone_says_what_is_drawn_for_it() -> None:
    whole = Design(EACH, 1000, 64, 3)
    every = whole.values(0, whole.members)
    for first, count in ((0, 1), (17, 100), (990, 40), (1000, 7), (whole.members - 1, 1)):
        part = whole.values(first, count)
        for name, x in every.items():
            assert part[name].tobytes() == x[first : first + count].tobytes()


def test_draws_have_the_means_and_deviations_that_are_asked_for() -> None:
    drawn = Design(EACH, 4096, 0, 1).values(0, 4096)
    assert drawn["a"].mean() == pytest.approx(1.5, abs=ROUNDING)
    assert drawn["b"].std() == pytest.approx(2.0, abs=10 * ROUNDING)
    assert np.log(drawn["c"]).mean() == pytest.approx(np.log(10), abs=10 * ROUNDING)
    assert (drawn["a"].min() > 1, drawn["a"].max() < 2) == (True, True)


@pytest.mark.parametrize("mean", [-9.0, 0.0, 9.0, 30.0])
def test_what_is_cut_out_of_a_tail_scatters_as_it_does_there(mean: float) -> None:
    way = Spread("a", "normal", (mean, 1.0, 0.0, 1.0))
    drawn = way.values(np.array([0.01, 0.25, 0.5, 0.75, 0.99]))
    assert (np.diff(np.sort(drawn)) > 0).all()
    (low, middle, high) = (math.erfc(abs(x - mean) / math.sqrt(2)) / 2 for x in (0, drawn[2], 1))
    if abs(mean) > 1:
        assert middle == pytest.approx((low + high) / 2, rel=1e-6)


def test_grids_are_crossed_and_every_point_has_the_same_draws() -> None:
    of = Design((Spread("g", "grid", (0.0, 1.0), 3), Spread("h", "grid", (5.0, 6.0), 2), EACH[1]),
                10, 0, 1)  # fmt: skip
    assert of.members == 60
    found = of.values(0, 60)
    points = np.array([found["g"], found["h"]])[:, :6].T.tolist()
    assert points == [[0, 5], [0.5, 5], [1, 5], [0, 6], [0.5, 6], [1, 6]]
    assert (found["b"].reshape(10, 6) == found["b"][::6, None]).all()


def test_sensitivities_are_those_that_are_known_of_a_sum_and_a_product() -> None:
    uniform = tuple(Spread(n, "uniform", (-1.0, 1.0)) for n in "xyz")
    of = Design(uniform, 1, 2048, 5)
    v = of.values(1, of.members - 1)
    (found,) = _influence("column", 2 * v["x"] + v["y"] + 3 * v["y"] * v["z"], "xyz")
    # variances: 4/3, 1/3, 0 alone and 1 of the product, which is of y and z alike
    parts = {name: (first, total) for name, first, _, total, _ in found.rows}
    known = {"x": (0.5, 0.5), "y": (0.125, 0.5), "z": (0.0, 0.375)}
    for name, (first, total) in known.items():
        assert parts[name][0] == pytest.approx(first, abs=0.03)
        assert parts[name][1] == pytest.approx(total, abs=0.03)
