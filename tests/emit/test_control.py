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
LONGEST_PAGE = 170


def test_every_kind_of_block_is_run_and_the_page_is_short() -> None:
    assert [block.language for block in BLOCKS] == ["toml", "sh", "python", "sh", "python"]
    assert len(PAGE.read_text(encoding="utf-8").splitlines()) <= LONGEST_PAGE


@pytest.mark.long
def test_from_the_scene_to_a_trajectory_and_to_a_horizon_of_ones_own(tmp_path: Path) -> None:
    scene, steer, use, generate, program = BLOCKS
    (tmp_path / "craft.toml").write_text(scene.text, encoding="utf-8")
    assert told(shlex.split(steer.text), tmp_path) == printed(steer.shown or "")
    told([*shlex.split(generate.text), "--samples", "256"], tmp_path)  # to be quick
    places = {"XDG_CACHE_HOME": str(tmp_path / "cache"), "PYTHONPATH": str(tmp_path)}
    for one in (use, program):
        (tmp_path / "use.py").write_text(one.text, encoding="utf-8")
        done = subprocess.run(
            [sys.executable, "use.py"],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
            env=os.environ | places,
        )
        assert done.returncode == 0, done.stderr
        assert printed(done.stdout) == printed(one.shown or "")
