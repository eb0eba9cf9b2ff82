"""A root of steady motion is carried into every other answer, and into small motion about it."""

from math import acos, cos, sin

import pytest

from derive import Handle, load
from derive.check import proof
from derive.cli import main
from derive.command.solve import example
from derive.scene import SceneError
from tests.made import thinned

HOOP = {
    "wanted": ["steady", "linearised", "N", "weight"],
    "parameters": {
        "m": {"unit": "kg", "range": [0.5, 1]},
        "r": {"unit": "m", "range": [0.2, 0.3]},
        "g": {"unit": "m/s^2", "range": [9.7, 9.9]},
    },
    "speeds": {"W": {"unit": "rad/s", "range": [1, 50], "rate": 0}},
    "coordinates": {"theta": {"unit": "rad", "range": [0.3, 1.5]}},
    "frames": {
        "hoop": {"angular_velocity": [0, 0, "W"]},
        "arm": {"parent": "hoop", "turned": ["y theta"]},
    },
    "bodies": {"bead": {"frame": "arm", "shape": "point", "mass": "m", "centre": [0, 0, "-r"]}},
    "loads": {
        "weight": {"gravity": [0, 0, "-g"], "along": "hoop"},
        "held": {"on": "bead", "force": ["?X", "?Y", "?N"], "couple": ["?A", 0, "?C"]},
    },
    "results": {"weight": "m*g"},
    "linearised": {"theta": "theta"},
    "steady": {"unknown": "theta"},
}
"""A bead on a hoop that turns: where does it rest, and how does it swing there?"""
VALUES = {"m": 0.7, "r": 0.25, "g": 9.8, "W": 8.0}


def hoop(**changed: object) -> Handle:
    return load(HOOP | changed, "hoop")


def test_a_bead_rests_swings_and_presses_as_its_balance_says() -> None:
    found = hoop().solve(VALUES)
    assert found.unanswered == {}
    assert found.doubts == ()  # at a root the state is an equilibrium
    cosine = 9.8 / (8.0**2 * 0.25)
    theta = acos(cosine)
    assert found["theta"] == pytest.approx(theta, rel=1e-12)
    assert found["frequency 1"] == pytest.approx(8.0 * sin(theta), rel=1e-9)
    pressing = 0.7 * (9.8 * cosine + 64 * 0.25 * sin(theta) ** 2)
    assert found["N"] == pytest.approx(pressing, rel=1e-12)
    where = {row.name: row.of for row in found.rows}
    assert where["N"] == "N in steady motion 1"
    assert where["weight"] == "weight"  # which no root changes


def test_every_one_of_several_roots_is_carried() -> None:
    found = load("top_steady_precession").solve(
        {"m": 0.5, "r": 0.05, "l": 0.06, "g": 9.81, "n": 250, "theta": 0.5}
    )
    assert len(found.all("W")) == 2
    both = hoop(steady={"unknown": "W"}, linearised={"theta": "theta"})
    speed = (9.8 / (0.25 * 0.6125)) ** 0.5
    told = both.solve({"m": 0.7, "r": 0.25, "g": 9.8, "theta": acos(0.6125)})
    assert told["W"] == pytest.approx(speed, rel=1e-12)
    assert told["frequency 1"] == pytest.approx(speed * sin(acos(0.6125)), rel=1e-9)


def test_what_is_no_equilibrium_is_doubted_where_it_is_set_and_not_before() -> None:
    assert hoop().scene.warnings == ()
    apart = hoop(steady={"unknown": "theta", "vanishes": "theta - 1.2"})
    for found in (hoop().solve(VALUES | {"theta": 1.2}), apart.solve(VALUES)):
        (doubt,) = found.doubts
        assert "about a state that is no equilibrium" in doubt


def test_a_steady_motion_that_is_nowhere_is_said_to_be(capsys: pytest.CaptureFixture[str]) -> None:
    found = hoop().solve(VALUES | {"W": 2.0})
    assert found.doubts == ("no steady motion was found in the declared range of 'theta'",)
    assert found.unanswered["N"] == ("theta", "theta_dot")
    assert "steady" not in found.unanswered
    assert main(["solve", "eulers_disk", "--set", "m=0.4", "r=0.04", "tilt=0.2"]) == 2
    assert "'spin_rel' needs tilt, W" not in capsys.readouterr().err


@pytest.mark.long
def test_small_motion_about_an_argument_is_proved() -> None:
    assert proof(hoop().library).outcome == "holds"


@pytest.mark.parametrize(
    ("value", "says"),
    [
        ("theta + 0", "linearised.theta uses 'theta', free, and not known; only what is given"),
        ("theta_dot", "linearised.theta uses 'theta_dot', free, and not known; only what is"),
        ("W", "linearised.theta = 'W' is in rad/s, not 1"),
    ],
)
def test_what_is_small_stands_for_itself_alone_or_is_given(value: str, says: str) -> None:
    with pytest.raises(SceneError) as refused:
        hoop(linearised={"theta": value})
    assert says in str(refused.value)


@pytest.mark.parametrize("name", thinned(["sleeping_top", "eulers_disk", "quadrotor"], 2))
def test_a_scene_without_values_shows_ranges_and_an_example_that_is_answered(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["solve", name]) == 2
    shown = capsys.readouterr()
    assert "set values by --set, as the example does" in " ".join(shown.err.split())
    table, _, pasted = shown.out.partition("for example: derive ")
    for q in load(name).quantities:
        assert q.meaning.split(",")[0] in table
    assert main(pasted.split()) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("low", "high", "shown"),
    [(0.4, 0.6, "0.5"), (20, 200, "110"), (-1, 1, "0"), (1.23456789, 1.23456791, "1.2345679")],
)
def test_an_example_is_short_and_lies_in_its_range(low: float, high: float, shown: str) -> None:
    assert example(low, high, "") == shown
    assert [example(-1, 1, f"q_{part}") for part in "wxyz"] == ["1", "0", "0", "0"]


@pytest.mark.long
def test_roots_are_carried_into_frequencies_and_limits_of_stability() -> None:
    (frequency,) = hoop().frequencies(VALUES)
    assert frequency == pytest.approx(8.0 * sin(acos(0.6125)), rel=1e-9)
    assert hoop().growth(VALUES) == 0
    whole = hoop(coordinates={"theta": {"unit": "rad", "range": [-1.5, 1.5]}})
    still = {name: value for name, value in VALUES.items() if name != "W"}
    ends = [(9.8 / 0.25) ** 0.5, (9.8 / (0.25 * cos(1.5))) ** 0.5]
    assert whole.limits(still, "W") == pytest.approx(ends, rel=1e-5)
    with pytest.raises(SceneError, match="one steady motion; with these values there are 3"):
        whole.frequencies(VALUES)
    with pytest.raises(SceneError, match="there are 0"):
        hoop().frequencies(VALUES | {"W": 1.0})
