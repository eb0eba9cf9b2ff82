"""A constraint that cannot be meant, read or fulfilled is refused by one sentence."""

from pathlib import Path

import pytest

from derive.library.library import library
from derive.scene import SceneError, parse_scene

SCENES = Path(__file__).parent / "scenes"
FOUR = (SCENES / "four_bar_closed.toml").read_text(encoding="utf-8")
SLEIGH = (SCENES / "sleigh.toml").read_text(encoding="utf-8")
CRANK = (SCENES / "slider_crank_guided.toml").read_text(encoding="utf-8")
ZERO = 'zero = "y_dot*cos(psi) - x_dot*sin(psi)"'
GUIDED = 'zero = "r*sin(a) + l*sin(b)"'
PIN = 'at = ["l", "0", "0"]\nagainst = "right"'
ARM = """
[coordinates.q]
unit = "rad"
range = [-1, 1]
[frames.arm]
parent = "sled"
turned = ["z q"]
[bodies.arm]
frame = "arm"
shape = "rod"
axis = "x"
mass = "m"
length = "a"
[loads.pin]
on = "arm"
against = "sled"
force = "?p"
couple = ["?p_a", "?p_b", "0"]
"""

LOADED = SLEIGH.replace('"blade", ', "")
ROWS = (
    (FOUR, 'axes = ["x", "z"]', 'axes = ["x", "x"]', "must be a list of different ones of x, y"),
    (FOUR, 'axes = ["x", "z"]', 'axes = [["x"]]', "must be a list of different ones of x, y"),
    (FOUR, PIN, 'at = ["l", "0", "0"]\nagainst = "bar"', "holds 'bar' against itself"),
    (FOUR, 'on = "bar"\nat', "at", "constraint 'd' needs zero = 'formula', or on, a body"),
    (FOUR, PIN, 'at = ["5*l", "0", "0"]\nagainst = "right"', "no state of the declared ranges was"),
    (FOUR, '"d_x"', '"d_y"', "wanted has 'd_y', which is no answer"),
    (FOUR, '"d_x"]', '"linearised"]\n[linearised]\nq_2 = "q_2"\nq_3 = "q_3"\nq_1 = "q_1"',
     "about a state that constraint 'd' does not allow"),
    (FOUR, "[constraints.d]", "[constraints.c]", "constraint 'c' is called as a load is; say load"),
    (SLEIGH, ZERO, 'zero = "a"', "constraint 'blade'.zero = 'a' holds nothing that moves"),
    (SLEIGH, ZERO, f'{ZERO}\non = "sled"', "constraint 'blade' is a formula by zero, so it has no"),
    (SLEIGH, ZERO, 'zero = "x_ddot"', "constraint 'blade'.zero uses 'x_ddot', which"),
    (SLEIGH, '"blade", ', '"N_x", ', "wanted has 'N_x', which is no answer"),
    (SLEIGH, ZERO, f'{ZERO}\nload = "ice"', ""),
    (SLEIGH, ZERO, 'zero = "(x - y)^2"', "constraint 'blade' changes with nothing where it is 0"),
    (SLEIGH, ZERO, 'zero = "x^2 + y^2"', "constraint 'blade' changes with nothing where it is 0"),
    (SLEIGH, ZERO, 'zero = "x_dot^2 + y_dot^2"', "constraint 'blade' changes with nothing where"),
    (CRANK, GUIDED, GUIDED.replace("l*sin", "tau*sin"), "zero uses 'tau', an input, whose rate"),
    (LOADED, ZERO, f'{ZERO}\nload = "pin"\n{ARM}', "load 'pin' cannot enforce constraint 'blade'"),
    (CRANK, 'load = "guide"', 'load = "gide"', "constraint 'guided'.load must be one of main, pin"),
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=[row[3][:40] or "a load by name" for row in ROWS])
def test_what_cannot_hold_is_refused_by_a_sentence(row: tuple[str, str, str, str]) -> None:
    text, old, new, says = row
    assert old in text
    try:
        library(parse_scene(text.replace(old, new, 1), "held"))
        found = ""
    except SceneError as error:
        found = str(error)
    assert found.startswith("scene 'held': ")
    assert says in found
    assert "\n" not in found


@pytest.mark.long
def test_ranges_that_reach_where_bars_are_in_line_are_refused_with_the_place() -> None:
    text = FOUR.replace("range = [-0.5, 0.5]", "range = [-3, 3]")
    says = "constraint 'd along .' says nothing that the others do not at .*q_1 = -?1.571"
    with pytest.raises(SceneError, match=says):
        library(parse_scene(text, "held"))


@pytest.mark.long
def test_a_force_that_shares_its_part_with_others_cannot_be_told() -> None:
    text = FOUR.replace('axes = ["x", "z"]', "").replace('"d_x"', '"d_y"')
    with pytest.raises(SceneError, match="'d_y' cannot be told: constraint 'd along y' says"):
        library(parse_scene(text, "held"))


@pytest.mark.long
@pytest.mark.parametrize("zero", ["q_1 - q_1", "sin(q_1)^2 + cos(q_1)^2 - 1"])
def test_what_is_always_0_is_left_out(zero: str) -> None:
    loop = FOUR.replace(', "d_x"', "").partition("[constraints")[0]
    found = library(parse_scene(f'{loop}[constraints.none]\nzero = "{zero}"\n', "held"))
    assert found.mechanism.held.kept == ()
    assert found.mechanism.held.doubts[0].startswith("constraint 'none' says nothing that the")


@pytest.mark.long
def test_a_load_of_no_power_that_is_said_to_enforce_is_doubted_where_another_does() -> None:
    pushed = 'loads.edge = { on = "sled", along = "sled", force = ["0", "?B", "0"] }\n'
    text = pushed + LOADED.replace(ZERO, f'{ZERO}\nload = "pin"\n{ARM}')
    own = library(parse_scene(text, "held")).mechanism
    says = "load 'pin' cannot enforce constraint 'blade': it has no power on any motion that the"
    assert any(doubt.startswith(says) for doubt in own.doubts())
    right = library(parse_scene(text.replace('load = "pin"', 'load = "edge"'), "held")).mechanism
    assert not any("cannot enforce" in doubt for doubt in right.doubts())
