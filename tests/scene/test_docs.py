"""Every example of docs/scenes.md is a scene, or is refused by the sentence above it."""

import math
import re
import tomllib
from ast import literal_eval
from pathlib import Path

import pytest

from derive.check import proof
from derive.library.library import library
from derive.scene import (
    SceneError,
    catalogue,
    entries,
    load,
    loads,
    manual,
    parse_scene,
    reader,
    results,
    shape,
    unit,
)
from derive.scene import wanted as scene_wanted
from derive.scene.short_form.tables import ONE_BODY
from tests.made import SHORT

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "scenes.md").read_text(encoding="utf-8")
MOTION = (DOCS / "motion.md").read_text(encoding="utf-8")
EXAMPLE = re.compile(r"^```toml\n(.*?)^```$", re.MULTILINE | re.DOTALL)
EXAMPLES = EXAMPLE.findall(PAGE)
REFUSED = [text for text in EXAMPLES if text.startswith("# scene 'example': ")]
ACCEPTED = [text for text in EXAMPLES if text not in REFUSED]
MACHINES = [text for text in ACCEPTED if re.search(r"^\[bodies", text, re.MULTILINE)]
LONGEST_PAGE = 260
"""Lines, examples included: one page, read in a sitting; the manual of scenes has a page a form."""
LONGEST_MACHINE = 51
"""Of one that has four of everything, and of one whose place of contact is a formula."""


@pytest.mark.parametrize("text", [*ACCEPTED, *EXAMPLE.findall(MOTION)])
def test_an_example_of_the_page_is_a_scene_without_a_warning(text: str) -> None:
    assert parse_scene(text, "example").warnings == ()


@pytest.mark.parametrize("text", REFUSED)
def test_a_refused_example_of_the_page_is_refused_by_the_sentence_above_it(text: str) -> None:
    with pytest.raises(SceneError) as refusal:
        parse_scene(text, "example")
    assert str(refusal.value) == text.splitlines()[0].removeprefix("# ")


def test_the_manual_has_its_examples_and_a_page_a_form() -> None:
    assert (len(ACCEPTED), len(MACHINES), len(REFUSED)) == (7, 2, 2)
    forms = PAGE.split("\n# Long form")
    assert [len(form.splitlines()) <= LONGEST_PAGE for form in forms] == [True, True]


@pytest.mark.parametrize("text", MACHINES)
def test_a_machine_of_the_page_is_proved(text: str) -> None:
    assert proof(library(parse_scene(text, "example"))).outcome == "holds"


@pytest.mark.long
def test_the_program_of_the_page_prints_the_frequencies_of_a_sleeping_top(
    capsys: pytest.CaptureFixture[str],
) -> None:
    (program,) = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    exec(program, {})  # noqa: S102 (the page is ours)
    m, r, stem, g, n = 0.5, 0.05, 0.06, 9.81, 120
    across, along, weight = m * (r**2 / 4 + stem**2), m * r**2 / 2 * n, m * g * stem
    root = math.sqrt(along**2 - 4 * across * weight)
    wanted = [(along - root) / (2 * across), (along + root) / (2 * across)]
    assert literal_eval(capsys.readouterr().out) == pytest.approx(wanted, rel=1e-12)  # roundings


def test_every_word_that_a_scene_may_use_stands_on_the_page() -> None:
    words = [*scene_wanted.EQUATIONS, *ONE_BODY.tables, *ONE_BODY.foreign]
    words += [*entries.KINDS, *shape.SHAPES, *unit.UNITS]
    own = (*entries.AXES_OF_ONE, *entries.BODY, *entries.POINT, *entries.KNOWN, *entries.WHEEL)
    words += [w for row in own for w in (row.key, *row.words)]
    assert _not_on_the_page(words) == []


def test_every_word_that_a_machine_may_use_stands_on_the_page() -> None:
    loads_, shapes = loads.MAIN, entries.SAID
    own = (entries.FRAME, entries.ROLLS, entries.MEMBER, *shapes.values(), *loads_.values())
    rows = [row for each in (*own, entries.MOMENTUM, entries.STEADY) for row in each]
    words = [
        *reader.MACHINE.tables,
        *results.FUNCTIONS,
        *scene_wanted.OF_MACHINES[:7],
        *loads_,
        "tube",
    ]
    words += [word for row in rows for word in (row.key, *row.words) if len(word) > 1]
    assert _not_on_the_page(words) == []


def _not_on_the_page(words: list[str]) -> list[str]:
    return [word for word in words if not re.search(rf"\b{word}\b", PAGE)]


@pytest.mark.parametrize("name", [n for n in catalogue() if n not in SHORT])
def test_a_machine_of_the_catalogue_is_short_and_has_a_source(name: str) -> None:
    scene = load(name)
    assert scene.source
    assert len(scene.text.splitlines()) <= LONGEST_MACHINE


def test_the_page_of_entries_is_made_from_the_rows_that_the_reader_follows() -> None:
    assert (DOCS / "entries.md").read_text(encoding="utf-8") == manual.page()


@pytest.mark.parametrize("text", [*ACCEPTED, *EXAMPLE.findall(MOTION)])
def test_every_key_of_an_example_is_a_row(text: str) -> None:
    keys = set(re.findall(r"^(\w+) *=", text, re.MULTILINE))
    top = {"kind", "shape", *ONE_BODY.tables}
    assert keys - manual.words() - top - _names(text) == set()


def _names(text: str) -> set[str]:
    """Return the names that a scene gives to its scalars and results."""
    document = tomllib.loads(text)
    scalars = ("parameters", "coordinates", "speeds", "inputs", "formulas", "results")
    return {name for table in scalars for name in document.get(table, {})}


def test_every_motion_and_attitude_formula_stands_on_its_page() -> None:
    words = [*scene_wanted.STEP_FUNCTIONS, *scene_wanted.STEP_DERIVATIVES, "time_step", "time"]
    words += [name for name in scene_wanted.ATTITUDES if "euler" not in name]
    numbered = {f"step_taylor{order}" for order in range(13, 19)}
    lacking = [w for w in words if w not in numbered and not re.search(rf"\b{w}\b", MOTION)]
    assert lacking == []
    assert len(MOTION.splitlines()) <= LONGEST_PAGE


def test_the_page_says_where_the_catalogue_is() -> None:
    assert "derive/scene/catalogue/" in PAGE
    assert catalogue()
