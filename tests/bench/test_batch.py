"""Functions over members are timed beside the scene's own, whose bits they have."""

from pathlib import Path

import pytest

from bench import batch
from bench.build import BuildError
from derive.program.precision import F32
from tests.made import library_of


def test_a_function_over_members_is_timed_and_compared(tmp_path: Path) -> None:
    found = batch.pace(library_of("heavy_top"), "kinetic_energy", F32, 100, tmp_path, calls=1000)
    assert (found.function, found.precision) == ("heavy_top kinetic_energy", "float")
    assert min(found.single, found.over, found.arithmetic, found.memory, found.gain) > 0
    assert 0 < found.of_limit < 100


def test_a_bit_that_differs_is_no_figure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    right = batch.members_files

    def wrong(*given: object) -> dict[str, str]:
        texts = right(*given)
        return {name: text.replace(" * half_A;", " + half_A;") for name, text in texts.items()}

    monkeypatch.setattr(batch, "members_files", wrong)
    with pytest.raises(BuildError, match="kinetic_energy differs"):
        batch.pace(library_of("heavy_top"), "kinetic_energy", F32, 100, tmp_path, calls=1000)
