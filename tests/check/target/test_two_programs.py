"""The programs of docs/examples/firmware on an emulated M4F and here: bits, errors, costs."""

import re
import shutil
import subprocess
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import pytest

import derive
from derive.check.compiler import find_compiler
from derive.check.target.build import linked, linked_here
from derive.check.target.core import CORES
from derive.check.target.run import counted, said, said_on_board
from derive.emit.c.source import c_files
from derive.emit.files import write

ROOT = Path(__file__).parents[3]
PROGRAMS = ROOT / "docs" / "examples" / "firmware"
M4F = CORES["m4f"]
README = (ROOT / "README.md").read_text(encoding="utf-8")
pytestmark = pytest.mark.target

RUNS = ("estimator", "satellite_on_wheels")


@cache
def generated(name: str) -> dict[str, str]:
    return dict(c_files(derive.load(PROGRAMS / f"{name}.toml").library, ()))


def figures(text: str) -> dict[str, list[int]]:
    found: dict[str, list[int]] = {}
    for line in text.splitlines():
        name, number = line.split()
        found.setdefault(name, []).append(int(number))
    return found


def ran(name: str, change: tuple[str, str] = ("", ""), *flags: str) -> list[dict[str, list[int]]]:
    """Return what a program says here and on the M4F, with its text changed and flags added."""
    folder = Path(mkdtemp(prefix="derive-two-"))
    own = (PROGRAMS / f"{name}.c").read_text(encoding="utf-8")
    assert change[0] in own
    texts = {**generated(name), "own.c": own.replace(*change, 1)}
    for file, text in texts.items():
        (folder / file).write_text(text, encoding="utf-8")
    units = (f"-I{PROGRAMS}", "own.c", f"{name}_f32.c")
    try:
        here = said((str(linked_here(units, folder, find_compiler())),))
        there = said_on_board(M4F, linked(M4F, (*flags, *units), folder, "own.elf"))
    finally:
        shutil.rmtree(folder)
    return [figures(here), figures(there)]


def test_the_commands_of_the_page_say_what_this_machine_says(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "firmware.md").read_text(encoding="utf-8")
    for name in ("derive", "docs"):
        (tmp_path / name).symlink_to(ROOT / name)
    block = re.findall(r"\n\n((?:    .*\n)+)", page[page.index("## Two programs") :])[0]
    first, *commands = block.replace("\\\n", " ").splitlines()
    assert first == "    derive generate docs/examples/firmware/estimator.toml --out build"
    write(tmp_path / "build" / "estimator", generated("estimator"))
    for command in commands:
        done = subprocess.run(command.split(), cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    here, there = ran("estimator")
    told = figures(done.stdout + done.stderr)
    assert told == there
    assert compared(told) == compared(here)


def compared(told: dict[str, list[int]]) -> dict[str, list[int]]:
    return {name: each for name, each in told.items() if name not in ("least", "most")}


@pytest.mark.parametrize("name", RUNS)
def test_a_program_has_the_bits_of_this_machine_and_the_figures_of_the_readme(name: str) -> None:
    here, there = ran(name)
    assert len(here["bits"]) == 2
    assert compared(here) == compared(there)
    (row,) = re.findall(rf"\| \[`{name}`\].*", README)
    assert f"| {there['error'][0]} µrad" in row
    assert "without" not in there or f"{there['without'][0]} by feedback alone" in row
    least, most = (round(counted(M4F, there[key][0]), -2) for key in ("least", "most"))
    found = re.search(r"\| (\d+) to (\d+) \|", row)
    assert found is not None
    for stated, measured in zip(map(int, found.groups()), (least, most), strict=True):
        assert stated == pytest.approx(measured, rel=0.1, abs=100)  # by version of the compiler


def test_the_filter_knows_how_wrong_it_is_and_is_better_than_its_sensors() -> None:
    (told, _) = ran("estimator")
    error, expected = told["error"][0], told["expected"][0]
    assert expected / 1.3 < error < 1.3 * expected  # of some tens of independent errors
    assert error < 100 * 3**0.5 / 2  # of the star tracker, on three axes, in millionths


def test_what_is_fed_forward_takes_most_of_the_error_away() -> None:
    (told, _) = ran("satellite_on_wheels")
    assert 20 * told["error"][0] < told["without"][0]
    assert told["last"][0] < 50


@pytest.mark.parametrize(
    "change",
    [
        ("J[i + 6 * k] * of->P[k][j]", "(i == k ? of->P[k][j] : 0.0F)"),
        ("sum + PUSH * PUSH * pushed", "sum"),
        ("turned(of->attitude, error);", ""),
    ],
    ids=["no slopes", "no noise", "no turn"],
)
def test_a_wrong_filter_is_noticed(change: tuple[str, str]) -> None:
    (told, _) = ran("estimator", change)
    error, expected = told["error"][0], told["expected"][0]
    assert not (expected / 1.3 < error < 1.3 * expected)


def test_other_bits_are_noticed() -> None:
    here, there = ran("estimator", ("", ""), "-ffp-contract=fast")
    assert here["bits"] != there["bits"]
