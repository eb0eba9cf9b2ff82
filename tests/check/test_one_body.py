"""A scene of a single body agrees with particles of which only positions are known."""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from derive.check.particles import clouds
from derive.library.library import Library, library
from derive.program.precision import F64
from derive.scene import parse_scene
from derive.scene.short_form.long_form import in_long_form
from derive.scene.wanted import EQUATIONS
from derive.verify.sample import samples
from tests.lower import test_unusual_scenes as unusual
from tests.made import SHORT, library_of, short_of

DOCS = Path(__file__).parents[2] / "docs"
EXAMPLE = re.compile(r"^```toml\n(.*?)^```$", re.MULTILINE | re.DOTALL)
PAGES = [(DOCS / f"{page}.md").read_text(encoding="utf-8") for page in ("scenes", "motion")]
EXAMPLES = [text for page in PAGES for text in EXAMPLE.findall(page)]
WRITTEN = [text for text in EXAMPLES if not text.startswith("# scene")]
OF_ONE_BODY = [n for n in SHORT if n != "attitude"]


def quick(names: Iterable[str], *at_once: str) -> list[Any]:
    """Return cases of which the others run with ``-m long``."""
    return [n if n in at_once else pytest.param(n, marks=pytest.mark.long) for n in names]


def rows(made: Library) -> dict[str, str]:
    """Return the verdict on every function of a scene that the lecture's equations state."""
    each = samples(made.mechanism, F64, 2, 0).each
    return {verdict.function: verdict.outcome for verdict in clouds(made, each)}


@pytest.mark.parametrize("name", quick(OF_ONE_BODY, "free_body_principal", "heavy_top"))
def test_a_scene_of_the_catalogue_is_its_particles(name: str) -> None:
    made = library_of(name)
    assert rows(made) == dict.fromkeys(made.problems, "holds")


@pytest.mark.long
@pytest.mark.parametrize("name", quick(unusual.SCENES, "a moving point"))
def test_a_scene_of_any_axes_wheels_or_point_is_its_particles(name: str) -> None:
    made = library(parse_scene(unusual.text_of(name), "unusual"))
    assert set(rows(made).values()) == {"holds"}


@pytest.mark.long
@pytest.mark.parametrize("text", WRITTEN)
def test_an_example_of_the_pages_is_its_particles(text: str) -> None:
    scene = parse_scene(text, "example")
    if not set(scene.wanted) & {*EQUATIONS}:
        pytest.skip("steps, or answers of other names")
    assert set(rows(library(scene)).values()) == {"holds"}


WRONG: Mapping[str, Callable[[Any], Any]] = {
    "a wheel along another line": lambda s: replace(
        s, wheels=(*s.wheels[:-1], replace(s.wheels[-1], axis=s.wheels[-1].axis[::-1]))
    ),
    "products turned in sign": lambda s: replace(
        s, body=replace(s.body, inertia=(*s.body.inertia[:3], *(-p for p in s.body.inertia[3:])))
    ),
    "two moments swapped": lambda s: replace(
        s, body=replace(s.body, inertia=(*s.body.inertia[1::-1], *s.body.inertia[2:]))
    ),
    "a turn about another axis": lambda s: replace(
        s, axes=replace(s.axes, turned=(s.axes.turned[0], replace(s.axes.turned[1], axis="y")))
    ),
}


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "wrong"),
    [
        ("free_body", "products turned in sign"),
        ("free_body", "two moments swapped"),
        ("heavy_top", "a turn about another axis"),
        pytest.param("gyrostat", "a wheel along another line", marks=pytest.mark.long),
    ],
)
def test_the_programs_of_another_scene_are_noticed(name: str, wrong: str) -> None:
    made = library_of(name)
    other = in_long_form(WRONG[wrong](short_of(name)))
    assert other.inverse is not None
    assert made.mechanism.inverse is not None
    inverse = replace(made.mechanism.inverse, scene=other.inverse)
    made = replace(made, mechanism=replace(made.mechanism, scene=other, inverse=inverse))
    assert "FAILS" in rows(made).values()
