"""Checks read what a scene makes: nothing else that lies there, and nothing may be missing."""

from pathlib import Path

import pytest

from derive.check.emitted import ENDINGS, files
from derive.files import scene_files, write
from derive.library import library
from derive.scene import SceneError, load

NAME = "free_body_principal"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write(tmp_path, scene_files(library(load(NAME)), ()))
    return tmp_path


def test_what_an_import_or_an_editor_left_is_not_read(folder: Path) -> None:
    (folder / NAME / "__pycache__").mkdir()
    (folder / NAME / f".{NAME}_f64.c.swp").write_bytes(b"\xff\xfe")
    found = files(library(load(NAME)), folder)
    assert set(found.texts) == {f"{NAME}{ending}" for ending in ENDINGS}


@pytest.mark.parametrize("ending", [e for e in ENDINGS if e != ".json"])
def test_a_missing_file_is_named(folder: Path, ending: str) -> None:
    (folder / NAME / f"{NAME}{ending}").unlink()
    with pytest.raises(SceneError, match=f"{NAME}{ending} is missing; generate it again"):
        files(library(load(NAME)), folder)
