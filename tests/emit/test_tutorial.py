"""The tutorial is run from its first block to its last, and prints and draws what it shows."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from derive.check.compiler import find_compiler
from tests.pages import NEAR, Block, blocks, curves, printed, standalone, told

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "tutorial.md"
BLOCKS = blocks(PAGE)
END = "-- end of a block --\n"
pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the files that the tutorial saves in it."""
    place = tmp_path_factory.mktemp("tutorial")
    names = re.findall(r"as\s+`(\w+\.(?:toml|c))`:", PAGE.read_text(encoding="utf-8"))
    files = [block for block in BLOCKS if block.language in {"toml", "c"}]
    for name, block in zip(names, files, strict=True):
        (place / name).write_text(block.text, encoding="utf-8")
    return place


@pytest.fixture(scope="module")
def shells(folder: Path) -> list[str]:
    """Return what the commands of the tutorial print, each after those before it."""
    return [_ran(block, folder) for block in BLOCKS if block.language == "sh"]


def _ran(block: Block, folder: Path) -> str:
    lines = [shlex.split(line) for line in block.text.splitlines()]
    if lines[0][0] == "derive":
        return "".join(told(line, folder) for line in lines)
    built, called = lines
    assert built[0] == "cc"
    return _of([*find_compiler().command, *built[1:]], folder) + _of(called, folder)


def _of(command: list[str], folder: Path) -> str:
    places = {"PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, check=False, env=os.environ | places
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return printed(done.stdout) if done.stdout else ""


@pytest.fixture(scope="module")
def programs(shells: list[str], folder: Path) -> list[str]:
    """Return what the tutorial's Python prints, block by block, after its commands have run."""
    assert shells
    texts = [block.text for block in BLOCKS if block.language == "python"]
    (folder / "use.py").write_text(f"print({END[:-1]!r})\n".join(texts), encoding="utf-8")
    return [printed(text) for text in _of([sys.executable, "use.py"], folder).split(END)]


def test_every_block_is_run_or_saved() -> None:
    assert {block.language for block in BLOCKS} == {"toml", "sh", "python", "c"}
    shown = [block.language for block in BLOCKS if block.shown is not None]
    assert (shown.count("sh"), shown.count("python")) == (5, 4)


def test_the_commands_print_what_is_shown(shells: list[str]) -> None:
    shown = [block.shown or "" for block in BLOCKS if block.language == "sh"]
    assert [*map(_unmeasured, shells)] == [*map(_unmeasured, shown)]


def _unmeasured(text: str) -> str:
    """Return what is printed without what a machine decides: times, and its sine's last digits."""
    untimed = re.sub(r"[\d.]+ (ns|µs|ms) a step", "TIME a step", text)
    return re.sub(r"keeps below \de-\d", "keeps below LEAST", untimed)


def test_the_python_prints_what_is_shown(programs: list[str]) -> None:
    own = [block.shown or "" for block in BLOCKS if block.language == "python"]
    assert programs == own


def test_the_pictures_of_the_tutorial_are_those_that_it_makes(
    programs: list[str], folder: Path
) -> None:
    assert programs
    derive = ["derive", "generate", "wheel.toml", "--samples", "256"]
    told(derive, folder)
    page = (folder / "generated" / "wheel" / "wheel.html").read_text(encoding="utf-8")
    (folder / "wheel.svg").write_text(standalone(page), encoding="utf-8")
    linked = re.findall(r'src="pictures/(\w+\.svg)"', PAGE.read_text(encoding="utf-8"))
    assert len(linked) == 3
    for name in linked:
        kept = (ROOT / "docs" / "pictures" / name).read_text(encoding="utf-8")
        made = (folder / name).read_text(encoding="utf-8")
        assert curves(made) == pytest.approx(curves(kept), abs=NEAR), folder / name
        assert len(curves(kept)) > 100
