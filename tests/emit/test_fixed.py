"""Parameters that are fixed: a table of constants in the place of set-up, of the same bits."""

import json
import re
import struct
import subprocess
from copy import copy
from pathlib import Path

import pytest

import derive
from derive.check.compiler import WARNINGS, find_compiler
from derive.cli import main
from derive.emit.c.source import c_files
from derive.emit.files import write
from derive.emit.package.files import package_files
from derive.emit.package.kinds import BUILD_TOOLS
from derive.library.fixed import fixed_constants, fixed_text, with_fixed
from derive.program.precision import F32, F64, PRECISIONS, Precision
from derive.solve.fixed import fix
from tests.made import library_of

NAME = "free_body_principal"
VALUES = {"I_xx": 1.3, "I_yy": 1.5, "I_zz": 1.9}
TEXT = "I_xx=1.3,I_yy=1.5,I_zz=1.9"


def by_set_up(name: str, values: dict[str, float], precision: Precision, folder: Path) -> bytes:
    """Return the bytes of the constants that the set-up in C makes."""
    made = library_of(name)
    kind, scalar = f"{name}_constants_{precision.name}", precision.scalar
    given = ", ".join(repr(values[q.name]) + precision.suffix for q in made.setup.inputs)
    text = (
        f'#include <stdio.h>\n#include "{name}_{precision.name}.h"\nint main(void)\n{{\n'
        f"    {kind} made;\n    if ({name}_setup_{precision.name}({given}, &made) != 0) {{\n"
        f"        return 1;\n    }}\n    fwrite(&made, sizeof({scalar}), "
        f"sizeof made / sizeof({scalar}), stdout);\n    return 0;\n}}\n"
    )
    write(folder, c_files(made, ()) | {"main.c": text})
    command = (*find_compiler().command, "-std=c99", "main.c", f"{name}_{precision.name}.c")
    subprocess.run([*command, "-o", "made", "-lm"], cwd=folder, check=True)
    return subprocess.run([folder / "made"], check=True, capture_output=True).stdout


def middle(name: str) -> dict[str, float]:
    """Return a value of every parameter of set-up, within its range and no short decimal."""
    return {
        q.name: float(q.ends[0] + (q.ends[1] - q.ends[0]) / 3)
        for q in library_of(name).setup.inputs
    }


@pytest.mark.long
@pytest.mark.parametrize("precision", [F32, F64], ids=lambda p: p.name)
@pytest.mark.parametrize("name", [NAME, "heavy_top", "gyrostat", "skewed_disc"])
def test_the_table_has_the_bits_that_set_up_makes(
    name: str, precision: Precision, tmp_path: Path
) -> None:
    values = middle(name)
    made = with_fixed(library_of(name), values)
    text = c_files(made, ())[f"{name}_{precision.name}.c"]
    table = text.partition(f"{name}_fixed_{precision.name} = {{\n")[2].partition("};")[0]
    found = [
        float(x.strip("()").rstrip("F")) for x in re.findall(r"^ +(\S+),", table, re.MULTILINE)
    ]
    assert len(found) == len(made.constants)
    form = f"{len(found)}{'f' if precision is F32 else 'd'}"
    assert struct.pack(form, *found) == by_set_up(name, values, precision, tmp_path)


@pytest.mark.long
def test_c_without_set_up_compiles_and_passes_the_test_of_its_package(tmp_path: Path) -> None:
    made = with_fixed(library_of(NAME), VALUES)
    texts = package_files(made, c_files(made, ()), (), tuple(BUILD_TOOLS), PRECISIONS)
    assert not any(f"{NAME}_setup" in text for text in texts.values())
    write(tmp_path, texts)
    units = [file for file in texts if file.endswith(".c") and not file.startswith("examples")]
    command = (*find_compiler().command, "-std=c99", *WARNINGS, "-Isrc", "-Itest", *units)
    subprocess.run([*command, "-o", "made", "-lm"], cwd=tmp_path, check=True)
    assert subprocess.run([tmp_path / "made"], check=False).returncode == 0
    wrong = texts[f"src/{NAME}_f32.c"].replace("1.5F, /* I_yy */", "1.25F, /* I_yy */")
    write(tmp_path, {f"src/{NAME}_f32.c": wrong})
    subprocess.run([*command, "-o", "made", "-lm"], cwd=tmp_path, check=True)
    assert subprocess.run([tmp_path / "made"], check=False).returncode == 1


