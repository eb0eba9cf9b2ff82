"""The page on optimal control is run from its first block to its last, and prints what it shows."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from tests.pages import blocks, printed, told

PAGE = Path(__file__).parents[2] / "docs" / "control.md"
BLOCKS = blocks(PAGE)
LONGEST_PAGE = 120


def test_every_kind_of_block_is_run_and_the_page_is_short() -> None:
    assert [block.language for block in BLOCKS] == ["toml", "sh", "python"]
    assert len(PAGE.read_text(encoding="utf-8").splitlines()) <= LONGEST_PAGE


@pytest.mark.long
def test_from_the_scene_to_a_converged_turn(tmp_path: Path) -> None:
    scene, command, program = BLOCKS
    (tmp_path / "craft.toml").write_text(scene.text, encoding="utf-8")
    told([*shlex.split(command.text), "--samples", "256"], tmp_path)  # to be quick
    (tmp_path / "use.py").write_text(program.text, encoding="utf-8")
    places = {"XDG_CACHE_HOME": str(tmp_path / "cache"), "PYTHONPATH": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "use.py"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | places,
    )
    assert done.returncode == 0, done.stderr
    assert printed(done.stdout) == printed(program.shown or "")
