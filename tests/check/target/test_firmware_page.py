"""docs/firmware.md: its cores, packages and figures are those that there are."""

import re
from pathlib import Path

from derive.check.target.core import ARM, CORES, RISCV
from derive.check.target.harness import CALLS
from derive.check.target.run import NOPS
from derive.emit.c.source import sources_of
from derive.emit.on_target import kept
from tests.made import library_of

ROOT = Path(__file__).parents[3]
NAME = "free_body_principal"
PAGE = (ROOT / "docs" / "firmware.md").read_text(encoding="utf-8")
ROWS = [[cell.strip() for cell in line.strip("|").split("|")]
        for line in PAGE.splitlines() if line.startswith("| `")]  # fmt: skip


def test_the_table_of_cores_is_that_of_the_command() -> None:
    told = {row[0].strip("`"): row for row in ROWS if row[0].strip("`") in CORES}
    assert list(told) == list(CORES)
    for name, core in CORES.items():
        assert f"`{core.machine[1]}`" in told[name][2]
        assert ("not compared" in told[name][4]) == ("f64" not in core.precisions)


def test_packages_and_counts_are_those_of_the_command() -> None:
    words = " ".join(PAGE.split())
    for tools in (ARM, RISCV):
        assert f"`apt-get install {' '.join(tools.packages)}`" in words
    assert f"draws {CALLS} inputs" in words
    assert NOPS == 1000


def test_figures_are_those_that_are_kept() -> None:
    found = kept(ROOT / "generated", NAME, sources_of(library_of(NAME)))
    if found.each:  # after a change of the C, until it is measured anew
        told = {row[0].strip("`"): row[1:] for row in ROWS}
        for name in ("acceleration", "moment", "angular_momentum", "kinetic_energy"):
            costs = {c.core: c for c in found.of(name, "f32")}
            want = [f for core in ("m0plus", "m4f") for f in costs[core].figures]
            assert told[name] == [*want[:2], want[3], *want[4:6], want[7]]
        says = re.findall(r"On Cortex-M4F, -O2: (.*)\.\n", PAGE)
        assert says == [c.says for c in found.of("moment", "f32") if c.core == "m4f"]
