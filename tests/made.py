"""The programs of scenes, made once for all tests of a process: most of them ask for the same."""

from collections.abc import Iterable
from functools import cache
from typing import Any

import pytest

from derive.library.library import Library, library
from derive.scene import Machine, Scene, load


@cache
def scene_of(source: str) -> Scene | Machine:
    """Return a scene, by its name or path."""
    return load(source)


@cache
def library_of(source: str) -> Library:
    """Return the library of a scene, by its name or path."""
    return library(scene_of(source))


def thinned(values: Iterable[Any], step: int) -> list[Any]:
    """Return cases of a test: every ``step``-th runs at once, the others with ``-m long``."""
    return [
        v if place % step == 0 else pytest.param(v, marks=pytest.mark.long)
        for place, v in enumerate(values)
    ]
