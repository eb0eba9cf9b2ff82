"""Files and names that nobody foresaw end in success or in one sentence, nothing half made."""

import os
from pathlib import Path

import pytest

from derive.check.compiler import compiled, find_compiler
from derive.cli import main
from derive.emit.c.source import c_files
from derive.emit.casadi_text import casadi_file
from derive.library.library import library
from derive.scene import SceneError, load, parse_scene
from tests.made import thinned

PLAIN = """
wanted = ["acceleration"]
parameters = { A = { unit = "kg m^2", range = [1, 2] } }
body = { kind = "principal", moments = ["A", 2, 2.5] }
"""
STATED = """
wanted = ["accelerations", "accelerations_jacobian", "sum"]
parameters = { A = { unit = "kg m^2", range = [1, 2] }, k = { unit = "N m", range = [1, 2] } }
coordinates = { q = { unit = "rad", range = [-1, 1] } }
frames = { f = { turned = ["x q"] } }
bodies = { b = { frame = "f", kind = "spherical", mass = 1, moment = "A" } }
loads = { l = { on = "b", force = "?P", couple = ["-k*q", "?Q", "?R"] } }
results = { sum = "A*q" }
"""
NAMES = (
    *("odd_constants_f32", "odd_constants_f64", "odd_setup_f32", "odd_acceleration_f32"),
    *("odd_pair_f32", "odd_add_f32", "A_f32", "A_low", "A_next", "A_dot", "A_x", "attitude_w"),
    *("P", "P_x", "q_ddot", "one_over_A", "one_over_A_low", "c0", "jacobian_dense", "entry"),
    *("ODD_F64_H", "ODD_F32_H", "DERIVE_ALLOW_CONTRACTION"),
)


def refused(path: Path | str) -> str:
    with pytest.raises(SceneError) as error:
        load(path)
    says = str(error.value)
    assert says.isprintable()
    assert len(says) < 400  # the path of a test's folder is long, and so is a file's name
    return says


@pytest.mark.parametrize(
    "name", ["a b", "-x", "é", "n" * 200, "con", "a\nb", "\x1b[31m", ".", "a.b", "1", "None"]
)
def test_a_file_with_an_odd_name_is_refused_in_one_line(name: str, tmp_path: Path) -> None:
    path = tmp_path / f"{name}.toml"
    path.write_text(PLAIN, encoding="utf-8")
    assert refused(path).startswith("scene '")


def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "folder.toml").mkdir()
    (tmp_path / "nowhere.toml").symlink_to("nothing")
    (tmp_path / "loop.toml").symlink_to("loop.toml")
    os.mkfifo(tmp_path / "pipe.toml")
    for name in ("folder", "nowhere", "loop", "pipe"):
        assert refused(tmp_path / f"{name}.toml").startswith(f"scene '{name}': ")
    for text in ("", ".", "/"):
        assert "a name of the catalogue or the path of a TOML file" in refused(text)


def test_a_link_to_a_scene_is_a_scene(tmp_path: Path) -> None:
    (tmp_path / "true.toml").write_text(PLAIN, encoding="utf-8")
    (tmp_path / "link.toml").symlink_to("true.toml")
    assert load(tmp_path / "link.toml").name == "link"


@pytest.mark.parametrize(
    "more",
    [
        f"[{'.'.join('a' * 20_000)}]",
        f"x = {'[' * 100_000}",
        f"x = {'[' * 100}{']' * 100}",
        f"x = {'{a=' * 100}1{'}' * 100}",
        "# " + "a" * 50_000_000,
        "[parameters.A]",
        f"x = {'9' * 5000}",
    ],
)
def test_a_huge_or_deep_file_is_refused_in_one_line(more: str, tmp_path: Path) -> None:
    path = tmp_path / "odd.toml"
    path.write_text(f"{PLAIN}{more}\n", encoding="utf-8")
    assert refused(path).startswith("scene 'odd': ")


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(NAMES, 4))
def test_names_that_meet_in_emitted_text_are_refused_or_compile(name: str, tmp_path: Path) -> None:
    found = []
    for text in (PLAIN.replace("A", name), STATED.replace("A", name), STATED.replace("sum", name)):
        try:
            made = library(parse_scene(text, "odd"))
            files, _ = c_files(made, ()), casadi_file(made)
        except SceneError as error:
            found.append(str(error))
            continue
        for source in (f for f in files if f.endswith(".c")):
            compiled(files, source, tmp_path, find_compiler())
    assert [says for says in found if not says.startswith("scene 'odd': ")] == []


@pytest.mark.parametrize(
    "text", ["m", "m=", "=1", "m=1e999", "m=nan", "m=1;ls", "m=$(ls)", "\x1b=1", "x" * 9999, "m==1"]
)
def test_hostile_values_are_refused_in_one_line(
    text: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "odd.toml"
    path.write_text(PLAIN, encoding="utf-8")
    assert main(["solve", str(path), "--set", text]) == 2
    said = capsys.readouterr().err
    assert said.strip().isprintable()
    assert len(said) < 400


@pytest.mark.parametrize(
    "scene", thinned(["free_body_principal", "gyrostat", "edge_runner_flat"], 3)
)
def test_a_value_that_no_scene_has_is_answered_by_those_that_it_has(
    scene: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["solve", scene, "--set", "q9=1"]) == 2
    assert "has no 'q9' to set (known: " in capsys.readouterr().err


@pytest.mark.long
def test_a_folder_that_is_a_file_or_not_to_be_written_is_refused_and_left(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    scene, file = tmp_path / "odd.toml", tmp_path / "file"
    scene.write_text(PLAIN, encoding="utf-8")
    file.write_text("mine", encoding="utf-8")
    (tmp_path / "gone").symlink_to(tmp_path / "nowhere" / "deeper")
    for out in (file, file / "below", tmp_path / "gone", tmp_path / ("x" * 300)):
        assert main(["generate", "--samples", "64", "--out", str(out), str(scene)]) == 2
        assert capsys.readouterr().err.strip().isprintable()
    assert file.read_text(encoding="utf-8") == "mine"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["file", "gone", "odd.toml"]
