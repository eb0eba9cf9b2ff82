"""Every example of docs/machines.md comes out, and every word of the format stands there."""

import re
from pathlib import Path

import pytest

from derive.check import proof
from derive.library.library import library
from derive.scene import (
    Machine,
    catalogue,
    entries,
    load,
    parse_scene,
    reader,
    results,
)
from derive.scene.loads import MAIN
from derive.scene.wanted import OF_MACHINES
from tests.made import scene_of

PAGE = (Path(__file__).parents[2] / "docs" / "machines.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```toml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
LONGEST_PAGE, LONGEST_SCENE = 200, 41


@pytest.mark.parametrize("text", EXAMPLES)
def test_an_example_of_the_page_is_a_machine_that_is_proved(text: str) -> None:
    assert proof(library(parse_scene(text, "example"))).outcome == "holds"


def test_the_page_has_two_examples_and_is_one_page() -> None:
    assert len(EXAMPLES) == 2
    assert len(PAGE.splitlines()) <= LONGEST_PAGE


def test_every_word_that_a_machine_may_use_stands_on_the_page() -> None:
    own = (entries.FRAME, entries.ROLLS, entries.MEMBER, *entries.SAID.values(), *MAIN.values())
    rows = [row for each in (*own, entries.MOMENTUM, entries.STEADY) for row in each]
    words = [*reader.TABLES, *results.FUNCTIONS, *OF_MACHINES[:7], *MAIN, "tube"]
    words += [word for row in rows for word in (row.key, *row.words) if len(word) > 1]
    assert [word for word in words if not re.search(rf"\b{word}\b", PAGE)] == []


@pytest.mark.parametrize("name", [n for n in catalogue() if isinstance(scene_of(n), Machine)])
def test_a_machine_of_the_catalogue_is_short_and_has_a_source(name: str) -> None:
    scene = load(name)
    assert isinstance(scene, Machine)
    assert scene.source
    assert len(scene.text.splitlines()) <= LONGEST_SCENE