@pytest.mark.long
def test_header_json_and_command_say_what_is_fixed(tmp_path: Path) -> None:
    command = ["generate", NAME, "--fixed", TEXT, "--samples", "64", "--out", str(tmp_path)]
    assert main(command) == 0
    folder = tmp_path / NAME
    header = (folder / f"{NAME}_f32.h").read_text(encoding="utf-8")
    assert f"--samples 64 --fixed {TEXT}`" in header
    assert "I_xx = 1.3, I_yy = 1.5, I_zz = 1.9" in header
    assert f"&{NAME}_fixed_f32, omega" in header
    said = json.loads((folder / f"{NAME}.json").read_text(encoding="utf-8"))
    symbols = {p.name: f"{NAME}_fixed_{p.name}" for p in PRECISIONS}
    assert said["fixed"] == {"parameters": VALUES, "symbols": symbols}
    assert said["functions"][0]["symbols"]["f32"] is None
    assert main([*command, "--check"]) == 0
    assert main(["generate", NAME, "--samples", "64", "--out", str(tmp_path), "--check"]) == 1


@pytest.mark.parametrize(("scenes", "fixed", "says"), [
    ([NAME], "I_xx=1.3,I_yy=1.5", "that set-up is told must be fixed, but not I_zz"),
    ([NAME], f"{TEXT},q=2", "has no 'q' to set"),
    ([NAME], TEXT.replace("1.3", "much"), "a value is a finite number"),
    ([NAME], TEXT.replace("1.3", "-1.3"), "set-up refuses these values"),
    ([NAME], TEXT.replace("1.3", "1e-60"), "; there I_xx = 1e-60 is 0"),
    ([NAME], f"{TEXT},I_xx=1.3", "'I_xx' is set twice"),
    ([NAME], "I_xx", "--fixed takes NAME=VALUE, as m=2,d=0.06, not 'I_xx'"),
    ([NAME, "heavy_top"], TEXT, "--fixed takes one scene, but 2 were named"),
    ([], TEXT, "--fixed takes one scene, but none was named"),
    (["attitude"], "m=2", "has no 'm' to set"),
])  # fmt: skip
def test_what_cannot_be_fixed_is_refused_by_a_sentence(
    scenes: list[str], fixed: str, says: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert main(["generate", *scenes, "--fixed", fixed, "--out", str(tmp_path)]) == 2
    said = " ".join(capsys.readouterr().err.split())
    assert says in said
    assert not any(tmp_path.iterdir())


@pytest.mark.long
def test_values_outside_of_their_ranges_are_warned_of(capsys, tmp_path: Path) -> None:
    wide = TEXT.replace("I_zz=1.9", "I_zz=2.7")
    command = ["generate", NAME, "--fixed", wide, "--samples", "64", "--out", str(tmp_path)]
    assert main(command) == 0
    assert "I_zz = 2.7 is outside of its range" in " ".join(capsys.readouterr().err.split())
    header = (tmp_path / NAME / f"{NAME}_f64.h").read_text(encoding="utf-8")
    assert "But I_zz = 2.7 is outside of its range" in header


def test_a_scene_is_fixed_from_python_too_and_values_are_told_as_they_are_taken() -> None:
    fixed = fix(derive.load(NAME), VALUES)
    assert fixed.library.fixed == VALUES
    assert copy(fixed).library.fixed == VALUES
    assert fixed_text(VALUES) == TEXT
    assert fixed_constants(fixed.library, F64)["I_yy"] == 1.5
    assert derive.load(NAME).library.fixed == {}
