"""Options that let a compiler change results are refused by the C, or change no bit of it."""

import subprocess
from pathlib import Path

import pytest

from derive.check.compiler import find_compiler
from derive.emit.c.source import c_files
from derive.emit.files import write
from derive.emit.package.files import package_files
from derive.program.precision import PRECISIONS
from tests.made import library_of

FREE = ("-fno-signed-zeros", "-fno-trapping-math")
LICENCES = [
    ("-ffast-math",),
    ("-ffinite-math-only",),
    ("-funsafe-math-optimizations", "-fno-reciprocal-math"),  # of which clang tells nothing
    ("-fassociative-math", *FREE),
]


@pytest.mark.parametrize("given", LICENCES, ids=lambda given: given[0])
@pytest.mark.parametrize("name", ["heavy_top", pytest.param("attitude", marks=pytest.mark.long)])
def test_c_is_not_compiled_or_the_test_of_its_package_passes(
    name: str, given: tuple[str, ...], tmp_path: Path
) -> None:
    made = library_of(name)
    texts = package_files(made, c_files(made, ()), (), ("make",), PRECISIONS)
    write(tmp_path, texts)
    units = [file for file in texts if file.endswith(".c") and not file.startswith("examples")]
    command = (*find_compiler().command, "-std=c99", "-O2", "-Isrc", "-Itest", "-Isingle")
    plain, licensed = (
        subprocess.run(
            [*command, *options, *units, "-o", program, "-lm"],
            cwd=tmp_path, check=False, capture_output=True, text=True,
        )
        for options, program in (((), "plain"), (given, "licensed"))
    )  # fmt: skip
    assert plain.returncode == 0
    assert subprocess.run([tmp_path / "plain"], check=False).returncode == 0
    if licensed.returncode == 0:
        assert subprocess.run([tmp_path / "licensed"], check=False).returncode == 0
    else:
        assert "-ffast-math and its parts break the stated errors" in licensed.stderr
