"""Figures of cores: what compared nothing fails, what is kept is stated while it is of this C."""

import json
import shutil
from pathlib import Path

import pytest

from derive.check.target import judged
from derive.check.target.build import Bytes
from derive.check.target.core import CORES
from derive.check.target.harness import CALLS, all_of, count_of
from derive.check.target.run import Heard
from derive.cli import main
from derive.emit.c.source import c_files, sources_of
from derive.emit.manifest import manifest
from derive.emit.on_target import Cost, OnTarget, kept, of_text, to_text
from derive.emit.page.scene import scene_page
from derive.emit.reported import Beside, lying_beside
from derive.program.precision import F32
from tests.made import library_of

NAME = "free_body_principal"
COST = Cost("m4f", "Cortex-M4F", "f32", "moment", (277, 277), 1068, 0, 104, "gcc 12")
SOURCES = sources_of(library_of(NAME))
TEXT = to_text(NAME, [COST], SOURCES)
SAYS = "On Cortex-M4F, -O2: 277 instructions, 1068 B of code, 104 B of stack."


def outcomes(values: int = 0, bits: str = "ab", rows: int = 7) -> set[str]:
    """Return the verdicts on a target that says so many values too few and such bits."""
    library = library_of(NAME)
    every = all_of(library)
    here = [Heard("ab", CALLS * count_of(p), 0, 0, 0) for p in every]
    there = [Heard(bits, said.values - values, 90, 96, 8) for said in here][:rows]
    sizes = {f"{NAME}_{p.name}_f32": Bytes(8, 0, 0) for p in every}
    said = (here, there, there)
    return {row.outcome for row in judged(library, CORES["m4f"], F32, said, sizes)}


def test_equal_bits_of_all_values_hold() -> None:
    assert outcomes() == {"holds"}


def test_other_bits_fail() -> None:
    assert outcomes(bits="ac") == {"FAILS"}


def test_a_value_that_was_not_compared_fails() -> None:
    assert outcomes(values=1) == {"FAILS"}


@pytest.mark.parametrize("rows", [0, 6])
def test_functions_that_are_not_told_of_fail(rows: int) -> None:
    assert outcomes(rows=rows) == {"FAILS"}


def test_a_harness_that_compares_nothing_fails() -> None:
    library = library_of(NAME)
    nothing = [Heard("ab", 0, 0, 0, 0)] * 7
    sizes = {f"{NAME}_{p.name}_f32": Bytes(8, 0, 0) for p in all_of(library)}
    said = (nothing, nothing, nothing)
    rows = judged(library, CORES["m4f"], F32, said, sizes)
    assert {row.outcome for row in rows} == {"FAILS"}


def test_what_is_kept_stands_in_comment_json_and_page() -> None:
    library = library_of(NAME)
    costs = of_text(TEXT, SOURCES)
    assert costs == OnTarget((COST,))
    texts = c_files(library, (), costs)
    assert SAYS in texts[f"{NAME}_f32.h"]
    assert "Cortex" not in texts[f"{NAME}_f64.h"]
    described = {f["name"]: f for f in json.loads(manifest(library, (), costs=costs))["functions"]}
    assert described["moment"]["targets"]["m4f"]["f32"]["instructions"] == [277, 277]
    assert "targets" not in described["kinetic_energy"]
    page = scene_page(library, (), Beside(on_target=costs))
    assert page.count("Cortex-M4F") == 1
    assert ">1068</td>" in page


def test_what_is_kept_of_other_c_is_not_stated() -> None:
    other = {p: text.replace("return 4;", "return 5;") for p, text in SOURCES.items()}
    assert of_text(TEXT, other) == OnTarget((), ("m4f",))


def test_another_first_line_is_no_other_c() -> None:
    again = {p: f"/* made otherwise{text}" for p, text in SOURCES.items()}
    assert of_text(TEXT, again).each == (COST,)


@pytest.mark.parametrize("text", ["", "[]", "{", '{"targets": 3}', TEXT.replace("[", "{1:")])
def test_a_broken_file_states_nothing(text: str) -> None:
    assert of_text(text, SOURCES) == OnTarget()


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder to work in, with the scene's committed files below it."""
    monkeypatch.chdir(tmp_path)
    own = Path(__file__).parents[3] / "generated" / NAME
    shutil.copytree(own, tmp_path / "generated" / NAME)
    return tmp_path


@pytest.mark.long
def test_generate_states_it_and_drops_it_with_a_note_when_it_is_stale(
    place: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = place / "generated" / NAME / f"{NAME}_target.json"
    header = place / "generated" / NAME / f"{NAME}_f32.h"
    file.write_text(TEXT)
    assert main(["generate", NAME]) == 0
    assert SAYS in header.read_text()
    assert main(["generate", NAME, "--check"]) == 0
    assert lying_beside(library_of(NAME), place / "generated").on_target.each == (COST,)
    file.write_text(TEXT.replace('"c": "', '"c": "0'))
    assert main(["generate", NAME, "--check"]) == 1
    capsys.readouterr()
    assert main(["generate", NAME, "-v"]) == 0
    assert "Cortex" not in header.read_text()
    told = " ".join(capsys.readouterr().out.split())
    assert f"`derive check --target m4f --keep {NAME}` measures it anew" in told


def test_missing_tools_are_named_with_their_packages(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    assert main(["check", "--target", "rv32imac", NAME]) == 2
    told = " ".join(capsys.readouterr().err.split())
    assert "riscv64-unknown-elf-gcc and qemu-system-riscv32 must be on the PATH" in told
    assert "apt-get install qemu-system-misc gcc-riscv64-unknown-elf" in told


def test_keeping_needs_a_core(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--keep", NAME]) == 2
    assert "--keep needs --target, m0plus or" in capsys.readouterr().err


@pytest.mark.target
def test_what_is_kept_of_the_catalogue_is_of_its_c() -> None:
    generated = Path(__file__).parents[3] / "generated"
    for file in sorted(generated.glob("*/*_target.json")):
        scene = file.parent.name
        found = kept(generated, scene, sources_of(library_of(scene)))
        assert found.stale == (), scene
        assert {c.core for c in found.each} >= {"m0plus", "m4f"}, scene
