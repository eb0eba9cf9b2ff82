"""Steps on a Cortex-M4F: in loops little flash, and a small multiple of the fast ones' time."""

from pathlib import Path

import pytest

from derive.check.compiler import answer_of
from derive.check.target import tried_on
from derive.check.target.build import _sizes
from derive.check.target.core import CORES, FLAGS
from derive.emit.c.source import c_files
from derive.library.library import Library, library
from derive.scene import parse_scene
from tests.made import text_of
from tests.motion.systems import PRINCIPAL

pytestmark = pytest.mark.target
M4F = CORES["m4f"]
WANTED = 'wanted = ["step_rk4", "step_rk4_jacobian", "step_rk4_tangent"]'
LIMITS = {
    "principal": {"jacobian": (3200, 1900, 1650), "tangent": (2850, 2050, 1750)},
    "thirteen": {"jacobian": (10500, 4800, 3900), "tangent": (10500, 5100, 4000)},
}
"""Instructions of a call at -O2; bytes of code and tables at -O2, at -Os."""
FAST = {
    "principal": {"step_rk4": 277, "step_rk4_jacobian": 1315, "step_rk4_tangent": 1150},
    "thirteen": {"step_rk4": 860, "step_rk4_jacobian": 4500, "step_rk4_tangent": 4500},
}
"""Instructions of a call at -O2, without loops; a whole matrix costs a tenth more at most."""


def in_loops(name: str) -> Library:
    """Return the programs of a body's steps in loops: along principal axes, or with 13 states."""
    return steps_of(name, 'emission = "compact"')


def steps_of(name: str, *first: str) -> Library:
    """Return the programs of a body's steps, with an entry of the scene before all others."""
    own = PRINCIPAL if name == "principal" else text_of("rigid_body_steps")
    kept = [line for line in own.splitlines() if not line.startswith(("wanted", "emission"))]
    return library(parse_scene("\n".join([*first, WANTED, *kept]), "own"))


@pytest.mark.parametrize("name", FAST)
def test_fast_steps_cost_so_many_instructions(name: str) -> None:
    rows = {row.function: row for row in tried_on(steps_of(name), M4F) if row.cost}
    for function, most in FAST[name].items():
        for own, limit in ((function, most), (f"{function}_dense", 1.1 * most)):
            if own in rows:
                row = rows[own]
                assert row.outcome == "holds"
                assert row.cost
                assert row.cost.instructions[1] <= limit


@pytest.mark.parametrize("name", LIMITS)
def test_steps_in_loops_cost_so_much(name: str, tmp_path: Path) -> None:
    rows = {row.function: row for row in tried_on(in_loops(name), M4F) if row.cost}
    for kind, (instructions, most, least) in LIMITS[name].items():
        row = rows[f"step_rk4_{kind}"]
        assert row.outcome == "holds"
        assert row.cost
        assert row.cost.instructions[1] <= instructions
        assert row.cost.code + row.cost.tables <= most
        assert _bytes_at("-Os", in_loops(name), kind, tmp_path) <= least


def _bytes_at(level: str, made: Library, kind: str, folder: Path) -> int:
    """Return the bytes of code and tables of a step at another level."""
    for name, text in c_files(made, ()).items():
        (folder / name).write_text(text)
    flags = [level if flag == "-O2" else flag for flag in FLAGS]
    command = (M4F.tools.compiler, *M4F.flags, *flags, "-fstack-usage")
    answer_of((*command, "-c", "own_f32.c", "-o", "scene.o"), folder)
    found = _sizes(M4F, folder)[f"own_step_rk4_{kind}_f32"]
    return found.code + found.tables
