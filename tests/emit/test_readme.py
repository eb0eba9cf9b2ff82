"""The README does what it says: every block of code in it is run, every figure is counted."""

import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from derive.check.compiler import find_compiler
from derive.scene import catalogue, load
from tests.made import SHORT, library_of

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
BLOCKS = [(found[1], found[2]) for found in BLOCK.finditer(README)]
ROW = re.compile(r"^\| (`\w+`.*?) \| \*\*(\d+)\*\*, (no division|\d div)", re.MULTILINE)


def blocks(language: str) -> list[str]:
    """Return the README's blocks in a language."""
    return [text for kind, text in BLOCKS if kind == language]


def run(command: list[str], folder: Path) -> str:
    """Run a command in a folder and return what it prints; it must succeed."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder that holds the README's scene and what `derive generate` made of it."""
    place = tmp_path_factory.mktemp("readme")
    (place / "brick.toml").write_text(blocks("toml")[0], encoding="utf-8")
    command = blocks("sh")[0].split()
    assert command == ["derive", "generate", "brick.toml"]
    code = f"import sys; sys.path[:0] = {sys.path!r}; from derive.cli import main; sys.exit(main())"
    run([sys.executable, "-c", code, *command[1:], "--samples", "256"], place)  # to be quick
    return place


def test_there_is_no_block_that_these_tests_do_not_run() -> None:
    assert [kind for kind, _ in BLOCKS] == ["toml", "sh", "c", "sh", "python", "python"]


def test_the_first_scene_has_ten_lines() -> None:
    assert len([line for line in blocks("toml")[0].splitlines() if line]) <= 10


def test_the_scene_makes_the_files_that_the_readme_names(folder: Path) -> None:
    named = set(re.findall(r"`(brick(?:_\w+)?\.\w+)`", README)) - {"brick.toml"}
    assert {"brick_f64.c", "brick_f32.c", "brick_casadi.py", "brick.json", "brick.html"} <= named
    assert all((folder / "generated" / "brick" / name).is_file() for name in named)


def omega_dot() -> list[float]:
    """Return the brick's angular acceleration by Euler's equations, written out by hand."""
    m, d, (x, y, z), torque = 2.0, 0.06, (0.1, 6.0, 0.0), 0.02
    xx, yy, zz = (m * d**2 * k / 12 for k in (4 + 16, 1 + 16, 1 + 4))
    return [(yy - zz) * y * z / xx, (zz - xx) * z * x / yy, (torque + (xx - yy) * x * y) / zz]


def test_the_c_compiles_as_written_and_prints_the_acceleration(folder: Path) -> None:
    (folder / "main.c").write_text(blocks("c")[0], encoding="utf-8")
    compile_, call = map(shlex.split, blocks("sh")[1].splitlines())
    assert compile_[0] == "cc"
    run([*find_compiler().command, *compile_[1:]], folder)
    printed = run(call, folder).split()
    assert [float(p) for p in printed] == pytest.approx(omega_dot(), abs=1e-6)


def test_the_python_runs_as_written_and_brings_the_brick_to_rest(folder: Path) -> None:
    shown = (
        "print(opti.value(w[:, steps]))\nprint(hot(constants, omega, moment).full()[:, 0].tolist())"
    )
    (folder / "use.py").write_text("".join([*blocks("python"), shown]), encoding="utf-8")
    *_, rest, rate = run([sys.executable, "use.py"], folder).splitlines()
    assert [float(x) for x in rest.strip("[]").split()] == pytest.approx([0, 0, 0], abs=1e-6)
    assert json.loads(rate) == pytest.approx(omega_dot(), rel=1e-14)


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


def test_every_file_that_the_readme_links_is_there() -> None:
    assert all((ROOT / path).is_file() for path in re.findall(r"\]\(([\w/.]+)\)", README))


def errors(scene: str, functions: list[str]) -> tuple[float, float]:
    """Return the largest median and the largest error of functions in a scene's committed JSON."""
    text = (ROOT / "generated" / scene / f"{scene}.json").read_text(encoding="utf-8")
    described = {f["name"]: f.get("error", {}) for f in json.loads(text)["functions"]}
    own = [described[name][precision] for name in functions for precision in ("f32", "f64")]
    rows = [row for outputs in own for row in outputs.values()]
    return max(r["median_ulp"] for r in rows), max(r["largest_within_ulp"] for r in rows)


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
        r"by at most ([\d.]+) units of rounding [^.]+, and by ([\d.]+) in the worst sample;",
        r"machines by ([\d.]+) and ([\d.]+)\. Each",
    )
    found = [re.search(sentence, text) for sentence in sentences]
    said = [(float(one[1]), float(one[2])) for one in found if one]
    assert said == [tuple(map(max, zip(*rows, strict=True))) for rows in (table, machines)]


def test_the_gallery_holds_as_many_scenes_as_it_says() -> None:
    (said,) = re.findall(r"a gallery of the (\d+) scenes", README)
    gallery = (ROOT / "generated" / "index.html").read_text(encoding="utf-8")
    linked = set(re.findall(r'href="(\w+)/\1\.html"', gallery))
    assert linked == set(catalogue())
    assert len(linked) == int(said)
