"""Every seeded defect is caught by the checks that claim it, and the scenes as they are pass."""

from pathlib import Path

import pytest

from derive.check import check_library
from derive.check.compiler import Compiler, find_compiler
from derive.check.emitted import Files
from derive.check.verdict import Verdict
from derive.library.library import Library
from tests.check.mutants import Texts, printed
from tests.defects import DEFECTS, Defect
from tests.made import library_of, thinned

SAMPLES = 12
AS_THEY_ARE = sorted({d.scene for d in DEFECTS}, reverse=True)


@pytest.fixture(scope="module")
def workshop(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("defects")


def verdicts(made: Library, texts: Texts, place: Path, with_: Compiler) -> list[Verdict]:
    return list(check_library(made, Files(texts, "made in memory"), place, with_, SAMPLES))


@pytest.mark.long
@pytest.mark.whole
@pytest.mark.parametrize("name", thinned(AS_THEY_ARE, len(AS_THEY_ARE)))
def test_the_scene_as_it_is_passes_every_check(name: str, workshop: Path) -> None:
    rows = verdicts(library_of(name), printed(library_of(name)), workshop, find_compiler())
    assert [row for row in rows if row.outcome == "FAILS"] == []


@pytest.mark.parametrize("defect", thinned(DEFECTS, 8), ids=lambda d: d.name)
def test_a_seeded_defect_is_caught(defect: Defect, workshop: Path) -> None:
    made = library_of(defect.scene)
    texts = Files(defect.mutant(made), "made in memory")
    missed = set(defect.killed_by)
    for row in check_library(made, texts, workshop, find_compiler(), SAMPLES):
        missed -= {row.check} if row.outcome == "FAILS" else set()
        if not missed:
            break
    assert missed == set()


def test_there_are_at_least_twelve_defects_each_with_its_story() -> None:
    assert len({d.name for d in DEFECTS}) == len(DEFECTS) >= 12
    assert all(d.story and d.killed_by for d in DEFECTS)
