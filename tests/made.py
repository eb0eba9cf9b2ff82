"""The programs of scenes, made once for all tests of a process: most of them ask for the same."""

import tomllib
from collections.abc import Iterable
from decimal import Decimal
from functools import cache
from typing import Any

import pytest

from derive.library.library import Library, library
from derive.scene import CATALOGUE, Scene, catalogue, load
from derive.scene.short_form.declared import ShortForm
from derive.scene.short_form.tables import read_scene


@cache
def scene_of(source: str) -> Scene:
    """Return a scene, by its name or path."""
    return load(source)


def short(text: str) -> ShortForm:
    """Return a scene of a single body as its short form declares it, by its text."""
    return read_scene(tomllib.loads(text, parse_float=Decimal), "short", text)


@cache
def short_of(name: str) -> ShortForm:
    """Return what a short scene of the catalogue declares."""
    return short(text_of(name))


def text_of(name: str) -> str:
    """Return the file of a scene of the catalogue."""
    return (CATALOGUE / f"{name}.toml").read_text(encoding="utf-8")


SHORT = tuple(name for name in catalogue() if "\n[bodies" not in text_of(name))
"""Scenes of the catalogue in short form."""


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
