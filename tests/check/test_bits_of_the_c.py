"""The compiled C has the bits of its programs at thousands of inputs, and no mutant of it has."""

from pathlib import Path
from random import Random

import numpy as np
import pytest

from derive.emit.c.source import c_files
from derive.program.precision import F32, F64, PRECISIONS, Precision
from derive.scene import catalogue
from tests.check.bulk import (
    differing,
    inputs_at,
    mutants,
    replayed_at,
    returned_at,
    shared,
)
from tests.made import library_of

MANY = 4096
EACH = 25
"""Mutants of a scene; of four scenes a hundred."""
FIRST = "free_body_principal"


@pytest.mark.parametrize(
    "scene", [FIRST, *(pytest.param(n, marks=pytest.mark.long) for n in catalogue() if n != FIRST)]
)
def test_thousands_of_results_have_the_bits_of_the_program(scene: str, tmp_path: Path) -> None:
    made = library_of(scene)
    for precision in PRECISIONS:
        at = inputs_at(made, precision, MANY)
        own = shared(made, precision, c_files(made, ()), tmp_path / precision.name)
        found = returned_at(made, precision, at, own)
        assert differing(replayed_at(made, precision, at, own), found) == []
        assert all(np.any(table) for table in found.values())


def survivors(scene: str, precision: Precision, count: int, folder: Path) -> list[str]:
    """Return the wrong statements of mutants whose results have the right bits."""
    made, texts = library_of(scene), c_files(library_of(scene), ())
    file = f"{scene}_{precision.name}.c"
    at = inputs_at(made, precision, MANY)
    expected = replayed_at(made, precision, at, shared(made, precision, texts, folder / "right"))
    wrong = mutants(texts[file], Random(scene))
    found = []
    for n in range(count):
        text, says = next(wrong)
        own = shared(made, precision, {**texts, file: text}, folder / str(n))
        if not differing(expected, returned_at(made, precision, at, own)):
            found.append(says)
    return found


@pytest.mark.long
@pytest.mark.parametrize(("scene", "precision"), [
    (FIRST, F32), ("heavy_top", F64), ("rigid_body", F32), ("cart_pendulum", F64),
])  # fmt: skip
def test_no_mutant_of_the_c_survives(scene: str, precision: Precision, tmp_path: Path) -> None:
    assert survivors(scene, precision, EACH, tmp_path) == []


def test_a_few_mutants_die_in_the_short_run(tmp_path: Path) -> None:
    assert survivors(FIRST, F32, 4, tmp_path) == []
