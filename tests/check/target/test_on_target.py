"""`derive check --target`: the bits of this machine, figures that are true, mutants noticed."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from derive.check.target import tried_on
from derive.check.target.build import built, laid_out
from derive.check.target.core import CORES
from derive.check.target.run import RunError, on_board
from derive.emit.c.source import c_files
from derive.program.precision import F32
from tests.made import library_of

pytestmark = pytest.mark.target

PRINCIPAL, TOP = "free_body_principal", "heavy_top"
M4F = CORES["m4f"]


def mutated(pattern: str, by: str, scene: str = PRINCIPAL) -> dict[str, str]:
    """Return a scene's C files with one place changed in the source for floats."""
    texts = c_files(library_of(scene), ())
    name = f"{scene}_f32.c"
    text, count = re.subn(pattern, by, texts[name], count=1)
    assert count == 1
    return texts | {name: text}


@pytest.mark.parametrize("core", CORES)
@pytest.mark.parametrize("scene", [PRINCIPAL, TOP])
def test_every_core_gives_the_bits_of_this_machine(scene: str, core: str) -> None:
    rows = tried_on(library_of(scene), CORES[core])
    run = [row for row in rows if row.outcome != "skipped"]
    assert [row.says for row in run if row.outcome != "holds"] == []
    assert len(run) == len(CORES[core].precisions) * 7 if scene == PRINCIPAL else 6
    for row in run:
        assert row.cost
        least, most = row.cost.instructions
        assert 0 < least <= most
        assert row.cost.code > 0


def test_a_flipped_sign_on_the_target_is_noticed() -> None:
    texts = mutated(r"(angular_momentum\[1\] = )", r"\1-")
    found = {row.function: row for row in tried_on(library_of(PRINCIPAL), M4F, texts)}
    assert found["angular_momentum"].outcome == "FAILS"
    assert "other bits" in found["angular_momentum"].says
    assert found["moment"].outcome == "holds"


def test_a_sign_behind_a_sine_is_noticed_too() -> None:
    texts = mutated(r"= (\w+_both\.cosine);", r"= -\1;", TOP)
    found = {row.function: row.outcome for row in tried_on(library_of(TOP), M4F, texts)}
    assert found["state_rate"] == "FAILS"


def test_what_a_call_takes_on_the_stack_is_seen() -> None:
    wastes = mutated(
        r"(kinetic_energy_f32\([^)]*\)\n\{)",
        r"\1 volatile float waste[300]; waste[0] = 0.0F; (void)waste[0];",
    )
    (usual, more) = (
        next(r.cost for r in tried_on(library_of(PRINCIPAL), M4F, texts) if "kin" in r.function)
        for texts in (None, wastes)
    )
    assert usual
    assert more
    assert more.stack >= usual.stack + 1200
    assert more.instructions[0] > usual.instructions[0]


def test_what_does_not_compile_fails_with_the_complaint() -> None:
    (row,) = (r for r in tried_on(library_of(PRINCIPAL), M4F, mutated("return 4;", "retur;"))
              if r.precision == "f32")  # fmt: skip
    assert row.outcome == "FAILS"
    assert "retur" in row.says


def test_instructions_that_are_counted_wrong_are_refused(tmp_path: Path) -> None:
    library = library_of(PRINCIPAL)
    folder = laid_out(library, F32, c_files(library, ()), tmp_path / "own")
    program = built(library, F32, M4F, folder).cost
    assert len(on_board(M4F, program)) == 7
    with pytest.raises(RunError, match="1000 instructions must be counted as such"):
        on_board(replace(M4F, ticks=2 * M4F.ticks), program)


def test_a_scene_too_large_for_a_board_is_skipped_not_passed() -> None:
    wide = mutated(
        r"(kinetic_energy_f32\([^)]*\)\n\{)",
        r"\1 static const volatile float wide[100000] = {1.0F}; (void)wide[3];",
    )
    rows = tried_on(library_of(PRINCIPAL), CORES["m0plus"], wide)
    assert [(r.function, r.outcome) for r in rows if r.precision == "f32"] == [("all", "skipped")]
    assert "too large for the memory" in rows[0].says
