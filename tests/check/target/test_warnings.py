"""The emitted C for its targets: no warnings, and no double in float builds.

Needs gcc, clang and a cross compiler, which .ci/run installs. `derive check --target` compiles for
every core with the same warnings.
"""

import json
import re
import subprocess
from pathlib import Path

import pytest

from derive.check.compiler import WARNINGS
from derive.check.target.core import CORES
from derive.emit.files import manifests

pytestmark = pytest.mark.target

GENERATED = Path(__file__).parents[3] / "generated"
MANIFESTS = manifests(GENERATED)
COMPILERS = ("gcc", "clang")
ARM = {name: (CORES[name].tools.compiler, *CORES[name].flags) for name in ("m0plus", "m4f", "m7")}
DOUBLE_CALL = re.compile(r"__aeabi_(?:d\w+|f2d|i2d|l2d|ui2d|ul2d)|\b(?:sin|cos|sqrt|pow|fabs|fma)$")
DOUBLE_X86 = re.compile(r"\b(?:v?(?:add|sub|mul|div|sqrt)[sp]d|v?cvts[si]2sd|v?cvtps2pd)\b")

scenes = pytest.mark.parametrize("manifest", MANIFESTS, ids=lambda p: p.stem)
precisions = pytest.mark.parametrize("precision", ["f32", "f64"])


def run(*command: str) -> str:
    """Return what a command prints; fail with its complaint."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout}{done.stderr}"
    assert done.stderr == "", done.stderr
    return done.stdout


def source(manifest: Path, precision: str) -> str:
    """Return the path of a scene's C file."""
    files = json.loads(manifest.read_text(encoding="utf-8"))["files"]
    return str(manifest.parent / files[precision]["source"])


def test_there_are_scenes_to_compile() -> None:
    assert len(MANIFESTS) >= 7


@scenes
@precisions
@pytest.mark.parametrize("compiler", COMPILERS)
def test_it_compiles_without_a_warning(compiler, precision, manifest, tmp_path) -> None:
    out = str(tmp_path / "scene.o")
    own = source(manifest, precision)
    told = run(compiler, "-std=c99", "-O2", *WARNINGS, "-c", own, "-o", out)
    assert told == ""


@scenes
@pytest.mark.parametrize("core", ARM)
def test_a_float_build_calls_no_double_routine(core, manifest, tmp_path) -> None:
    out = str(tmp_path / "scene.o")
    run(*ARM[core], "-O2", "-std=c99", "-c", source(manifest, "f32"), "-o", out)
    assert doubles(run("arm-none-eabi-nm", "-u", out)) == []
    assert ".f64" not in run("arm-none-eabi-objdump", "-d", out)


@scenes
def test_a_float_build_for_the_host_has_no_double_instruction(manifest, tmp_path) -> None:
    out = str(tmp_path / "scene.o")
    run("gcc", "-O2", "-std=c99", "-c", source(manifest, "f32"), "-o", out)
    assert DOUBLE_X86.findall(run("objdump", "-d", out)) == []


def test_a_double_routine_in_a_float_build_is_noticed(tmp_path) -> None:
    text = "float f(float a); float f(float a) { return a * 1.1; }\n"
    (tmp_path / "slip.c").write_text(text)
    out, slip = str(tmp_path / "slip.o"), str(tmp_path / "slip.c")
    run(*ARM["m4f"], "-O2", "-c", slip, "-o", out)
    assert doubles(run("arm-none-eabi-nm", "-u", out)) == [
        "__aeabi_d2f",
        "__aeabi_dmul",
        "__aeabi_f2d",
    ]
    run("gcc", "-O2", "-c", slip, "-o", out)
    assert DOUBLE_X86.findall(run("objdump", "-d", out)) != []


def doubles(undefined: str) -> list[str]:
    """Return the routines for doubles among the undefined names of an object file."""
    names = [line.split()[-1] for line in undefined.splitlines() if line.strip()]
    return sorted(name for name in names if DOUBLE_CALL.search(name))
