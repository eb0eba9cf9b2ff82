"""The project's own promises: two commands, six verbs, and packages that are complete."""

import ast
import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path
from pkgutil import resolve_name

from hatchling.builders.wheel import WheelBuilder

from derive import __version__
from tests.source import nodes_of, parsed

ROOT = Path(__file__).parent.parent
TESTS = sorted((ROOT / "tests").rglob("*.py"))
SETUP = "python3.11 -m venv .venv && .venv/bin/python -m pip install -q --no-compile -e"
TEST = f"{SETUP} '.[test]' && .venv/bin/python -m pytest -q -n auto"
GENERATE = f"{SETUP} . && .venv/bin/derive generate"


def test_the_readme_has_one_command_for_the_job_and_one_for_the_tests() -> None:
    lines = [line.strip() for line in (ROOT / "README.md").read_text().splitlines()]
    assert lines.count(GENERATE) == 1
    assert [line for line in lines if line.startswith("python3.11") and "pytest" in line] == [TEST]


def test_continuous_integration_runs_the_readmes_test_command() -> None:
    pattern = re.search(r"sed -n 's/\^ \*\\\((.*)\\\)\$/\\1/p' README\.md", ci())
    assert pattern
    found = re.findall(rf"^ *({pattern[1]})$", (ROOT / "README.md").read_text(), re.MULTILINE)
    assert found == [TEST]


def ci() -> str:
    """Return the text of the script that continuous integration runs."""
    return (ROOT / ".ci" / "run").read_text()


def test_every_link_of_a_page_leads_to_a_file_and_to_a_heading_in_it() -> None:
    pages = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]
    dead = [(page.name, link) for page in pages for link in links(page) if not leads(page, link)]
    assert dead == []
    assert not leads(ROOT / "README.md", "docs/nowhere.md")
    assert not leads(ROOT / "README.md", "docs/scenes.md#nowhere")


def links(page: Path) -> list[str]:
    """Return the links of a page that stay within the project."""
    found: list[str] = re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8"))
    return [link for link in found if "://" not in link]


def leads(page: Path, link: str) -> bool:
    """Tell whether a link of a page leads to a file and, behind a "#", to a heading of it."""
    path, _, place = link.partition("#")
    file = page.parent / path if path else page
    if not file.is_file():
        return False
    headings = re.findall(r"^#+ (.*)$", file.read_text(encoding="utf-8"), re.MULTILINE)
    return place in {"", *(re.sub(r"[^\w -]", "", h.lower()).replace(" ", "-") for h in headings)}


def test_what_the_recipes_name_stands_where_they_say() -> None:
    recipes = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    assert astray(recipes) == []
    assert astray(recipes.replace("`FUNCTIONS`", "`MISLAID`")) == ["MISLAID"]
    assert astray("| `derive/scene/gone.py` | a row | |") == ["derive/scene/gone.py"]
    assert astray("as `scene/gone.py` has it") == ["derive/scene/gone.py"]


def astray(recipes: str) -> list[str]:
    """Return the files and, row by row, the tables and functions that are not where recipes say."""
    made = r"midpoint|julia|finite"  # by whoever follows the recipes
    paths = re.findall(r"`((?:derive|tests|docs|bench|templates)/[\w/]*[\w.]*)`", recipes)
    every = [
        f"derive/{p}" for p in re.findall(r"`((?!derive|tests|bench)\w+/[\w/]+\.py)`", recipes)
    ]
    lost = [p for p in paths + every if not (ROOT / p).exists() and not re.search(made, p)]
    for row in re.findall(r"^\| `.*$", recipes, re.MULTILINE):
        where, what = row.split("|")[1:3]
        files = [
            ROOT / "derive" / p for p in re.findall(r"`(?:derive/)?([\w/]+\.py)`", where + what)
        ]
        texts = [file.read_text(encoding="utf-8") for file in files if file.is_file()]
        texts += [
            f.read_text(encoding="utf-8") for file in files[:1] for f in file.parent.glob("*.py")
        ]
        names = re.findall(r"`(_\w+|[A-Z][A-Z_]+)`", what)
        lost += [n for n in names if not any(re.search(rf"\b{n}\b", text) for text in texts)]
    return lost


def test_the_makefile_has_six_verbs() -> None:
    verbs = re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    assert verbs == ["generate", "test", "lint", "check", "bench", "report"]


