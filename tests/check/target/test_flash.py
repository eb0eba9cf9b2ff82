"""The flash that set-up takes: little more at any level than at the smallest, and as is said."""

from pathlib import Path

import pytest

from derive.check.compiler import answer_of
from derive.check.target.build import _sizes
from derive.check.target.core import CORES, FLAGS
from derive.emit.c.source import APART, c_files
from derive.emit.files import manifests
from derive.library.library import library
from derive.scene import parse_scene
from tests.made import text_of

pytestmark = pytest.mark.target
GENERATED = Path(__file__).parents[3] / "generated"
SCENES = [
    path.parent.name for path in manifests(GENERATED)
    if "int " + path.parent.name + "_setup_f32(" in path.with_name(f"{path.stem}_f32.h").read_text()
]  # fmt: skip
MOST = 1.15
"""Of what it takes at -Os."""
HOT = "/* With DERIVE_ALLOW_CONTRACTION"
"""Where what is no set-up begins in a source."""
LIMITS = {"m4f": 4800, "m0plus": 6000}


def code(scene: str, core: str, level: str, folder: Path, mark: str = APART) -> int:
    """Return the bytes that linking a scene's set-up brings, for floats."""
    for ending in "ch":
        text = (GENERATED / scene / f"{scene}_f32.{ending}").read_text(encoding="utf-8")
        text = text.partition(HOT)[0].replace(f"{APART} static", f"{mark} static")
        (folder / f"{scene}_f32.{ending}").write_text(text)
    flags = [level if flag == "-O2" else flag for flag in FLAGS]
    made = (CORES[core].tools.compiler, *CORES[core].flags, *flags, "-fstack-usage")
    answer_of((*made, "-c", f"{scene}_f32.c", "-o", "scene.o"), folder)
    return _sizes(CORES[core], folder)[f"{scene}_setup_f32"].code


@pytest.mark.parametrize("core", LIMITS)
def test_set_up_takes_little_more_at_any_level_than_at_the_smallest(
    core: str, tmp_path: Path
) -> None:
    assert len(SCENES) >= 35
    parts = {
        scene: max(code(scene, core, o, tmp_path) for o in ("-O1", "-O2", "-O3"))
        / code(scene, core, "-Os", tmp_path)
        for scene in SCENES
    }
    assert {scene: part for scene, part in parts.items() if part > MOST} == {}


@pytest.mark.parametrize("core", LIMITS)
def test_a_body_of_any_inertia_is_set_up_by_so_little_code(core: str, tmp_path: Path) -> None:
    assert code("rigid_body", core, "-O3", tmp_path) <= LIMITS[core]


@pytest.mark.parametrize("core", LIMITS)
def test_copies_of_operations_are_noticed(core: str, tmp_path: Path) -> None:
    assert code("rigid_body", core, "-O3", tmp_path, "") > LIMITS[core]


def test_operations_of_functions_that_compute_in_pairs_are_copied() -> None:
    text = 'form = "accurate"\n' + text_of("free_body_principal")
    found = c_files(library(parse_scene(text, "own")), ())["own_f32.c"]
    assert "own_mul_f32" in found
    assert APART not in found
