"""Fourteen rooms, lowest first: imports go down, never up and never in a circle.

SymPy stays with the symbols, and what only the checkout has stays out of the package.
"""

import ast
import re
from collections.abc import Mapping
from dataclasses import fields, replace
from functools import cache
from pathlib import Path

import pytest

import derive
from derive.scene import Scene, catalogue
from tests.made import SHORT, scene_of
from tests.source import nodes_of, parsed

ROOMS = (
    *("lecture", "scene", "program", "mechanics", "lower", "motion"),
    *("library", "verify", "emit", "check", "report", "solve", "control"),
    "command",
)
MODULES = ("__init__", "__main__", "cli")
API = derive.__all__
OUTERMOST = ("command", "__main__", "cli")
"""Rooms and modules that may use the interface of Python: all others are below it."""
SPOKEN = {"derive", "derive.command", "derive.solve", "derive.control", "derive.scene.escape"}
"""What commands use of the package: its interface, each other, and what a terminal may show."""
OF_THEIR_OWN = {"lecture", "costs", "schema", "new", "completion", "parsed"}
"""What has no counterpart in Python: the lecture, costs, editors, shells, what is typed."""
WITHOUT_SYMPY = (
    *("scene", "program", "motion", "emit/c", "emit/lines"),
    *("emit/casadi_text", "emit/casadi_module"),
    *("lower/graph", "lower/expand", "lower/numbering", "lower/share", "lower/write"),
    *("lower/schedule", "lower/derivative", "lower/forms", "lower/setup", "lower/cancel"),
)
"""Folders and modules that must not know the symbols."""
MOST_ASKERS = 11
MOST_LINES = 300
"""Modules outside mechanics that may import it: what others need of it, a library tells them."""
FORMS = ("ShortForm", "short_form", "long_form", "read_short", "read_scene", "read_machine")
"""Words by which a module would know one of the two forms that a scene may be written in."""
PICKS = {
    "derive.scene": {"short_form", "read_short", "read_machine"},
    "derive.scene.schema": {"short_form"},
}
"""What knows them outside the folder of the short form: it picks the reader, or tells of both."""
OF_ONE_FORM = ("source", "asked", "inverse", "spoken", "marks")
"""What one form alone lets a file say: where it is from and what a function answers; or what the
other does without: the inverse problem, and words and letters for what has no name.
"""
ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "derive"
TESTS = ROOT / "tests"
PAGE = ROOT / "docs" / "architecture.md"
FILES = sorted(p for p in PACKAGE.rglob("*.py") if p.relative_to(PACKAGE).parts != ("__init__.py",))


def room(path: Path) -> str:
    """Return the module or the package folder, right below ``derive``, that holds a file."""
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def floor(name: str) -> int:
    """Return the height of a room; a room without a floor is an error with a sentence."""
    if name in MODULES:
        return len(ROOMS)
    if name not in ROOMS:
        raise LookupError(f"'derive/{name}' has no floor: give it one in tests/test_floors.py")
    return ROOMS.index(name)


