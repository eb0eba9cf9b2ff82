"""What makes no sense is refused by one sentence, before anything is solved."""

import os
import signal

import pytest

import derive
from derive.cli import main
from derive.control.direct import quietly
from tests.control.crafts import craft, inertia

COST = {"energy": 1}
REFUSED = [
    ({}, "nothing is to be reached"),
    ({"turn": "z"}, 'a turn is an axis and an angle, as "z 180deg"'),
    ({"turn": "q 1"}, "an axis is x, y, z or three numbers as 1,2,2, not all 0, not 'q'"),
    ({"turn": "0,0,0 1"}, "an axis is x, y, z or three numbers"),
    ({"turn": "z 200deg"}, "by more than 0 and at most 180deg, not 200deg"),
    ({"turn": "z x"}, "a value is a finite number"),
    ({"turn": "z 1", "cost": {"fuel": 1}}, "a cost is time or energy, not 'fuel'"),
    ({"turn": "z 1", "cost": {"time": -1}}, "the weight of time must be a number from 0 up"),
    ({"turn": "z 1", "cost": {"time": 0}}, "the cost must weigh time or energy above 0"),
    ({"turn": "z 1", "cost": {"energy": 1}}, "until is missing: the time at the end, in seconds"),
    ({"turn": "z 1", "until": 0}, "until must be a number of seconds above 0, not 0"),
    ({"turn": "z 1", "limits": {"momnt": 1}}, "not of 'momnt' (did you mean 'moment_"),
    ({"turn": "z 1", "limits": {"moment": 0}}, "a limit must be above 0, or LOW..HIGH, not 0"),
    ({"turn": "z 1", "limits": {"moment": "2..1"}}, "LOW..HIGH must ascend, not 2..1"),
    ({"turn": "z 1", "avoid": ["x 1"]}, "to avoid is an axis of a body, a direction"),
    ({"end": {"attitude_w": 2}}, "an attitude at the end must have length 1, not 2"),
    ({"end": {"moment_x": 2}}, "has no 'moment_x' to set"),
    ({"end": {"attitude_w": 1}}, "the start is where the end is to be"),
    ({"turn": "z 1", "end": {"omega_x": 1}}, "a turn says what omega_x is at the end; leave one"),
    ({"turn": "z 1", "limits": {"moment": 1, "moment_x": 2}}, "moment_x is limited twice"),
    ({"turn": "z 1", "limits": {"moment": (0, 1)}}, "limit"),
    ({"turn": "z 1", "avoid": ["x 0,0,1 1e9deg"]}, "more than 0 and less than 180deg, not 1e9"),
    ({"turn": "z 90deg", "avoid": ["x 1,0,0 30deg"]}, "the start lies inside of what is to be"),
    ({"turn": "z 90deg", "avoid": ["x 0,1,0 30deg"]}, "the end lies inside of what is to be"),
    (
        {"turn": "z 1", "method": "collocation", "solver": "fatrop"},
        "fatrop solves steps of",
    ),
    ({"end": {"omega": 0, "attitude_x": 0.5}, "limits": {"attitude_x": 0.1}}, "at the end must be"),
    ({"turn": "z 1", "until": "abc"}, "until"),
    ({"turn": "1e200,1e200,1 2", "until": -1}, "until must be"),
    ({"turn": "1e-200,1e-200,0 0.5", "until": -1}, "until must be"),
    ({"turn": "z 1", "steps": 0}, "steps must be"),
    ({"turn": "z 1", "method": "x"}, "method"),
    ({"turn": "z 1", "solver": "x"}, "solver"),
]


@pytest.mark.long
@pytest.mark.parametrize(("given", "says"), REFUSED, ids=[str(n) for n in range(len(REFUSED))])
def test_what_makes_no_sense_is_refused(given, says: str) -> None:
    with pytest.raises(derive.DeriveError) as refused:
        derive.steer(craft(), inertia((1, 2, 3)), **given)
    assert says in str(refused.value)


