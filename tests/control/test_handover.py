"""The page on other tools: each of them solves one turn by a scene's module, at the same cost."""

import os
import re
import shlex
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.pages import blocks, printed, told

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "handover.md"
ACADOS = ROOT / "tests" / "data" / "acados"
STAND_IN = ACADOS / "stand_in"
FIRST, *TOOLS = [block for block in blocks(PAGE) if block.language == "python"]
NAMES = ("rockit", "do_mpc", "integrator", "acados_template")
COST = "1.11625 N^2 m^2 s"
CHECKS = ("derivatives", "by_casadi")
LINES = 22  # of a tool's program


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder in which the scene of the page on optimal control was generated."""
    place = tmp_path_factory.mktemp("handover")
    scene, *_ = blocks(ROOT / "docs" / "control.md")
    (place / "craft.toml").write_text(scene.text, encoding="utf-8")
    told(shlex.split("derive generate craft.toml --casadi-external --samples 256"), place)
    return place


def said(text: str, folder: Path, script: str = "page.py", *more: Path) -> str:
    """Return what a script prints that imports, or is, a program behind the page's first block."""
    (folder / "page.py").write_text(FIRST.text + text, encoding="utf-8")
    places = {
        "PYTHONPATH": os.pathsep.join([str(folder), *map(str, more), *sys.path]),
        "XDG_CACHE_HOME": str(folder / "cache"),
    }
    done = subprocess.run(
        [sys.executable, folder / script],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | places,
    )
    assert done.returncode == 0, done.stderr
    return printed(done.stdout)


def test_the_page_has_a_short_program_for_every_tool() -> None:
    for name, block in zip(NAMES, TOOLS, strict=True):
        assert re.search(rf"\b{re.escape(name)}\b", block.text)
        assert len(block.text.splitlines()) <= LINES
        assert block.shown is None or COST in block.shown
    assert len(PAGE.read_text("utf-8").splitlines()) <= 170


@pytest.mark.long
@pytest.mark.parametrize(("name", "block"), [*zip(NAMES[:3], TOOLS, strict=False)], ids=NAMES[:3])
def test_a_tool_finds_the_cost_that_the_page_shows(name, block, folder: Path) -> None:
    if name != "integrator":
        pytest.importorskip(name, reason="pip install -e '.[handover]'")
    assert said(block.text, folder).endswith(printed(block.shown or ""))


@pytest.mark.long
def test_the_fields_of_acados_are_exact_and_enough_to_solve_the_turn(folder: Path) -> None:
    found = [said(TOOLS[3].text, folder, str(ACADOS / f"{n}.py"), STAND_IN) for n in CHECKS]
    assert found[0] == "derivatives by u and x: True\nrates: True omega_x moment_z\n"
    assert found[1] == f"{COST} True\n"


@pytest.mark.long
def test_a_field_that_acados_has_not_and_columns_in_another_order_are_noticed(
    folder: Path,
) -> None:
    check, text = str(ACADOS / "derivatives.py"), TOOLS[3].text
    with pytest.raises(AssertionError, match="has no attribute 'f_explicit'"):
        said(text.replace("craft.f_expl_expr =", "craft.f_explicit ="), folder, check, STAND_IN)
    turned = text.replace("[7, 8, 9, *range(7)]", "[*range(7), 7, 8, 9]")
    assert turned != text
    assert said(turned, folder, check, STAND_IN).startswith("derivatives by u and x: False")


@pytest.mark.long
@pytest.mark.skipif(find_spec("acados_template") is None, reason="it is on no package index")
def test_the_python_package_of_acados_solves_the_turn(folder: Path) -> None:
    found = said(TOOLS[3].text, folder, str(ACADOS / "by_acados.py"))
    assert found.splitlines()[-1] == f"status 0 {COST}"