def test_the_wheel_holds_every_template_and_every_scene(tmp_path: Path) -> None:
    wheel = next(WheelBuilder(str(ROOT)).build(directory=str(tmp_path), versions=["standard"]))
    held = set(zipfile.ZipFile(wheel).namelist())
    templates = {f"derive/{p.relative_to(ROOT)}" for p in (ROOT / "templates").rglob("*.jinja")}
    data = {str(p.relative_to(ROOT)) for p in (ROOT / "derive").rglob("*.[tc]*") if p.is_file()}
    wanted = templates | {name for name in data if name.endswith((".toml", ".c"))}
    assert len(templates) > 0
    assert wanted - held == set()
    assert "derive/py.typed" in held
    assert re.fullmatch(r"derive_eom-[\d.]+-py3-none-any\.whl", Path(wheel).name)


def test_what_the_packages_weigh_is_held_against_what_the_readme_says(tmp_path: Path) -> None:
    says = (ROOT / "README.md").read_text(encoding="utf-8")
    (wheel, installed), *_ = re.findall(r"wheel of ([\d.]+) MB; [^.]+, (\d+) MB", says)
    found, place = tmp_path / "derive.whl", tmp_path / "environment"
    place.mkdir()

    def told(part: float) -> int:
        found.write_bytes(bytes(round(float(wheel) * 1e6)))
        with (place / "all").open("wb") as file:
            file.truncate(round(float(installed) * part * 1e6))
        command = [sys.executable, ROOT / ".ci" / "weight", found, place]
        return subprocess.run(command, capture_output=True, check=False).returncode

    assert (told(1.0), told(1.2), told(0.8)) == (0, 1, 1)


def test_the_citation_is_of_this_version_and_licence() -> None:
    said = dict(re.findall(r"^(\w+): (.+)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert (said["version"], said["license"]) == (__version__, project["license"])


def test_every_dependency_has_a_lower_bound() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    every = [*project["dependencies"]]
    for extra in project["optional-dependencies"].values():
        every += extra
    own = [name for name in every if name.startswith("derive")]
    assert own == ["derive-eom[test]"]
    assert project["name"] == "derive-eom"  # the package index has another derive
    assert project["scripts"] == {"derive": "derive.__main__:run"}
    bounded = re.compile(r"[\w-]+>=[\d.]+")
    assert [name for name in every if name not in own and not bounded.fullmatch(name)] == []


def test_every_test_shows_what_it_asserts_or_which_error_it_expects() -> None:
    files = sorted((ROOT / "tests").rglob("test_*.py"))
    tests = [
        (file.name, node.name, node)
        for file in files
        for node in nodes_of(parsed(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
    ]
    assert len(tests) > len(files)
    assert [test[:2] for test in tests if not asserts(test[2])] == []
    assert not asserts(ast.parse("def test_nothing(): print()"))


def asserts(function: ast.AST) -> bool:
    inner = list(ast.walk(function))
    names = {node.attr for node in inner if isinstance(node, ast.Attribute)}
    return bool({"raises", "warns"} & names) or any(isinstance(n, ast.Assert) for n in inner)


def test_what_a_test_replaces_is_there_also_where_only_the_longer_run_would_tell() -> None:
    found = [(page, *r) for page in TESTS for r in replaced(page.read_text(encoding="utf-8"))]
    assert len(found) > 20
    assert [(page.name, *path) for page, *path in found if not stands(*path)] == []
    gone = "from derive import mechanics\npatch.setattr(mechanics, 'gone', 1)\n"
    assert [stands(*path) for path in replaced(gone)] == [False]
    gone = "import derive.mechanics\npatch.setattr(derive.mechanics, 'gone', 1)\n"
    assert [stands(*path) for path in replaced(gone)] == [False]


def replaced(text: str) -> list[tuple[str, str]]:
    """Return the dotted owner and the name of all that a test file's `setattr` replaces.

    Of owners that the file itself makes (a local variable) nothing is known before it runs.
    """
    tree = parsed(text)
    known = {
        (name.asname or name.name): f"{node.module}.{name.name}"
        for node in tree.body
        if isinstance(node, ast.ImportFrom)
        for name in node.names
    }
    found = []
    for node in nodes_of(tree):
        match node:
            case ast.Call(ast.Attribute(attr="setattr"), [ast.Constant(str(path)), *_]):
                found.append((*path.rpartition(".")[::2],))
            case ast.Call(
                ast.Attribute(attr="setattr"), [ast.Attribute() as own, ast.Constant(name), *_]
            ) if ast.unparse(own).startswith("derive."):
                found.append((ast.unparse(own), str(name)))
            case ast.Call(ast.Attribute(attr="setattr"), [ast.Name(own), ast.Constant(name), *_]):
                found += [(known[own], str(name))] if own in known else []
    return found


def stands(owner: str, name: str) -> bool:
    """Tell whether what a dotted path leads to has an attribute of that name."""
    try:
        return hasattr(resolve_name(owner), name)
    except (ImportError, AttributeError):
        return False