@pytest.mark.long
def test_scenes_that_cannot_be_steered_say_why() -> None:
    with pytest.raises(derive.DeriveError, match="set values by --set: I_y, I_z"):
        derive.steer(craft(), {"I_x": 1}, "z 1")
    free = craft(known={"angular_velocity": {"range": [-1, 1]}, "moment": ["0", "0", "0"]})
    with pytest.raises(derive.DeriveError, match="nothing steers it, for its rate has no input"):
        derive.steer(free, inertia((1, 2, 3)), "z 1")
    cart = {"M": 0.5, "m": 0.2, "l": 0.3, "I": 0.006, "b": 0.1, "g": 9.8}
    with pytest.raises(derive.DeriveError, match="a turn is of an attitude"):
        derive.steer(derive.load("cart_pendulum"), cart, "z 1")
    with pytest.raises(derive.DeriveError, match="to be steered, a scene must admit state_rate"):
        derive.steer(derive.load("attitude"), {}, "z 1")


def test_values_that_would_be_dropped_are_refused() -> None:
    for more, says in (
        (
            {"omega_dot_x": 1},
            "an input that is held, or a state at the start, not of 'omega_dot_x'",
        ),
        ({"attitude_w": 0}, "an attitude at the start must have length 1, not 0"),
    ):
        with pytest.raises(derive.DeriveError, match=says):
            derive.steer(craft(), {**inertia((1, 2, 3)), **more}, "z 1")


def test_a_scene_without_an_attitude_has_no_cones() -> None:
    cart = {"M": 0.5, "m": 0.2, "l": 0.3, "I": 0.006, "b": 0.1, "g": 9.8}
    with pytest.raises(derive.DeriveError, match=r"to avoid a cone is for .* this scene has none"):
        derive.steer(
            derive.load("cart_pendulum"), cart, end={"x": 1}, avoid=["x 0,0,1 30deg"], until=1
        )


def test_a_start_outside_of_its_limits_is_refused() -> None:
    values = {**inertia((1, 2, 3)), "omega_x": 0.5}
    with pytest.raises(derive.DeriveError, match="omega_x at the start must be within its limits"):
        derive.steer(craft(), values, "z 1", limits={"omega": 0.4})


@pytest.mark.long
def test_what_a_function_tells_at_the_start_is_refused_beyond_its_limits() -> None:
    scene, limits = derive.load("cart_pendulum"), {"rail": "2..3", "F": 1}
    cart = {"M": 0.5, "m": 0.2, "l": 0.3, "I": 0.006, "b": 0.1, "g": 9.8}
    least = min(float(scene.function("rail", cart)(0, 0.5, 0, F)) for F in (-1, 1))
    says = f"rail at the start must be within its limits, 2 to 3, not {least:g} at least, whatever"
    with pytest.raises(derive.DeriveError, match=says):
        derive.steer(scene, {**cart, "theta": 0.5}, end={"x": 1}, until=1, limits=limits)
    spinning = {**inertia((1, 2, 3)), "omega_x": 0.5}
    for limits, says in (
        ({"kinetic_energy": "0..0.1"}, "kinetic_energy at the start .* 0 to 0.1, not 0.125$"),
        ({"kinetic_energy": "0.1..0.2"}, "kinetic_energy at the end .* 0.1 to 0.2, not 0$"),
    ):
        with pytest.raises(derive.DeriveError, match=says):
            derive.steer(craft(), spinning, "z 1", limits={"moment": 1, **limits})


def test_ctrl_c_in_a_solver_stops_the_program() -> None:
    with pytest.raises(KeyboardInterrupt):
        quietly(lambda: os.kill(os.getpid(), signal.SIGINT))
    assert quietly(lambda: 3) == 3


def test_an_end_that_cannot_be_reached_is_said(capsys) -> None:
    values = inertia((1, 2, 3))
    with pytest.raises(derive.DeriveError, match="none of 2 starts led to the end: "):
        derive.steer(craft(), values, "z 3", limits={"moment": 0.01}, cost=COST, until=1, starts=2)


@pytest.mark.long
def test_the_command_prints_what_was_found_and_writes_the_way(tmp_path, capsys) -> None:
    file = tmp_path / "craft.toml"
    file.write_text(craft().scene.text)
    told = ["control", str(file), "--set", "I_x=1", "I_y=2", "I_z=3", "--turn", "x 1"]
    assert main([*told, "--limit", "moment=1", "--starts", "1", "--out", str(tmp_path / "o")]) == 0
    shown = capsys.readouterr().out
    assert "time at the end 2 s cost 2 a local minimum 2" in " ".join(shown.split())
    assert sorted(p.name for p in (tmp_path / "o").iterdir()) == [
        "craft_trajectory.csv",
        "craft_trajectory.svg",
    ]
    assert main([*told, "--cost", "energy=x", "--until", "2"]) == 2
    assert "cost energy: a value is a finite number" in capsys.readouterr().err
