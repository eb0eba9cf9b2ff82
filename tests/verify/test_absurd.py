"""No stated error is absurd: a true value of zero is measured by the terms that went into it."""

from pathlib import Path

import pytest

from derive.scene import SceneError, catalogue
from derive.verify.search import Sampling
from derive.verify.stated import figures
from tests.made import library_of

CATS = ("bent_cat", "straight_cat")
"""Trials that take seconds each, in the longer run."""
FOUND = sorted((Path(__file__).parents[1] / "data" / "trials").glob("*.toml"))
TRIALS = [
    pytest.param(path, marks=pytest.mark.long) if path.stem in CATS or place % 3 else path
    for place, path in enumerate(FOUND)
]
FEW = Sampling(samples=256, rounds=2, batch=128, balls=2, motion_balls=2, corners=2)
ABSURD = 300.0
"""In u: ten times what is stated within the ranges of any function of the catalogue."""


@pytest.mark.long
@pytest.mark.parametrize("path", TRIALS, ids=lambda p: p.stem)
def test_no_error_of_a_trial_is_absurd(path: Path) -> None:
    try:
        library = library_of(str(path))
    except SceneError as refused:
        pytest.skip(f"is refused: {refused}")
    assert [m for m in figures(library, FEW) if m.within > ABSURD] == []


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.long) for n in catalogue()])
def test_no_error_of_the_catalogue_is_absurd(name: str) -> None:
    assert [m for m in figures(library_of(name), FEW) if m.within > ABSURD] == []
