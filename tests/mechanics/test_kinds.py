"""Machines of every usual kind, beside the catalogue: each is proved and agrees with its cloud."""

from pathlib import Path

import pytest

from derive.check.particles import clouds
from derive.library.library import library
from derive.program.precision import F64
from derive.scene import load
from derive.verify.prove import prove
from derive.verify.sample import samples

pytestmark = pytest.mark.long

SCENES = sorted((Path(__file__).parent / "scenes").glob("*.toml"))


@pytest.mark.parametrize("path", SCENES, ids=lambda p: p.stem)
def test_a_machine_of_another_kind_is_proved_and_agrees_with_its_cloud(path: Path) -> None:
    made = library(load(path))
    prove(made)
    found = list(clouds(made, samples(made.mechanism, F64, 2, 0).each))
    assert [v for v in found if v.outcome == "FAILS"] == []
    assert any(v.outcome == "holds" for v in found)