@cache
def imported(text: str) -> frozenset[str]:
    """Return the dotted name of every module that a source text imports, wherever it does."""
    found = set()
    for node in nodes_of(parsed(text)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module == "derive":
            found |= {f"derive.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module)
    return frozenset(found)


def faults(name: str, text: str) -> list[str]:
    """Return a sentence for every import of room ``name`` that goes up, or out of the package."""
    modules = imported(text)
    rooms = {m.split(".")[1] for m in modules if m.startswith("derive.")}
    rooms -= {name, "__version__", *(API if name in OUTERMOST else ())}
    up = [
        f"derive/{name} (floor {floor(name)}) imports derive/{other} (floor {floor(other)})"
        for other in sorted(rooms)
        if floor(other) > floor(name)
    ]
    return up + [f"derive/{name} imports {m}" for m in modules if m.split(".")[0] == "bench"]


def test_a_module_imports_only_from_its_floor_or_below() -> None:
    assert [f for p in FILES for f in faults(room(p), p.read_text(encoding="utf-8"))] == []


def askers() -> list[str]:
    """Return the modules outside mechanics that import from it."""
    return [_dotted(p) for p in FILES if room(p) != "mechanics" and asks(p.read_text("utf-8"))]


def asks(text: str) -> bool:
    return any(m.split(".")[:2] == ["derive", "mechanics"] for m in imported(text))


def test_few_modules_outside_mechanics_import_it() -> None:
    assert len(askers()) <= MOST_ASKERS, askers()


def test_a_module_that_imports_mechanics_is_counted_however_it_does() -> None:
    for line in ("from derive import mechanics", "import derive.mechanics.sheet as s",
                 "if T:\n    from derive.mechanics.problem import Problem"):  # fmt: skip
        assert asks(line)
    assert not asks("from derive.lower.arrange import plan")


def forms_known(text: str) -> set[str]:
    """Return what a source text names of the two forms that a scene may be written in."""
    nodes = nodes_of(parsed(text))
    names = {getattr(n, "id", getattr(n, "attr", "")) for n in nodes}
    names |= {alias.name for n in nodes if isinstance(n, ast.ImportFrom) for alias in n.names}
    return {*FORMS} & {*names, *(part for m in imported(text) for part in m.split("."))}


def test_nothing_but_the_reader_that_picks_it_knows_in_which_form_a_scene_was_written() -> None:
    outside = [p for p in FILES if PACKAGE / "scene" / "short_form" not in p.parents]
    known = {_dotted(p): forms_known(p.read_text("utf-8")) for p in outside}
    assert {name: words for name, words in known.items() if words} == PICKS


def telling(scenes: Mapping[bool, list[Scene]]) -> set[str]:
    """Return the fields of scenes that are set in one form and in the other not."""
    names = [field.name for field in fields(Scene)]
    told = {
        form: {n: {bool(getattr(s, n)) for s in each} for n in names}
        for form, each in scenes.items()
    }
    return {n for n in names if told[True][n].isdisjoint(told[False][n])}


def test_no_field_of_a_scene_is_a_flag_for_its_form() -> None:
    scenes = {
        form: [scene_of(n) for n in catalogue() if (n in SHORT) == form] for form in (True, False)
    }
    assert telling(scenes) == {*OF_ONE_FORM}
    flagged = {form: [replace(s, merging="x" * form) for s in own] for form, own in scenes.items()}
    assert telling(flagged) == {*OF_ONE_FORM, "merging"}


@pytest.mark.parametrize(
    "text",
    [
        "from derive.scene.short_form.inertia import carrier",
        "from derive.scene import short_form",
        "x = ShortForm()",
        "if scene.short_form: pass",
    ],
)
def test_a_module_that_asks_in_which_form_a_scene_was_written_is_found(text: str) -> None:
    assert forms_known(text) != set()


def knows_sympy(path: Path) -> bool:
    return "sympy" in {m.split(".")[0] for m in imported(path.read_text(encoding="utf-8"))}


def barred() -> list[Path]:
    named = [PACKAGE / name for name in WITHOUT_SYMPY]
    return [
        p
        for place in named
        for p in (place.rglob("*.py") if place.is_dir() else [place.with_suffix(".py")])
    ]


def test_sympy_stays_out_of_the_modules_that_must_not_know_it() -> None:
    assert [str(p) for p in barred() if knows_sympy(p)] == []
    assert any(map(knows_sympy, FILES))


def rows(text: str) -> list[str]:
    """Return the room that each row of the page's table names."""
    table = [line.split("|") for line in text.splitlines() if line.startswith("| ")]
    return [name for row in table for name in re.findall(r"^ `(\w+)/`", row[1])]


def test_the_page_names_every_room_in_the_order_of_the_floors() -> None:
    assert rows(PAGE.read_text(encoding="utf-8")) == list(ROOMS)


def test_a_room_that_the_page_leaves_out_or_moves_is_found() -> None:
    page = PAGE.read_text(encoding="utf-8")
    for before, after in (("| `scene/`", "| scene"), ("| `lower/`", "| `check/`")):
        assert before in page
        assert rows(page.replace(before, after)) != list(ROOMS)


def test_the_package_holds_three_modules_and_the_rooms_and_nothing_else() -> None:
    held = {p.name for p in PACKAGE.iterdir() if p.name != "__pycache__"}
    assert held == {*ROOMS, *(f"{name}.py" for name in MODULES), *({"py.typed"} & held)}


def test_no_file_has_more_lines_than_one_can_keep_in_mind() -> None:
    files = [p for top in ("derive", "bench", "tests") for p in (ROOT / top).rglob("*.py")]
    assert len(files) > 300
    assert [str(p) for p in files if len(p.read_text().splitlines()) > MOST_LINES] == []


def test_every_room_has_a_folder_of_tests_with_its_name() -> None:
    folders = {p.parent.relative_to(TESTS).parts[:1] for p in TESTS.rglob("test_*.py")}
    assert folders == {(), ("bench",), *((name,) for name in ROOMS)}


@pytest.mark.parametrize("name", ROOMS)
def test_every_room_says_in_one_sentence_what_comes_in_and_goes_out(name: str) -> None:
    said = ast.get_docstring(
        ast.parse((PACKAGE / name / "__init__.py").read_text(encoding="utf-8"))
    )
    assert said is not None
    first = said.split("\n\n")[0]
    assert re.search(r"\bin, .*\bout\b", first)


def asked(text: str) -> set[str]:
    """Return what a command imports of the package beside the interface of Python."""
    own = {m for m in imported(text) if m.split(".")[0] == "derive"}
    return {m for m in own if m not in SPOKEN and ".".join(m.split(".")[:2]) not in SPOKEN}


def test_commands_use_the_interface_of_python_and_no_other_way() -> None:
    files = [p for p in FILES if room(p) == "command" and p.stem not in OF_THEIR_OWN]
    assert {p.stem: found for p in files if (found := asked(p.read_text("utf-8")))} == {}
    assert asked("from derive.check import check\nfrom derive.solve.handle import load") == {
        "derive.check"
    }


def test_nothing_below_the_commands_uses_the_interface_of_python() -> None:
    below = [p for p in FILES if room(p) not in OUTERMOST]
    assert [str(p) for p in below if "derive" in imported(p.read_text("utf-8"))] == []


def test_an_import_that_goes_up_is_found() -> None:
    assert faults("program", "from derive.cli import main") == [
        "derive/program (floor 2) imports derive/cli (floor 14)"
    ]
    assert faults("program", "def f():\n    from derive import emit") != []
    assert faults("command", "from bench import show") == ["derive/command imports bench"]


def test_a_module_without_a_floor_is_named() -> None:
    with pytest.raises(LookupError, match=r"'derive/helpers' has no floor"):
        floor("helpers")


def test_no_import_goes_round_in_a_circle() -> None:
    graph = {_dotted(path): _modules(path) for path in FILES}
    while leaves := {name for name, needs in graph.items() if not needs & graph.keys()}:
        graph = {name: needs for name, needs in graph.items() if name not in leaves}
    assert graph == {}


def _dotted(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts).removesuffix(".__init__")


def _modules(path: Path) -> frozenset[str]:
    return imported(path.read_text(encoding="utf-8")) - {_dotted(path)}
