"""The flash that set-up takes: within 15 % of the least at every level, and as small as is said."""

from pathlib import Path

import pytest

from derive.check.compiler import answer_of
from derive.check.target.build import _sizes
from derive.check.target.core import CORES, FLAGS
from derive.emit.c.source import APART, c_files
from derive.library.library import library
from derive.scene import parse_scene
from tests.made import library_of, text_of

pytestmark = pytest.mark.target
LEAST = 1.15
SCENES = ("rigid_body", "free_body_principal", "rolling_cone", "skewed_disc", "heavy_top")
LIMITS = {"m4f": 6500, "m0plus": 8000}


def code(scene: str, core: str, level: str, folder: Path, mark: str = APART) -> int:
    """Return the bytes that linking a scene's set-up brings, for floats."""
    texts = c_files(library_of(scene), ())
    for name, text in texts.items():
        (folder / name).write_text(text.replace(f"{APART} static", f"{mark} static"))
    flags = [level if flag == "-O2" else flag for flag in FLAGS]
    made = (CORES[core].tools.compiler, *CORES[core].flags, *flags, "-fstack-usage")
    answer_of((*made, "-c", f"{scene}_f32.c", "-o", "scene.o"), folder)
    return _sizes(CORES[core], folder)[f"{scene}_setup_f32"].code


@pytest.mark.parametrize("core", LIMITS)
@pytest.mark.parametrize("scene", SCENES)
def test_set_up_takes_little_more_at_any_level_than_at_the_smallest(
    scene: str, core: str, tmp_path: Path
) -> None:
    least = code(scene, core, "-Os", tmp_path)
    assert max(code(scene, core, o, tmp_path) for o in ("-O1", "-O2", "-O3")) <= LEAST * least


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
