"""A refusal repeats the value found: every entry of some scenes is replaced by wrong ones.

What an entry is replaced by is of every kind and shape that TOML has, and so told by its words that
a sentence either holds it or does not.
"""

import re
import tomllib
from collections.abc import Iterator
from copy import deepcopy
from decimal import Decimal
from sys import modules
from typing import Any

import pytest

from derive import scene
from derive.scene import CATALOGUE, SceneError
from derive.scene.table import THE_FILE, gate
from tests.made import thinned

WRONG: tuple[tuple[object, str], ...] = (
    (True, "true"),
    (Decimal("31.25"), r"31\.2"),  # or a length of 31.266, or an inertia of them
    ("zonk", "'?zonk"),
    ([], r"\[\]|empty list"),
    ([Decimal("41.5"), "quux"], "41.5|quux"),
    ({"zonk": Decimal("43.5")}, "zonk|43.5"),
    ([["zonk"], 2, 3], "zonk"),
    (10**400, "a number of 1329 bits"),
)
ABOUT_WHAT_IS_MISSING = re.compile(
    " needs '\\w+'$| needs one of | and has neither$"  # nothing was found
    "| uses '\\w+', which the scene does not declare|^wanted has '\\w+', which is no answer"
    "|the wheels alone exceed it$"  # of another entry, which rests on the one that was replaced
)
SCENES = ("heavy_top", "gyrostat", "rigid_body", "rotor_on_turning_axes", "skewed_disc",
          "sleeping_top", "rolling_cone", "eulers_disk", "centrifuge_gondola")  # fmt: skip


def places(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the way to every entry of a document."""
    for key, value in node.items() if isinstance(node, dict) else enumerate(node):
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from places(value, (*path, key))


def replaced(document: Any, path: tuple[Any, ...], value: object) -> Any:
    """Return a document with another value at a place."""
    whole = at = deepcopy(document)
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = value
    return whole


def silent(name: str) -> list[str]:
    """Return the refusals of one changed entry that do not repeat what was found there."""
    text = (CATALOGUE / f"{name}.toml").read_text(encoding="utf-8")
    document = tomllib.loads(text, parse_float=Decimal)
    every = ((path, *wrong) for path in places(document) for wrong in WRONG)
    return [
        f"{'.'.join(map(str, path))}: {says}"
        for path, value, word in every
        if (says := sentence(replaced(document, path, value), name, text))
        and not re.search(word, says)
        and not ABOUT_WHAT_IS_MISSING.search(says)
        and not ("range" in path and " at " in says)  # what was found lies between its ends
    ]


def sentence(document: Any, name: str, text: str) -> str:
    """Return the sentence that refuses a document, "" if it is read."""
    try:
        gate(document, THE_FILE)
        scene.read(document, name, text)
    except SceneError as refusal:
        return str(refusal)
    return ""


@pytest.mark.parametrize("name", thinned(SCENES, 12))
def test_a_refusal_repeats_the_value_found(name: str) -> None:
    assert silent(name) == []


@pytest.mark.long
@pytest.mark.parametrize("kept", [0, 3])
def test_a_sentence_that_names_a_kind_alone_is_noticed(
    kept: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(modules["derive.scene.table"], "_spelled", lambda value: str(value)[:kept])
    assert silent("eulers_disk") != []
