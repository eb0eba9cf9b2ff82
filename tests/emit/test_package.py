"""Packages for firmware: their test runs and notices, one header does, manifests are true."""

import json
import re
import subprocess
from pathlib import Path

import pytest

from derive.check.compiler import WARNINGS, find_compiler
from derive.cli import main
from derive.emit.c.columns import COLUMNS
from derive.emit.c.source import c_files
from derive.emit.files import write
from derive.emit.package.files import package_files
from derive.emit.package.kinds import BUILD_TOOLS, OURS
from derive.emit.package.vectors import VECTORS
from derive.library.fixed import with_fixed
from derive.library.library import library
from derive.program.precision import F32, PRECISIONS
from derive.scene import catalogue, parse_scene
from tests.made import library_of

NAME = "free_body_principal"
BALL = 'wanted = ["moment"]\n[body]\nkind = "spherical"\nmoment = "1"\n'


def packed(name: str) -> dict[str, str]:
    """Return the files of a scene's package."""
    made = library_of(name)
    return package_files(made, c_files(made, ()), (), tuple(BUILD_TOOLS), PRECISIONS)


def status(folder: Path, *units: str) -> int:
    """Return what a program of some units in a folder ends with; a warning is an error."""
    include = ("-Isrc", "-Itest", "-Isingle")
    command = (*find_compiler().command, "-std=c99", "-O1", *WARNINGS, *include)
    answer = subprocess.run(
        [*command, *units, "-o", "made", "-lm"], cwd=folder, capture_output=True, text=True
    )
    assert answer.returncode == 0, answer.stderr
    return subprocess.run([folder / "made"], check=False, capture_output=True).returncode


def units(name: str, texts: dict[str, str]) -> list[str]:
    """Return the sources of a package and of its test."""
    return [file for file in texts if file.endswith(".c") and not file.startswith("examples")]


@pytest.mark.parametrize(
    "name", [NAME, *(pytest.param(n, marks=pytest.mark.long) for n in catalogue() if n != NAME)]
)
def test_the_test_of_a_package_passes_and_its_example_runs(name: str, tmp_path: Path) -> None:
    write(tmp_path, texts := packed(name))
    assert status(tmp_path, *units(name, texts)) == 0
    sources = [file for file in texts if re.fullmatch(r"src/.*\.c", file)]
    assert status(tmp_path, "examples/example_main.c", *sources) == 0


@pytest.mark.parametrize(("old", "new"), [
    ("moment_x_in + t1", "moment_x_in - t1"),
    ("omega_dot[0] = t3;", "omega_dot[0] = -t3;"),
    ("= s6.high;", "= s6.low;"),
    ("return 0;", "return 1;"),
])  # fmt: skip
def test_wrong_c_fails_it(old: str, new: str, tmp_path: Path) -> None:
    made, file = library_of(NAME), f"src/{NAME}_f32.c"
    texts = package_files(made, c_files(made, ()), (), ("make",), (F32,))
    assert old in texts[file]
    write(tmp_path, texts | {file: texts[file].replace(old, new, 1)})
    assert status(tmp_path, *units(NAME, texts)) == 1


def test_it_has_as_many_vectors_as_it_says_of_every_function() -> None:
    text = packed(NAME)[f"test/{NAME}_test_f32.c"]
    assert f"{VECTORS} reference vectors of each function" in text
    named = re.findall(r"wanted_(\w+)\[(\d+)\]\[\d+\] = {\n((?:    .*\n)*)};", text)
    assert {name for name, *_ in named} == {p.name for p in library_of(NAME).emitted()}
    assert {rows.count("    {\n") for *_, rows in named} == {VECTORS}


CALLER = f"""
#include "{NAME}_f32_single.h"
int main(void)
{{
    {NAME}_constants_f32 constants;
    float omega[3] = {{1.0F, 2.0F, 3.0F}}, energy = 0.0F;
    if ({NAME}_setup_f32(1.0F, 2.0F, 3.0F, &constants) != 0) {{
        return 1;
    }}
    {NAME}_kinetic_energy_f32(&constants, omega, &energy);
    return energy < 18.0F || energy > 18.0F;
}}
"""


def test_one_unit_makes_the_functions_of_a_single_header_and_others_call_them(
    tmp_path: Path,
) -> None:
    made = f'#define {NAME.upper()}_F32_IMPLEMENTATION\n#include "{NAME}_f32_single.h"\n'
    write(tmp_path, packed(NAME) | {"made.c": made + made.splitlines()[1], "calls.c": CALLER})
    assert status(tmp_path, "made.c", "calls.c") == 0
    assert status(tmp_path, "made.c", f"test/{NAME}_test_f32.c", "calls.c") == 0


@pytest.mark.long
@pytest.mark.parametrize("name", [NAME, "attitude", "rigid_body_steps"])
def test_a_package_is_the_same_each_time_and_says_how_it_is_made_again(name: str) -> None:
    texts = packed(name)
    assert texts == packed(name)
    for file, text in texts.items():
        assert any(mark in text for mark in OURS), file
        if file.endswith((".c", ".h")):
            assert max(map(len, text.splitlines())) <= COLUMNS, file
    assert f"`derive generate {name} --package DIR`" in texts["README.md"]
    few = package_files(library_of(name), c_files(library_of(name), ()), (), ("make",), (F32,))
    assert f"{name} --package DIR --precision float --for make`" in few["README.md"]
    assert {*few} < {*texts}
    assert not [file for file in few if "f64" in file]


