"""Scripts of docs/examples: short ones, which print what their page shows and draw its pictures."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from derive.check.compiler import find_compiler
from tests.pages import NEAR, Block, blocks, curves

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "examples"
PAGE = ROOT / "docs" / "examples.md"
BLOCKS = {Path(block.text.split()[-1]).stem: block for block in blocks(PAGE)}
LONGEST = 40
NUMBER = re.compile(r"-?\d+(?:\.(\d+))?(?:e-?\d+)?")
DIGITS = 2  # of the last one: what machines and versions may make of it


def test_the_page_has_every_script_with_its_picture_and_all_are_short() -> None:
    scripts = [*FOLDER.glob("*.py"), *FOLDER.glob("*.c")]
    assert {script.stem for script in scripts} == BLOCKS.keys()
    assert max(len(script.read_text("utf-8").splitlines()) for script in scripts) <= LONGEST
    pictures = re.findall(r'src="examples/(\w+)\.svg" width="\d+" alt=', PAGE.read_text("utf-8"))
    assert pictures == [*BLOCKS]


@pytest.mark.long
@pytest.mark.parametrize("name", BLOCKS)
def test_a_script_prints_what_the_page_shows_and_draws_its_picture(
    name: str, tmp_path: Path
) -> None:
    block = BLOCKS[name]
    python, script = block.text.split()
    assert python == "python"
    places = {"PYTHONPATH": os.pathsep.join(sys.path), "XDG_CACHE_HOME": str(tmp_path)}
    places["CC"] = shlex.join(find_compiler().command)
    done = subprocess.run(
        [sys.executable, ROOT / script],
        cwd=tmp_path, capture_output=True, text=True, check=False, env=os.environ | places,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert is_as_shown(done.stdout, block), done.stdout
    made, kept = ((place / f"{name}.svg").read_text("utf-8") for place in (tmp_path, FOLDER))
    assert curves(made) == pytest.approx(curves(kept), abs=NEAR)
    assert len(curves(kept)) > 100


def is_as_shown(said: str, block: Block) -> bool:
    """Tell whether all words are those of the page, and numbers to two of their last digits."""
    shown = block.shown or ""
    if NUMBER.sub("#", said).split() != NUMBER.sub("#", shown).split():
        return False
    pairs = zip(NUMBER.finditer(said), NUMBER.finditer(shown), strict=True)
    return all(
        abs(float(one[0]) - float(other[0])) <= DIGITS * 10.0 ** -len(other[1] or "")
        for one, other in pairs
    )


def test_another_figure_or_another_word_is_noticed() -> None:
    block = Block("sh", "", "48 µrad off at 1.50 s\n")
    assert is_as_shown("49 µrad off  at 1.51 s", block)
    assert not is_as_shown("48 µrad off at 1.53 s", block)
    assert not is_as_shown("51 µrad off at 1.50 s", block)
    assert not is_as_shown("48 µrad on at 1.50 s", block)
