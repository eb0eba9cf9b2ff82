"""What methods are told beside values: folders, counts, who listens; each refused if wrong.

A type says what is meant to a reader; what comes instead is met by one sentence here, and not by an
error of Python's from somewhere below.
"""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from derive.scene import SceneError, of_the_scene
from derive.scene.table import shown

LONGEST_NAME = 255
"""Bytes of a file's name that every usual file system takes."""


def met(value: object) -> str:
    """Return what was found as a sentence shows it: itself if it is short, else what it is.

    >>> met("1ms"), met([1, 2]), met(None), met({1})
    ("'1ms'", 'a list of 2', 'None', 'a set')
    """
    if isinstance(value, np.ndarray) and value.ndim == 0 and value.dtype.kind in "biufcSUO":
        value = value.item()
    match value:
        case None | bool() | float() | complex():
            return repr(value)
        case str() | int():
            return shown(value)
        case bytes():
            return f"bytes of length {len(value)}"
        case np.ndarray():
            return f"an array of {value.dtype}"
        case np.generic():
            return str(value)
        case list() | tuple() | dict():
            return f"a {type(value).__name__} of {len(value)}"
    return f"a {type(value).__name__}"


def path(what: str, value: object) -> Path:
    """Return the path of a file or folder. Raises SceneError for what can be none."""
    text = os.fspath(value) if isinstance(value, str | os.PathLike) else None
    if not isinstance(text, str):
        raise SceneError(f"{what} must be a path, not {met(value)}")
    try:
        written = os.fsencode(text)
    except UnicodeEncodeError:
        written = b"\0"
    if not text.strip() or b"\0" in written or max(map(len, written.split(b"/"))) > LONGEST_NAME:
        raise SceneError(f"{what} must be a path that can exist, not {shown(text)}")
    return Path(text)


def require_another_file(file: Path, scene: str) -> None:
    """Refuse to write a plot over what is none, as the scene itself, of which this is the text."""
    there = file.read_bytes() if os.path.isfile(file) else b""
    if there.strip() and not there.lstrip().startswith(b"<svg"):
        own = of_the_scene(there.decode("utf-8-sig", "replace")) == scene
        lies = "the scene itself lies there" if own else "what lies there is no plot"
        raise SceneError(f"plot {file}: {lies}; name another file")


def count(what: str, value: Any, known: range) -> int:
    """Return a whole number that is one of a range's. Raises SceneError for any other."""
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not whole or int(value) not in known:
        rule = f"must be a whole number above zero, up to {known[-1]}"
        raise SceneError(f"{what} {rule}, not {met(value)}")
    return int(value)


def listener(value: object) -> Callable[[str], None]:
    """Return what hears how far something is. Raises SceneError for what cannot be called."""
    if not callable(value):
        raise SceneError(f"told must be a function of a text, as print is, not {met(value)}")
    return value
