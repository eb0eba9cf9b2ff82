"""The README does what it says: every block is run, its output compared, every figure counted."""

import json
import re
import shlex
import subprocess
import sys
from pathlib import Path
from shutil import copy

import pytest

from derive.check.compiler import find_compiler
from derive.scene import catalogue, load
from tests.made import SHORT, library_of
from tests.pages import Block, blocks, printed, told

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = blocks(ROOT / "README.md")
ROW = re.compile(r"^\| (`\w+`.*?) \| \*\*(\d+)\*\*, (no division|\d div)", re.MULTILINE)
FIRST_SCREEN = 40
"""Lines that are read before anyone scrolls."""
AT_ONCE = ("solve", "equations")
"""Commands that take less than a second."""
END = "print('-- end of a block --')\n"


def of(language: str) -> list[Block]:
    """Return the README's blocks in a language."""
    return [block for block in BLOCKS if block.language == language]


def commands() -> list[list[str]]:
    """Return the README's commands of ours, a word after another."""
    return [shlex.split(b.text) for b in of("sh") if b.text.startswith("derive")]


def run(command: list[str], folder: Path) -> str:
    """Run a command in a folder and return what it prints; it must succeed."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return printed(done.stdout)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder that holds the README's scene and what `derive generate` made of it."""
    place = tmp_path_factory.mktemp("readme")
    (place / "brick.toml").write_text(of("toml")[0].text, encoding="utf-8")
    assert GENERATE in commands()
    told([*GENERATE, "--samples", "256"], place)  # to be quick
    return place


GENERATE = ["derive", "generate", "brick.toml"]


def test_there_is_no_block_that_these_tests_do_not_run() -> None:
    kinds = [block.language for block in BLOCKS]
    assert kinds == ["sh", "toml", "sh", "sh", "sh", "c", "sh", "python", "python"]
    assert [block.language for block in BLOCKS if block.shown is None] == ["toml", "c"]


def test_the_first_screen_says_for_whom_it_is_and_shows_a_picture_and_an_answer() -> None:
    first = "\n".join(README.splitlines()[:FIRST_SCREEN])
    bold = set(re.findall(r"\*\*(.+?)\*\*", first))
    assert bold == {"regenerate equations", "write firmware", "optimal control"}
    pictures = re.findall(r"(?:srcset|src)=\"(\S+)\"", first)
    assert len(pictures) == 2
    assert all((ROOT / path).is_file() for path in pictures)
    assert "derive solve" in first
    assert BLOCKS[0].shown is not None
    assert BLOCKS[0].shown in first


@pytest.mark.parametrize(
    "command",
    [pytest.param(c, marks=() if c[1] in AT_ONCE else pytest.mark.long) for c in commands()],
    ids=" ".join,
)
def test_a_command_prints_what_the_readme_shows(command: list[str], tmp_path: Path) -> None:
    (tmp_path / "brick.toml").write_text(of("toml")[0].text, encoding="utf-8")
    (tmp_path / "generated").mkdir()
    copy(ROOT / "generated" / "lecture.html", tmp_path / "generated")  # by the README's command
    (shown,) = [b.shown for b in of("sh") if shlex.split(b.text) == command]
    assert told(command, tmp_path) == shown


@pytest.mark.long
def test_the_table_that_the_readme_shows_has_the_costs_of_its_scene(folder: Path) -> None:
    (shown,) = [b.shown for b in of("sh") if b.text.split() == GENERATE]
    text = (folder / "generated" / "brick" / "brick.json").read_text(encoding="utf-8")
    described = [f for f in json.loads(text)["functions"] if "flops" in f.get("cost", {})]
    costs = {f["name"]: f["cost"]["flops"] for f in described}
    rows = {
        name: int(flops) for name, flops in re.findall(r"^   (\w+) +(\d+) 0 ", shown or "", re.M)
    }
    assert len(rows) == 3
    assert rows.items() <= costs.items()


def test_the_first_scene_has_ten_lines() -> None:
    assert len([line for line in of("toml")[0].text.splitlines() if line]) <= 10


