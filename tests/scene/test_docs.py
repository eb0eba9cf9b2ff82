"""Every example of docs/scenes.md is a scene, or is refused by the sentence above it."""

import re
import tomllib
from pathlib import Path

import pytest

from derive.scene import (
    SceneError,
    catalogue,
    entries,
    manual,
    parse_scene,
    shape,
    short_form,
    unit,
)
from derive.scene import wanted as scene_wanted

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "scenes.md").read_text(encoding="utf-8")
MOTION = (DOCS / "motion.md").read_text(encoding="utf-8")
EXAMPLE = re.compile(r"^```toml\n(.*?)^```$", re.MULTILINE | re.DOTALL)
EXAMPLES = EXAMPLE.findall(PAGE)
REFUSED = [text for text in EXAMPLES if text.startswith("# scene 'example': ")]
ACCEPTED = [text for text in EXAMPLES if text not in REFUSED]
LONGEST_PAGE = 260
"""Lines, examples included: one page, read in a sitting."""


@pytest.mark.parametrize("text", [*ACCEPTED, *EXAMPLE.findall(MOTION)])
def test_an_example_of_the_page_is_a_scene_without_a_warning(text: str) -> None:
    assert parse_scene(text, "example").warnings == ()


@pytest.mark.parametrize("text", REFUSED)
def test_a_refused_example_of_the_page_is_refused_by_the_sentence_above_it(text: str) -> None:
    with pytest.raises(SceneError) as refusal:
        parse_scene(text, "example")
    assert str(refusal.value) == text.splitlines()[0].removeprefix("# ")


def test_the_page_has_its_examples_and_is_one_page() -> None:
    assert (len(ACCEPTED), len(REFUSED)) == (5, 2)
    assert len(PAGE.splitlines()) <= LONGEST_PAGE


def test_every_word_that_a_scene_may_use_stands_on_the_page() -> None:
    words = [*scene_wanted.EQUATIONS, *(*short_form.TABLES, "wheels", *short_form.LATER)]
    words += [*entries.KINDS, *shape.SHAPES, *unit.UNITS]
    own = (*entries.AXES_OF_ONE, *entries.BODY, *entries.POINT, *entries.KNOWN, *entries.WHEEL)
    words += [w for row in own for w in (row.key, *row.words)]
    assert [word for word in words if not re.search(rf"\b{word}\b", PAGE)] == []


def test_the_page_of_entries_is_made_from_the_rows_that_the_reader_follows() -> None:
    assert (DOCS / "entries.md").read_text(encoding="utf-8") == manual.page()


@pytest.mark.parametrize("text", [*ACCEPTED, *EXAMPLE.findall(MOTION)])
def test_every_key_of_an_example_is_a_row(text: str) -> None:
    keys = set(re.findall(r"^(\w+) *=", text, re.MULTILINE))
    top = {"title", "source", "wanted", "form", "emission", "kind", "shape"}
    assert keys - manual.words() - top - _names(text) == set()


def _names(text: str) -> set[str]:
    """Return the names that a scene gives to its scalars and results."""
    document = tomllib.loads(text)
    scalars = ("parameters", "coordinates", "speeds", "inputs", "results")
    return {name for table in scalars for name in document.get(table, {})}


def test_every_motion_and_attitude_formula_stands_on_its_page() -> None:
    words = [*scene_wanted.STEPS, *scene_wanted.STEP_DERIVATIVES, "time_step", "time"]
    words += [name for name in scene_wanted.ATTITUDES if "euler" not in name]
    numbered = {f"step_taylor{order}" for order in range(13, 19)}
    lacking = [w for w in words if w not in numbered and not re.search(rf"\b{w}\b", MOTION)]
    assert lacking == []
    assert len(MOTION.splitlines()) <= LONGEST_PAGE


def test_the_page_says_where_the_catalogue_is() -> None:
    assert "derive/scene/catalogue/" in PAGE
    assert catalogue()
