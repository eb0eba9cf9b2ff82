"""A motion ends where an equation is met first, to a rounding of its time; what is none is refused.

The pendulum of no gravity turns as it started, so that every event has a time in closed form.
"""

from pathlib import Path

import pytest

from derive import Handle, load
from derive.cli import main
from derive.scene import SceneError
from derive.solve.simulation import plot_of
from tests.solve.test_junk import JUNK

TURNING = {
    "wanted": ["step_rk4", "kinetic_energy", "height"],
    "parameters": {"m": {"unit": "kg", "range": [1, 2]}},
    "coordinates": {"q": {"unit": "rad", "range": [-9, 9], "rate": {"range": [-4, 4]}}},
    "frames": {"arm": {"turned": ["x q"]}},
    "bodies": {"bob": {"frame": "arm", "shape": "point", "mass": "m", "centre": [0, 0, -1]}},
    "loads": {"pin": {"on": "bob", "force": "?pin", "couple": [0, "?b", "?c"]}},
    "results": {"height": "1 - cos(q)"},
}
START = {"m": 1.5, "q": -0.25, "q_dot": 2.0}


def turning() -> Handle:
    return load(TURNING, "turning")


@pytest.mark.parametrize(
    ("stop", "time"),
    [("q = 0", 0.125), ("q=1", 0.625), ("q/2 = q - 0.5", 0.625), ("height = 1", 0.910398163),
     ("2*q = pi", 0.910398163), ("tan(q) = 0", 0.125),
     ("(q - 0.5)*(q - 0.5) = 0.0001", 0.37), ("1 - height = 0.9999", 0.117928873)],
)  # fmt: skip
@pytest.mark.parametrize("step", [0.1, 0.0625])
def test_a_motion_stops_where_an_equation_holds_first(stop: str, time: float, step: float) -> None:
    """A whole step that ends there, as 0.0625 does of q = 0, is met as any other.

    So is what holds twice within a step: near q = 0.5, and around the lowest place.
    """
    motion = turning().simulate(START, 3, step, stop=stop)
    assert motion.times[-1] == pytest.approx(time, abs=1e-9)
    assert motion.states["q"][-1] == pytest.approx(-0.25 + 2 * time, abs=1e-9)
    assert len(motion.times) == len(motion.states["q"])
    assert motion.doubts == ()


def test_a_pole_is_no_event_and_neither_is_the_start() -> None:
    motion = turning().simulate(START, 1.4, 0.01, stop="tan(q - 0.5) = 0.0000001")
    assert motion.states["q"][-1] == pytest.approx(0.5, abs=1e-6)
    over = turning().simulate(START | {"q": 1.0}, 0.9, 0.01, stop="tan(q) = 0")
    assert over.times[-1] == pytest.approx(0.9)
    assert over.doubts == ("'tan(q) = 0' is not met by 0.9 s",)
    still = turning().simulate(START | {"q": 0.0}, 0.5, 0.01, stop="q = 0")
    assert still.doubts == ("'q = 0' is not met by 0.5 s",)


@pytest.mark.parametrize(
    ("stop", "says"),
    [
        ("q", "stop must be an equation such as 'theta = 0', not 'q'"),
        ("q = 0 = 0", "must be an equation"),
        ("q = (", "= '(': at 2: expected a number"),
        ("q = m", "stop: 'q' is in 1, but 'm' in kg"),
        ("q = x", "stop uses 'x', which the scene does not declare"),
        ("m = 1.2", "stop 'm = 1.2' holds nothing that changes on the way"),
        ("q = q", "stop 'q = q' holds nothing that changes on the way"),
        ("q = __import__('os')", "is no part of a formula"),
    ],
)
def test_what_is_no_event_is_refused_in_one_sentence(
    stop: str, says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SceneError) as refused:
        turning().simulate(START, 1.0, 0.01, stop=stop)
    assert says in str(refused.value)
    data = ["m=0.5", "r=0.05", "l=0.06", "g=9.81", "n=99", "alpha=0", "beta=0", "alpha_dot=1"]
    command = ["solve", "sleeping_top", "--set", *data, "beta_dot=0", "--until=0.1"]
    assert main([*command, f"--stop={stop}"]) == 2
    assert len(capsys.readouterr().err) < 300


@pytest.mark.parametrize("kind", sorted(JUNK.keys() - {"none"}))
def test_junk_is_no_event(kind: str) -> None:
    with pytest.raises(SceneError) as refused:
        turning().simulate(START, 1.0, 0.01, stop=JUNK[kind])
    assert len(str(refused.value)) < 250


def test_an_event_needs_a_motion(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "sleeping_top", "--stop", "alpha = 0"]) == 2
    assert "an event ends a motion and needs --until" in " ".join(capsys.readouterr().err.split())


@pytest.mark.parametrize(
    ("until", "marks"), [(0.5, ["0", "0.05", "0.5"]), (3, ["0", "0.5", "3"]), (0.0, ["0"])]
)
def test_a_plot_has_round_times_on_its_axis(until: float, marks: list[str], tmp_path: Path) -> None:
    drawn = plot_of(turning().simulate(START, until, 0.01))
    for mark in marks:
        assert f">{mark}</text>" in drawn
    assert 1 <= drawn.count('class="t"') <= 11
    assert ">t, s</text>" in drawn
