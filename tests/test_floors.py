"""Imports go down the floors, never up and never in a circle; SymPy stays with the symbols."""

import ast
import re
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path

import pytest

FLOORS = (
    (
        *("escape", "added", "vectors", "formula", "grammar", "unit", "scene", "catalogue"),
        *("program", "graph", "largest"),
    ),
    (
        *("particles", "pairs", "pair_sine", "arithmetic", "status"),
        *("trace", "operations", "recorded", "rotations", "tree", "rate", "facts", "relations"),
    ),
    ("expand", "derivative", "table", "share", "write"),
    ("step", "notation", "principal", "vocabulary", "valuation", "wording"),
    ("lecture", "schedule", "motion"),
    ("specialise", "truth", "draft", "staging", "inverse", "attitude", "along_body", "arrange"),
    ("machine",),
    ("lower", "forms", "stage", "function"),
    ("flows",),
    ("setting", "admission", "motions", "singular", "library"),
    ("saving",),
    (
        *("c_text", "status_text", "scope", "series_text", "compact_text", "definition"),
        *("comment", "signature", "example", "emit", "casadi_text", "casadi_module"),
        *("manifest", "page"),
    ),
    (
        *("blocks", "equations", "solution", "reference", "body_sample", "sample", "prove"),
        *("columns", "scale"),
        *("measure", "motion_error", "draw", "search", "stated", "kept"),
        *("convergence", "differences"),
    ),
    ("cloud", "gallery"),
    ("files", "generation", "check", "bench", "report", "solve"),
    ("command",),
    ("cli", "__main__"),
)
WITHOUT_SYMPY = (
    *(
        "program",
        "formula",
        "unit",
        "scene",
        "trace",
        "operations",
        "recorded",
        "flows",
        "rotations",
        "graph",
        "expand",
        "table",
        "share",
        "write",
    ),
    *("schedule", "derivative", "forms", "stage", "arithmetic", "c_text", "status_text"),
    *("casadi_text", "emit"),
)
PACKAGE = Path(__file__).parent.parent / "derive"
PAGE = PACKAGE.parent / "docs" / "architecture.md"
FILES = sorted(p for p in PACKAGE.rglob("*.py") if p.relative_to(PACKAGE).parts != ("__init__.py",))


def room(path: Path) -> str:
    """Return the module or the package folder, right below ``derive``, that holds a file."""
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def floor(name: str) -> int:
    """Return the height of a room; a room without a floor is an error with a sentence."""
    for height, patterns in enumerate(FLOORS):
        if any(fnmatch(name, pattern) for pattern in patterns):
            return height
    raise LookupError(f"module 'derive.{name}' has no floor: give it one in tests/test_floors.py")


def imported(text: str) -> Iterator[str]:
    """Yield the dotted name of every module that a source text imports, wherever it does."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module == "derive":
            yield from (f"derive.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module


def faults(name: str, text: str) -> list[str]:
    """Return a sentence for every import of room ``name`` that goes up."""
    rooms = {m.split(".")[1] for m in imported(text) if m.startswith("derive.")}
    rooms -= {name, "__version__"}
    return [
        f"derive.{name} (floor {floor(name)}) imports derive.{other} (floor {floor(other)})"
        for other in sorted(rooms)
        if floor(other) > floor(name)
    ]


def test_a_module_imports_only_from_its_floor_or_below() -> None:
    assert [f for p in FILES for f in faults(room(p), p.read_text(encoding="utf-8"))] == []


def knows_sympy(path: Path) -> bool:
    return "sympy" in {m.split(".")[0] for m in imported(path.read_text(encoding="utf-8"))}


def test_sympy_stays_out_of_the_modules_that_must_not_know_it() -> None:
    barred = [p for p in FILES if any(fnmatch(room(p), pattern) for pattern in WITHOUT_SYMPY)]
    assert [str(p) for p in barred if knows_sympy(p)] == []
    assert any(map(knows_sympy, FILES))


def rows(text: str) -> list[list[str]]:
    """Return the rooms that each row of the page's table of floors names."""
    table = [line.split("|") for line in text.splitlines() if line.startswith("| ")]
    named = [re.findall(r"`(\w+)/?`", row[2]) for row in table]
    return [row for row in named if row]


def test_the_page_names_every_room_in_the_order_of_the_floors() -> None:
    assert list(map(sorted, rows(PAGE.read_text(encoding="utf-8")))) == list(map(sorted, FLOORS))


def test_a_room_that_the_page_leaves_out_or_moves_is_found() -> None:
    page = PAGE.read_text(encoding="utf-8")
    for before, after in ((", `grammar`", ""), ("`machine/`", "`saving`"), ("`flows/`", "")):
        assert before in page
        assert list(map(sorted, rows(page.replace(before, after)))) != list(map(sorted, FLOORS))


def test_every_floor_and_pattern_is_of_a_room_that_is_there() -> None:
    rooms = {room(path) for path in FILES} | {"catalogue"}
    assert {name for names in FLOORS for name in names} == rooms
    assert all(any(fnmatch(name, pattern) for name in rooms) for pattern in WITHOUT_SYMPY)


def test_an_import_that_goes_up_is_found() -> None:
    assert faults("program", "from derive.cli import main") == [
        "derive.program (floor 0) imports derive.cli (floor 16)"
    ]
    assert faults("program", "def f():\n    from derive import emit") != []


def test_a_module_without_a_floor_is_named() -> None:
    with pytest.raises(LookupError, match=r"'derive\.helpers' has no floor"):
        floor("helpers")


def test_no_import_goes_round_in_a_circle() -> None:
    graph = {_dotted(path): _modules(path) for path in FILES}
    while leaves := {name for name, needs in graph.items() if not needs & graph.keys()}:
        graph = {name: needs for name, needs in graph.items() if name not in leaves}
    assert graph == {}


def _dotted(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts).removesuffix(".__init__")


def _modules(path: Path) -> set[str]:
    return set(imported(path.read_text(encoding="utf-8"))) - {_dotted(path)}
