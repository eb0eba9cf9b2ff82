"""A TOML file in, a scene out: what the user declares, read, checked, as plain values.

``load`` takes the name of a scene of the catalogue or the path of a file.
"""

import os
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from decimal import Decimal, InvalidOperation
from pathlib import Path
from typing import Any

from derive.scene.declaration import DeriveError, Given, Input, Parameter, SceneError, Turning
from derive.scene.escape import brief, visible
from derive.scene.machine import Scene
from derive.scene.names import file_name
from derive.scene.reader import read_machine
from derive.scene.short_form import read_short
from derive.scene.table import THE_FILE, gate, nearest, shown, table
from derive.scene.toml import toml
from derive.scene.wanted import idle_times

__all__ = [
    "DeriveError",
    "Given",
    "Input",
    "Parameter",
    "Scene",
    "SceneError",
    "Turning",
    "argument",
    "catalogue",
    "contents",
    "document_text",
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


def argument(scene: Scene) -> str:
    """Return what commands are told to mean a scene: its name in the catalogue, or its file.

    >>> argument(load("heavy_top"))
    'heavy_top'
    """
    file = f"{scene.name}.toml"
    known = scene.name in catalogue() and of_the_scene(_contents(CATALOGUE / file)) == scene.text
    return scene.name if known else file


def load(source: str | Path) -> Scene:
    """Return the scene of a catalogue name or of a file, named by the file's stem.

    Raises SceneError with one sentence if there is no such scene or it breaks a rule.

    >>> [body.name for body in load("heavy_top").bodies]
    ['body']
    """
    return parse_scene(*contents(source))


def contents(source: str | Path) -> tuple[str, str]:
    """Return the text of a scene, and its name: that of the catalogue, or the file's stem.

    Raises SceneError with one sentence if there is no such scene or it cannot be read.
    """
    if isinstance(source, str) and source in catalogue():
        source = CATALOGUE / f"{source}.toml"
    path = Path(source)
    if not path.stem:
        says = "a name of the catalogue or the path of a TOML file is needed"
        raise SceneError(f"scene {shown(str(source))}: {says}")
    if path.suffix != ".toml" and not os.path.exists(path):
        hint = nearest(str(source), catalogue())
        raise SceneError(f"scene {shown(str(source))}: neither in the catalogue nor a file{hint}")
    return _contents(path), path.stem


def document_text(document: Mapping[str, object], name: str) -> str:
    """Return the text of a scene that is given as a dict, the parsed form of its TOML.

    Raises SceneError for a name that none can have, and for values that TOML does not know.
    """
    try:
        file_name(name)
        return toml(document)
    except SceneError as error:
        raise SceneError(f"scene {_quoted(name)}: {error}") from None


def _contents(path: Path) -> str:
    start = f"scene {_quoted(path.stem)}: {visible(str(path))}"
    if not os.path.isfile(path):
        state = "is a link that leads nowhere" if os.path.islink(path) else "does not exist"
        state = "is not a file" if os.path.exists(path) else state
        raise SceneError(f"{start} {state}")
    try:
        with path.open("rb") as file:
            content = file.read(LONGEST_FILE + 1)
    except OSError as error:
        raise SceneError(f"{start} cannot be read: {error.strerror}") from None
    if len(content) > LONGEST_FILE:
        raise SceneError(f"{start} is longer than {LONGEST_FILE} bytes")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SceneError(f"{start} is not UTF-8 (byte {error.start})") from None


def parse_scene(text: str, name: str) -> Scene:
    """Return the scene that a TOML text declares, with warnings about what seems unlikely.

    Raises SceneError; its sentence names the scene, the quantity, the rule and the value found.
    """
    try:
        file_name(name)
        document = _document(text)
        gate(document, THE_FILE)
        scene = read(document, name, of_the_scene(text))
        times = table(document.get("motion", {}), "motion").entries
        idle = idle_times(times, scene.wanted)
        return replace(scene, warnings=(*scene.warnings, *idle))
    except SceneError as error:
        raise SceneError(f"scene {_quoted(name)}: {error}") from None


def of_the_scene(text: str) -> str:
    """Return a file's text without a first line that names its schema: editors alone read it.

    >>> of_the_scene("#:schema scene.schema.json" + chr(10) + "wanted = []")
    'wanted = []'
    """
    first, _, rest = text.partition("\n")
    return rest if first.startswith("#:schema ") else text


def _quoted(name: str) -> str:
    return f"'{brief(visible(name))}'"


def read(document: dict[str, Any], name: str, text: str) -> Scene:
    """Return the scene of a parsed TOML document, in whichever form it is written.

    Raises SceneError; its sentence does not name the scene.
    """
    reader = read_machine if "bodies" in document or "frames" in document else read_short
    return reader(document, name, text)


def _document(text: str) -> dict[str, Any]:
    if not text.strip():
        raise SceneError("the file is empty")
    if len(text) > LONGEST_FILE:
        raise SceneError(f"the file is longer than {LONGEST_FILE} characters")
    try:
        return tomllib.loads(text, parse_float=_decimal)
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"the file is not TOML: {error}") from None
    except ValueError:  # what Python says of it is advice to programmers
        raise SceneError("the file holds a whole number of too many digits") from None
    except RecursionError:
        raise SceneError("the file is not TOML: brackets are nested too deeply") from None


def _decimal(text: str) -> Decimal:
    try:
        return Decimal(text)
    except InvalidOperation:
        return Decimal("inf")
