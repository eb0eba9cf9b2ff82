"""A scene is data: hostile text in any entry is refused, or is printed and harms nothing.

Which entries there are is read off the reader itself, by the tables that it asks for their keys.
"""

import importlib
import json
import pkgutil
import tomllib
from collections.abc import Iterator
from copy import deepcopy
from decimal import Decimal
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

import derive.scene
from derive.check.compiler import compiled, find_compiler
from derive.command.terminal import complain, console
from derive.emit.c.source import c_files
from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.emit.manifest import manifest
from derive.emit.page.scene import scene_page
from derive.library.library import library
from derive.scene import CATALOGUE, Scene, SceneError, parse_scene
from derive.scene.escape import in_comment, in_docstring, visible
from tests.made import thinned

# the package has a function of this name
reading: Any = importlib.import_module("derive.scene.table")
TRIALS = Path(__file__).parent.parent / "data" / "trials"
ENDS = ("*/ int bad; /*", '"""\nraise SystemExit(9)\n"""', "a\\", "a ??/", "a\x1b[31mb", "a\u202eb")
"""Texts that end a comment, a string or a line, or that a terminal obeys."""
PLAIN = '</p><script>x</script>&amp; {{7*7}} %n $(x) `y` \'z" [red] :smile: é 日本 -->]]> "'
"""Text that is allowed, and means something in every language that it must mean nothing in."""
LONGEST_SENTENCE = 1000
BODY = """
title = "A body"
wanted = ["acceleration", "step_rk4"]
form = "fast"
[parameters]
I_xx = { unit = "kg m^2", range = [1, 2], meaning = "m" }
m = { unit = "kg", value = 3, meaning = "m" }
[axes]
attitude = "quaternion"
[body]
kind = "spherical"
moment = "I_xx"
[[wheels]]
name = "a"
axis = [1, 0, 0]
axial = "I_xx/10"
speed_range = [-1, 1]
torque_range = [-1, 1]
[known]
moment = ["0", "0", "0"]
[motion]
time_step = { range = [0.1, 0.2] }
"""
MACHINE = """
title = "A machine"
source = "own"
wanted = ["gain", "pin", "linearised", "angular_momentum", "step_rk4"]
[parameters]
m = { unit = "kg", range = [1, 2], meaning = "m" }
l = { unit = "m", range = [1, 2], meaning = "m" }
[coordinates]
q = { unit = "rad", range = [-1, 1], meaning = "m", rate = { range = [-1, 1], meaning = "m" } }
[speeds]
w = { unit = "rad/s", range = [1, 2], meaning = "m", rate = { range = [-1, 1], meaning = "m" } }
[inputs]
u = { unit = "N m", range = [-1, 1], meaning = "m" }
[frames]
shaft = { angular_velocity = ["0", "0", "w"] }
arm = { parent = "shaft", turned = ["y q"], origin = ["0", "0", "0"] }
[bodies]
bob = { frame = "arm", shape = "rod", axis = "z", mass = "m", length = "l", centre = [0, 0, "-l"] }
[loads]
weight = { gravity = ["0", "0", "-9.81"], along = "shaft", on = "bob" }
pin = { on = "bob", force = "?pin", couple = ["?a", "u", "?b"] }
spring = { spring = "1", length = "l", on = "bob", at = ["0", "0", "-l"], to_frame = "shaft" }
[results]
gain = { formula = "pin_z/(m*l)", meaning = "m" }
[angular_momentum]
frame = "shaft"
of = "bob"
[linearised]
q = "0"
[motion]
time_step = { range = [0.1, 0.2] }
"""


