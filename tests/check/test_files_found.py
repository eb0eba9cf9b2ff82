"""Checks run what a scene makes: what else lies there is compared with it, and never run."""

from pathlib import Path

import pytest

import derive
from derive.check import as_made
from derive.check.emitted import Files, files, sampling_of
from derive.emit.files import scene_files, write
from derive.verify.search import SAMPLING, Sampling, sampled_at
from tests.made import library_of

NAME = "free_body_principal"
FEW = Sampling(samples=64, rounds=1, batch=16, balls=1, motion_balls=1)


@pytest.fixture(scope="module")
def found() -> Files:
    """Return the files of a scene, made in memory."""
    return files(library_of(NAME), Path("nowhere"), FEW)


@pytest.fixture
def folder(tmp_path: Path, found: Files) -> Path:
    page = scene_files(library_of(NAME), ())[f"{NAME}/{NAME}.html"]
    write(tmp_path, {f"{NAME}/{file}": text for file, text in found.texts.items()})
    write(tmp_path, {f"{NAME}/{NAME}.html": page})
    return tmp_path


@pytest.mark.long
def test_what_an_import_or_an_editor_left_is_not_read(folder: Path, found: Files) -> None:
    (folder / NAME / "__pycache__").mkdir()
    (folder / NAME / f".{NAME}_f64.c.swp").write_bytes(b"\xff\xfe")
    assert files(library_of(NAME), folder, FEW).texts == found.texts


@pytest.mark.long
@pytest.mark.parametrize("ending", ["_casadi.py", "_f64.c", ".json"])
def test_what_lies_there_is_compared_and_never_run(folder: Path, found: Files, ending: str) -> None:
    (folder / NAME / f"{NAME}{ending}").write_text("raise SystemExit('it was run')")
    again = files(library_of(NAME), folder, FEW)
    assert again.texts == found.texts
    assert f"{NAME}/{NAME}{ending}" in again.differ
    verdict = as_made(library_of(NAME), again, NAME)
    assert verdict.outcome == "FAILS"
    assert f"{NAME}{ending}" in verdict.says


def test_a_missing_file_is_named(folder: Path) -> None:
    (folder / NAME / f"{NAME}_f32.h").unlink()
    assert f"{NAME}/{NAME}_f32.h" in files(library_of(NAME), folder, FEW).differ


@pytest.mark.long
def test_what_was_asked_for_beside_is_made_again_and_what_is_no_longer_is_left_over(
    tmp_path: Path,
) -> None:
    scene = derive.load(NAME)
    scene.generate(tmp_path, samples=64, parts="batch")
    lying = files(scene.library, tmp_path, sampling_of(tmp_path, NAME))
    says = as_made(scene.library, lying, NAME).says
    assert says.endswith(f"{NAME}: as made by --samples 64 --batch")
    scene.generate(tmp_path, samples=64)
    lying = files(scene.library, tmp_path, sampling_of(tmp_path, NAME))
    verdict = as_made(scene.library, lying, NAME)
    left = [str(tmp_path / NAME / f"{NAME}_batch_{end}") for end in ("f32.c", "f32.h", "f64.c")]
    assert (verdict.outcome, lying.differ) == ("FAILS", ())
    assert f"run `rm {' '.join(left)}" in verdict.says


def test_a_scene_of_which_nothing_lies_there_is_skipped(found: Files) -> None:
    assert as_made(library_of(NAME), found, NAME).outcome == "skipped"


@pytest.mark.long
def test_the_command_that_mends_names_the_scene_as_it_was_given(folder: Path) -> None:
    (folder / NAME / f"{NAME}_f32.h").unlink()
    again = files(library_of(NAME), folder, sampling_of(folder, NAME))
    says = as_made(library_of(NAME), again, "my scenes/rotor.toml").says
    assert says.endswith("run `derive generate 'my scenes/rotor.toml' --samples 64`")


def test_files_are_made_again_by_the_samples_that_their_json_states(folder: Path) -> None:
    by = sampling_of(folder, NAME)
    assert by == sampled_at(64) != SAMPLING
    (folder / NAME / f"{NAME}.json").write_text('{"functions": [{"error": 3}]}')
    assert sampling_of(folder, NAME) == SAMPLING


@pytest.mark.parametrize("said", [0, -1, 10**20])
def test_no_json_asks_for_samples_that_nobody_may_ask_for(folder: Path, said: int) -> None:
    file = folder / NAME / f"{NAME}.json"
    file.write_text(file.read_text().replace('"samples": 64,', f'"samples": {said},'))
    assert sampling_of(folder, NAME) == SAMPLING
