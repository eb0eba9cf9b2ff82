"""The machine of docs/constraints.md is a scene, and its program is proved."""

import re
import tomllib
from pathlib import Path

import pytest

import derive
from derive.check import proof
from derive.library.library import library
from derive.scene import parse_scene

PAGE = (Path(__file__).parents[2] / "docs" / "constraints.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```toml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.mark.long
@pytest.mark.parametrize("text", EXAMPLES)
def test_an_example_of_the_page_is_a_scene_and_is_proved(text: str) -> None:
    scene = parse_scene(text, "example")
    assert scene.warnings == ()
    assert proof(library(scene)).outcome == "holds"


@pytest.mark.long
def test_a_start_of_the_example_that_is_off_is_refused_by_the_sentence_of_the_page() -> None:
    scene = derive.load(tomllib.loads(EXAMPLES[0]) | {"wanted": ["step_rk4"]}, name="loop")
    rates = dict.fromkeys(("q_1_dot", "q_2_dot", "q_3_dot"), 0.0)
    angles = {"q_1": 0.3, "q_2": -0.2, "q_3": 0.3}
    with pytest.raises(derive.DeriveError) as refused:
        scene.simulate({"m": 1.5, "l": 0.75} | angles | rates, 0.1)
    (says,) = re.findall(r'"(a motion must begin where[^"]*), \.\.\."', " ".join(PAGE.split()))
    assert says in str(refused.value)


def test_the_page_has_its_example() -> None:
    assert len(EXAMPLES) == 1