def read(document: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> Scene:
    """Return the scene of a document that no TOML stands behind."""
    monkeypatch.setattr(derive.scene, "_document", lambda _: document)
    return parse_scene("", "odd")


def entries(document: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> list[tuple[Any, str]]:
    """Return every table that the reader asks for its keys, by its path, and each key it knows."""
    found: dict[tuple[Any, str], None] = {}

    def noting(given: Any, required: Any, optional: Any) -> None:
        required, optional = tuple(required), tuple(optional)
        for path in paths(document, given.entries):
            known = (*required, *optional, *at(document, path))
            found.update(dict.fromkeys((path, key) for key in known))
        reading_keys(given, required, optional)

    reading_keys = reading.keys
    with monkeypatch.context() as patch:
        for module in pkgutil.iter_modules(derive.scene.__path__, "derive.scene."):
            own = importlib.import_module(module.name)
            if getattr(own, "keys", None) is reading_keys:
                patch.setattr(own, "keys", noting)
        read(document, patch)
    return list(found)


def paths(value: Any, wanted: Any, here: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield where a table stands in a document, itself or as a part that was copied."""
    if isinstance(value, dict):
        if value is wanted or (len(wanted) > 2 and wanted.items() <= value.items()):
            yield here
        for key, inner in value.items():
            yield from paths(inner, wanted, (*here, key))
    elif isinstance(value, list):
        for place, inner in enumerate(value):
            yield from paths(inner, wanted, (*here, place))


def changed(document: dict[str, Any], path: tuple[Any, ...], key: str, text: str) -> list[Any]:
    """Return the document with a text for an entry; also in its lists, and as the entry's name."""
    copies = []
    old = at(document, path).get(key)
    for new in (text, [text] * len(old)) if isinstance(old, list) else (text,):
        copy = deepcopy(document)
        at(copy, path)[key] = new
        copies.append(copy)
    copy = deepcopy(document)
    at(copy, path)[text] = at(copy, path).pop(key, text)
    return [*copies, copy]


def at(document: Any, path: tuple[Any, ...]) -> Any:
    for part in path:
        document = document[part]
    return document


def accepts(document: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> bool:
    try:
        read(document, monkeypatch)
    except SceneError as error:
        said = str(error)
    else:
        return True
    assert said.isprintable()
    assert len(said) < LONGEST_SENTENCE
    return False


@pytest.mark.parametrize("text", [BODY, MACHINE], ids=["body", "machine"])
def test_every_table_of_these_scenes_is_asked_for_its_keys(
    text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    document = tomllib.loads(text, parse_float=Decimal)
    visited = {path for path, _ in entries(document, monkeypatch)}
    tables = {path for path in every_table(document) if path[-1:] not in named_by_the_scene()}
    assert visited >= tables
    assert len(tables) > 8


def every_table(value: Any, here: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    if isinstance(value, dict):
        yield here
    each = value.items() if isinstance(value, dict) else enumerate(value)
    for key, inner in each:
        if isinstance(inner, dict | list):
            yield from every_table(inner, (*here, key))


def named_by_the_scene() -> set[tuple[str]]:
    """Return the tables whose keys are names that the scene gives."""
    return {(name,) for name in reading.NAMED}


@pytest.mark.long
@pytest.mark.parametrize("text", [BODY, MACHINE], ids=["body", "machine"])
@pytest.mark.parametrize("hostile", ENDS)
def test_no_entry_takes_text_that_ends_a_comment_a_string_or_a_line(
    text: str, hostile: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    document = tomllib.loads(text, parse_float=Decimal)
    for path, key in entries(document, monkeypatch):
        for copy in changed(document, path, key, hostile):
            assert not accepts(copy, monkeypatch), (path, key)


def filled(text: str, hostile: str, monkeypatch: pytest.MonkeyPatch) -> Scene:
    """Return a scene with a text in every entry that takes it."""
    document = tomllib.loads(text, parse_float=Decimal)
    for path, key in entries(document, monkeypatch):
        copy = changed(document, path, key, hostile)[0]
        document = copy if accepts(copy, monkeypatch) else document
    return read(document, monkeypatch)


def require_harmless(scene: Scene, folder: Path) -> None:
    """Compile, import and parse all that a scene becomes; refuse whatever came to life in it."""
    made = library(scene)
    texts = c_files(made, ())
    assert compiled(texts, f"{scene.name}_f64.c", folder, find_compiler()).exists()
    module = imported(f"{scene.name}_casadi", casadi_file(made), folder)
    assert not hasattr(module, "bad")
    assert json.loads(manifest(made, ()))["title"] == scene.title
    page = scene_page(made, ()).removeprefix("<!DOCTYPE html>\n")
    tree = ET.fromstring(page)  # noqa: S314 (our own page)
    tags = {element.tag.rpartition("}")[2] for element in tree.iter()}
    assert "script" not in tags
    assert tree.findtext(".//{*}h1") == scene.title


@pytest.mark.long
@pytest.mark.parametrize("text", [BODY, MACHINE], ids=["body", "machine"])
def test_text_that_is_allowed_comes_out_as_text(
    text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = filled(text, PLAIN, monkeypatch)
    assert scene.title == PLAIN
    assert scene.parameters[0].meaning == PLAIN
    require_harmless(scene, tmp_path)


@pytest.mark.long
@pytest.mark.parametrize(
    "hostile", thinned([ENDS[0], "int bad; \\", "int bad; ??/", 'x""" + bad + """'], 2)
)
def test_places_where_text_is_printed_do_not_rest_on_the_gate(
    hostile: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reading, "_require_plain", lambda *_: None)
    scene = filled(MACHINE, hostile, monkeypatch)
    assert {scene.title, scene.source, scene.results[0].meaning} == {hostile}
    require_harmless(scene, tmp_path)


def test_text_is_escaped_for_its_place() -> None:
    assert in_comment("a*/b/*??/\nc\\") == "a* /b/ *? ?/\\nc\\."
    assert in_docstring('"""\\') == '\\"\\"\\"\\\\'
    assert visible("a\x07\u202e\udcff") == "a\\x07\\u202e\\udcff"


def test_a_terminal_shows_markup_and_control_characters_and_obeys_neither(
    capsys: pytest.CaptureFixture[str],
) -> None:
    console.print("[red]a[/red] :smile:")
    complain("a \x1b[31m [bold] \udcff", "red")
    shown = capsys.readouterr()
    assert "[red]a[/red] :smile:" in shown.out
    assert "a \\x1b[31m [bold] \\udcff" in shown.err


@pytest.mark.parametrize("name", ["meaning_is_c", "meaning_is_python"])
def test_code_that_poses_as_a_meaning_is_refused(name: str) -> None:
    with pytest.raises(SceneError, match=r"result 'gain': meaning must not hold"):
        parse_scene((TRIALS / f"{name}.toml").read_text(encoding="utf-8"), name)


def test_every_scene_of_the_catalogue_passes_the_gate() -> None:
    """And not one of them with a mark added to its title that ends a comment."""
    for path in CATALOGUE.glob("*.toml"):
        document = tomllib.loads(path.read_text(encoding="utf-8"))
        reading.gate(document, reading.THE_FILE)
        with pytest.raises(SceneError, match="title must not hold"):
            reading.gate(document | {"title": f"{document['title']} */"}, reading.THE_FILE)
