"""The JSON states no range that a function may leave."""

import json
import re

import pytest

from derive.emit.c.comment import comment
from derive.emit.manifest import manifest
from tests.made import library_of

NAMES = ["free_body_principal", "heavy_top", "attitude", "edge_runner_flat"]


@pytest.mark.parametrize("name", NAMES)
def test_no_range_is_stated_of_what_a_function_gives(name: str) -> None:
    made = library_of(name)
    said = json.loads(manifest(made, ()))
    every = [a for f in said["functions"] for a in f["arguments"]]
    stated = {direction: [a["range"] for a in every if a["direction"] == direction]
              for direction in ("in", "out")}  # fmt: skip
    assert any(stated["in"])
    assert set(stated["out"]) == {None}
    headers = [comment(p, (), 1).partition("Returned:")[2] for p in made.printed()]
    assert all(headers)
    assert not any(re.search(r"\d \.\. -?\d", text) for text in headers)