@pytest.mark.long
def test_the_scene_makes_the_files_that_the_readme_names(folder: Path) -> None:
    named = set(re.findall(r"`(brick(?:_\w+)?\.\w+)`", README)) - {"brick.toml"}
    assert {"brick_f64.c", "brick_f32.c", "brick_casadi.py", "brick.json", "brick.html"} <= named
    assert all((folder / "generated" / "brick" / name).is_file() for name in named)


def omega_dot() -> list[float]:
    """Return the brick's angular acceleration by Euler's equations, written out by hand."""
    m, d, (x, y, z), torque = 2.0, 0.06, (0.1, 6.0, 0.2), 0.02
    xx, yy, zz = (m * d**2 * k / 12 for k in (4 + 16, 1 + 16, 1 + 4))
    return [(yy - zz) * y * z / xx, (zz - xx) * z * x / yy, (torque + (xx - yy) * x * y) / zz]


def test_the_c_compiles_as_written_and_prints_the_acceleration(folder: Path) -> None:
    (block,) = of("c")
    (folder / "main.c").write_text(block.text, encoding="utf-8")
    (built,) = [b for b in of("sh") if b.text.startswith("cc")]
    compile_, call = map(shlex.split, built.text.splitlines())
    run([*find_compiler().command, *compile_[1:]], folder)
    out = run(call, folder)
    assert out == built.shown
    assert [float(p) for p in out.split()] == pytest.approx(omega_dot(), abs=1e-6)


def test_the_python_runs_as_written_and_brings_the_brick_to_rest(folder: Path) -> None:
    rest = (
        "print(opti.value(w[:, steps]))\nprint(hot(constants, omega, moment).full()[:, 0].tolist())"
    )
    texts = [block.text + END for block in of("python")]
    (folder / "use.py").write_text("".join([*texts, rest]), encoding="utf-8")
    *shown, last = run([sys.executable, "use.py"], folder).split("-- end of a block --\n")
    assert [printed(text) for text in shown] == [block.shown for block in of("python")]
    still, rate = last.splitlines()
    assert [float(x) for x in still.strip("[]").split()] == pytest.approx([0, 0, 0], abs=1e-6)
    assert json.loads(rate) == pytest.approx(omega_dot(), rel=1e-14)


@pytest.mark.long
def test_the_table_counts_what_the_catalogue_gives() -> None:
    rows = {(label, int(flops), divisions) for label, flops, divisions in ROW.findall(README)}
    assert len(rows) == 6
    for label, flops, divisions in rows:
        scene = label.split("`")[1]
        made = library_of(scene)
        wanted = "Jacobian" in label
        program = next(p for p in made.functions if p.name.endswith("_jacobian") == wanted)
        count = program.count.get("div", 0)
        assert (program.flops(), f"{count} div" if count else "no division") == (flops, divisions)


def errors(scene: str, functions: list[str]) -> tuple[float, float]:
    """Return the largest median and the largest error of functions in a scene's committed JSON."""
    text = (ROOT / "generated" / scene / f"{scene}.json").read_text(encoding="utf-8")
    described = {f["name"]: f.get("error", {}) for f in json.loads(text)["functions"]}
    own = [described[name][precision] for name in functions for precision in ("f32", "f64")]
    rows = [row for outputs in own for row in outputs.values()]
    return max(r["median_ulp"] for r in rows), max(r["largest_within_ulp"] for r in rows)


@pytest.mark.long
def test_the_errors_that_it_states_are_those_of_the_committed_files() -> None:
    table, machines = [], []
    for label, _, _ in ROW.findall(README):
        name = label.split("`")[1]
        ends = "Jacobian" in label
        wanted = [f.name for f in library_of(name).functions]
        table.append(errors(name, [f for f in wanted[:2] if f.endswith("_jacobian") == ends][:1]))
    for name in catalogue():
        scene = load(name)
        answers = [f for f in scene.wanted if not f.startswith(("step_", "flow_"))]
        if name not in SHORT and answers:
            machines.append(errors(name, answers))
    text = " ".join(README.split())
    sentences = (
        r"by at most ([\d.]+) u of [^.]+, and by ([\d.]+) in the worst sample;",
        r"machines by ([\d.]+) and ([\d.]+)\. Each",
    )
    found = [re.search(sentence, text) for sentence in sentences]
    said = [(float(one[1]), float(one[2])) for one in found if one]
    assert said == [tuple(map(max, zip(*rows, strict=True))) for rows in (table, machines)]
