"""The programs of scenes, made once for all tests of a process: most of them ask for the same."""

from functools import cache

from derive.library import Library, library
from derive.scene import load


@cache
def library_of(source: str) -> Library:
    """Return the library of a scene, by its name or path."""
    return library(load(source))
