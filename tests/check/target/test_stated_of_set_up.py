"""docs/code.md: what fixed parameters spare on a Cortex-M4F, and what trying ranges takes there."""

import re
from pathlib import Path

import pytest

from derive.check.compiler import answer_of
from derive.check.target import tried_on
from derive.check.target.core import CORES, FLAGS
from derive.emit.c.source import c_files
from derive.emit.on_target import Cost
from derive.library.fixed import with_fixed
from derive.library.library import Library
from derive.library.ranges import with_ranges_tried
from tests.made import library_of

pytestmark = pytest.mark.target
PAGE = " ".join((Path(__file__).parents[3] / "docs" / "code.md").read_text("utf-8").split())
M4F = CORES["m4f"]
NEAR = 0.02
"""Of bytes and instructions: other versions of gcc differ by so much, and by a few."""


def size(made: Library, folder: Path) -> int:
    """Return the bytes of a scene's whole source for floats."""
    for name, text in c_files(made, ()).items():
        (folder / name).write_text(text)
    source = f"{made.scene.name}_f32.c"
    answer_of((M4F.tools.compiler, *M4F.flags, *FLAGS, "-c", source, "-o", "scene.o"), folder)
    return int(answer_of(("arm-none-eabi-size", "scene.o"), folder).splitlines()[1].split()[0])


def set_up_of(made: Library) -> Cost:
    """Return what set-up costs in floats."""
    return next(r.cost for r in tried_on(made, M4F) if r.function == "setup" and r.cost)


def test_fixed_parameters_spare_so_many_bytes(tmp_path: Path) -> None:
    made = library_of("rigid_body")
    found = re.search(r"of `rigid_body` in float, .*?, (\d+) bytes in the place of (\d+)", PAGE)
    assert found
    middle = {q.name: float((q.low + q.high) / 2) for q in made.setup.inputs}
    sizes = [size(with_fixed(made, middle), tmp_path), size(made, tmp_path)]
    assert [int(n) for n in found.groups()] == pytest.approx(sizes, rel=NEAR)


def test_trying_ranges_takes_so_much() -> None:
    made = library_of("heavy_top")
    found = re.search(r"they are (\d+) instructions and (\d+) bytes on a Cortex-M4F", PAGE)
    assert found
    plain, tried = set_up_of(made), set_up_of(with_ranges_tried(made))
    more = [tried.instructions[1] - plain.instructions[1], tried.code - plain.code]
    assert [int(n) for n in found.groups()] == pytest.approx(more, rel=NEAR, abs=4)
