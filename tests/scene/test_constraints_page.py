"""The machine of docs/constraints.md is a scene, and its program is proved."""

import re
from pathlib import Path

import pytest

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


def test_the_page_has_its_example() -> None:
    assert len(EXAMPLES) == 1