def test_manifests_name_what_is_there() -> None:
    texts = packed(NAME)
    said = json.loads(texts["library.json"])
    assert {f"src/{file}" for file in said["headers"]} < {*texts}
    lines = texts["library.properties"].splitlines()[1:]
    properties = dict(line.split("=", 1) for line in lines)
    # https://arduino.github.io/arduino-cli/latest/library-specification/
    assert re.fullmatch(r"[A-Za-z0-9][\w .-]{0,62}", properties["name"])
    assert re.fullmatch(r"\d+\.\d+\.\d+", properties["version"])
    assert properties["category"] in {"Device Control", "Data Processing", "Other"}
    assert {*properties} >= {"author", "maintainer", "sentence", "paragraph", "url"}
    assert properties["architectures"] == "*"
    assert f"examples/{NAME}/{NAME}.ino" in texts
    listed = re.findall(r"[\w./]*\w+_f\d\d\.[ch]", texts["CMakeLists.txt"])
    assert {file for file in listed if file.startswith("src/")} == {
        file for file in texts if file.startswith("src/")
    }


def test_every_tool_is_told_of_in_the_readme_of_a_package_and_in_the_docs() -> None:
    root = Path(__file__).parents[2]
    page = (root / "docs" / "firmware.md").read_text(encoding="utf-8")
    own = packed(NAME)["README.md"]
    for word in ("CMake", "PlatformIO", "Arduino", "ESP-IDF", "Zephyr", "Make"):
        assert f"| {word} |" in own
        assert word in page
    assert "--package" in (root / "README.md").read_text(encoding="utf-8")


def test_fixed_parameters_are_in_the_test_too(tmp_path: Path) -> None:
    made = with_fixed(library_of(NAME), {"I_xx": 1.0, "I_yy": 2.0, "I_zz": 2.5})
    texts = package_files(made, c_files(made, ()), (), ("make",), (F32,))
    assert "setup" not in "".join(texts.values()).replace("set-up", "")
    write(tmp_path, texts)
    assert status(tmp_path, *units(NAME, texts)) == 0


def test_a_title_with_signs_of_other_languages_stays_a_title() -> None:
    title = "Top \"A\" 'b' $(C) ${D} | E <f> # 100 % = g: h, \u03c9"
    text = f"title = {json.dumps(title)}\n{BALL}"
    made = library(parse_scene(text, "ball"))
    texts = package_files(made, c_files(made, ()), (), tuple(BUILD_TOOLS), PRECISIONS)
    assert json.loads(texts["library.json"])["description"] == title
    assert f"sentence={title}\n" in texts["library.properties"]
    assert f"description: {json.dumps(title, ensure_ascii=False)}\n" in texts["idf_component.yml"]
    assert title not in texts["CMakeLists.txt"] + texts["Makefile"] + texts["zephyr/Kconfig"]
    assert title.replace("<", "&lt;") in texts["README.md"]


REFUSED = {
    "ball.toml rigid_body --package out": "generate: --package takes one scene, but 2 were named",
    "--package out": "generate: --package takes one scene, but none was named",
    "ball.toml --for make": "generate: --for needs --package DIR",
    "ball.toml --precision float": "generate: --precision needs --package DIR",
    "ball.toml --package out --check": "generate: --package does not go with --check",
    "ball.toml --package out --for make,bazel": "generate: argument --for: must be some of cmake,"
    " platformio, arduino, esp-idf, zephyr, make, with commas between, not 'bazel'",
    "ball.toml --package out --precision half": "generate: argument --precision: must be one of",
    "ball.toml --package file": "output folder 'file' must be writable, but: it is no folder",
    "ball.toml --package .": "package '.' must be a folder of its own, but holds another 'READ",
    "test.toml --package out": "scene 'test': must have another name, for CMake has a 'te",
}


@pytest.mark.parametrize("typed", REFUSED)
def test_what_can_be_no_package_is_refused_by_one_sentence(
    typed: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    before = {"file": "", "README.md": "mine", **dict.fromkeys(("ball.toml", "test.toml"), BALL)}
    for name, text in before.items():
        Path(name).write_text(text)
    assert main(["generate", "--samples=64", *typed.split()]) == 2
    sentence, *more = capsys.readouterr().err.splitlines()
    assert more == []
    assert sentence.startswith(f"derive: {REFUSED[typed]}")
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == before


@pytest.mark.long
def test_the_command_writes_a_package_and_then_writes_it_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("ball.toml").write_text(BALL)
    command = ["generate", "ball.toml", "--package", "lib", "--samples", "64", "--for", "make"]
    assert main(command) == 0
    assert "files in lib/" in capsys.readouterr().out
    first = {p: p.read_bytes() for p in Path("lib").rglob("*") if p.is_file()}
    assert main(command) == 0
    assert first == {p: p.read_bytes() for p in Path("lib").rglob("*") if p.is_file()}
    assert not Path("generated").exists()


@pytest.mark.long
@pytest.mark.parametrize(
    "typed", ["ball.toml --precision float", "ball.toml --for make", "other.toml"]
)
def test_a_package_is_not_laid_beside_files_of_another(
    typed: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("ball.toml").write_text(BALL)
    Path("other.toml").write_text(BALL)
    command = ["generate", "--package", "lib", "--samples", "64"]
    assert main([*command, "ball.toml"]) == 0
    before = {p: p.read_bytes() for p in Path("lib").rglob("*") if p.is_file()}
    assert main([*command, *typed.split()]) == 2
    assert "of its own, but holds" in capsys.readouterr().err
    assert before == {p: p.read_bytes() for p in Path("lib").rglob("*") if p.is_file()}
