"""Scenes: what the user declares in a TOML file, read, checked and returned as plain values.

``load`` takes the name of a scene of the catalogue or the path of a file.
"""

from __future__ import annotations

import tomllib
from dataclasses import replace
from decimal import Decimal, InvalidOperation
from pathlib import Path

from derive.declaration import (
    Axes,
    Body,
    Coordinate,
    Given,
    Input,
    Parameter,
    Point,
    Scene,
    SceneError,
    Speed,
    Turn,
    Wheel,
)
from derive.scene_file import read_scene
from derive.scene_names import identifier
from derive.scene_rules import check, warnings
from derive.scene_table import nearest, table

__all__ = [
    "Axes",
    "Body",
    "Coordinate",
    "Given",
    "Input",
    "Parameter",
    "Point",
    "Scene",
    "SceneError",
    "Speed",
    "Turn",
    "Wheel",
    "catalogue",
    "load",
    "parse_scene",
]

CATALOGUE = Path(__file__).parent / "catalogue"
LONGEST_FILE = 200_000


def catalogue() -> tuple[str, ...]:
    """Return the names of the scenes that come with the package, sorted.

    >>> "heavy_top" in catalogue()
    True
    """
    return tuple(sorted(path.stem for path in CATALOGUE.glob("*.toml")))


def load(source: str | Path) -> Scene:
    """Return the scene of a catalogue name or of a file, named by the file's stem.

    Raises SceneError with one sentence if there is no such scene or it breaks a rule.

    >>> load("heavy_top").point.kind
    'fixed'
    """
    if isinstance(source, str) and source in catalogue():
        source = CATALOGUE / f"{source}.toml"
    path = Path(source)
    if path.suffix != ".toml" and not path.exists():
        hint = nearest(str(source), catalogue())
        raise SceneError(f"scene '{source}': neither in the catalogue nor a file{hint}")
    return parse_scene(_contents(path), path.stem)


def _contents(path: Path) -> str:
    try:
        return path.read_bytes().decode("utf-8")
    except UnicodeDecodeError as error:
        reason = f"is not UTF-8 (byte {error.start})"
    except (OSError, ValueError) as error:
        reason = "cannot be read: " + (getattr(error, "strerror", None) or str(error)).lower()
    raise SceneError(f"scene '{path.stem}': file {path} {reason}")


def parse_scene(text: str, name: str) -> Scene:
    """Return the scene that a TOML text declares, with warnings about what seems unlikely.

    Raises SceneError; its sentence names the scene, the quantity, the rule and the value found.
    """
    try:
        identifier(name, "the file")
        document = _document(text)
        scene = read_scene(document, name, text)
        said = tuple(table(document.get("known", {}), "known").entries)
        check(scene, said)
        return replace(scene, warnings=warnings(scene, said))
    except SceneError as error:
        raise SceneError(f"scene '{name}': {error}") from None


def _document(text: str) -> dict[str, object]:
    if not text.strip():
        raise SceneError("the file is empty")
    if len(text) > LONGEST_FILE:
        raise SceneError(f"the file has {len(text)} characters; {LONGEST_FILE} is the most")
    try:
        return tomllib.loads(text, parse_float=_decimal)
    except ValueError as error:
        raise SceneError(f"the file is not TOML: {error}") from None
    except RecursionError:
        raise SceneError("the file is not TOML: brackets are nested too deeply") from None


def _decimal(text: str) -> Decimal:
    try:
        return Decimal(text)
    except InvalidOperation:
        return Decimal("inf")
