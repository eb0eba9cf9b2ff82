"""An output that cannot be written to is told in one sentence, who reads no further in none."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from derive.cli import COMMANDS, main
from derive.command.terminal import console

FULL = Path("/dev/full")
QUICK = ("equations heavy_top", "schema", "completion bash", "new body brick",
         "--help", "--version", "solve --help", "control --help", "sweep --help")  # fmt: skip
LONG = ("generate attitude --samples 256", "check attitude --samples 256", "lecture",
        "solve edge_runner_flat --set m=1200 r=0.6 width=0.3 L=0.9 W=3.2 g=9.81", "report attitude",
        "lecture --without newton", "scenes")  # fmt: skip
EVERY = [*QUICK, *(pytest.param(c, marks=pytest.mark.long) for c in LONG)]


def test_every_command_is_tried_with_outputs_that_fail() -> None:
    assert {c.split()[0] for c in (*QUICK, *LONG)} >= COMMANDS.keys()


@pytest.mark.skipif(not FULL.exists(), reason="no device here that is always full")
@pytest.mark.parametrize("command", EVERY)
def test_a_full_output_is_told_in_one_sentence(command, monkeypatch, capsys, tmp_path):
    monkeypatch.chdir(tmp_path)
    with FULL.open("w", encoding="utf-8") as full:
        monkeypatch.setattr(sys, "stdout", full)
        assert main(command.split()) == 2
    monkeypatch.undo()
    assert capsys.readouterr().err.strip().endswith("derive: the output: No space left on device")
    console.print("said afterwards")
    assert capsys.readouterr().out == "said afterwards\n"


@pytest.mark.parametrize("command", [*QUICK, *LONG])
def test_a_closed_output_is_told_in_one_sentence(command, monkeypatch, capsys, tmp_path):
    monkeypatch.chdir(tmp_path)
    with monkeypatch.context() as closed:
        closed.setattr(sys, "stdout", None)
        assert main(command.split()) == 2
    assert (
        capsys.readouterr().err == "derive: the output: it is closed, so nothing can be printed\n"
    )
    assert list(tmp_path.iterdir()) == []


@pytest.mark.long
@pytest.mark.skipif(os.name != "posix", reason="the shell of POSIX closes outputs")
@pytest.mark.parametrize(("closed", "code"), [(">&-", 2), ("2>&-", 0), (">&- 2>&-", 2)])
def test_the_program_starts_with_closed_outputs(closed, code):
    command = f'"{sys.executable}" -m derive schema {closed}'
    done = subprocess.run(["sh", "-c", command], capture_output=True, check=False)
    assert done.returncode == code
    assert b"Traceback" not in done.stdout + done.stderr


def test_who_has_read_enough_is_told_nothing(monkeypatch, capsys):
    read, written = os.pipe()
    os.close(read)
    with os.fdopen(written, "w", encoding="utf-8") as pipe:
        monkeypatch.setattr(sys, "stdout", pipe)
        assert main(["equations", "heavy_top"]) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.long
@pytest.mark.parametrize("command", ["equations heavy_top", "scenes"])
@pytest.mark.skipif(os.name != "posix", reason="the shell of POSIX has pipes")
def test_a_pipe_that_is_closed_early_ends_the_program_quietly(command):
    told = f'("{sys.executable}" -m derive {command}; echo $? >&2) | true'
    done = subprocess.run(["sh", "-c", told], capture_output=True, check=False)
    assert done.stderr == b"0\n"


def test_where_a_file_lies_in_place_of_a_folder_it_is_named(tmp_path, capsys):
    (tmp_path / "taken").write_text("")
    own = str(tmp_path / "taken" / "below")
    says = f"'{tmp_path / 'taken'}' is no folder"
    for command in (
        ["generate", "attitude", "--samples", "256", "--out", own],
        ["report", "attitude", "--out", own],
        ["solve", "heavy_top", "--until", "1", "--plot", f"{own}/x.svg", "--set", "m=1"],
    ):
        assert main(command) == 2
        assert capsys.readouterr().err.strip().endswith(says), command


@pytest.mark.long
def test_a_module_is_not_printed_in_another_encoding_than_its_own(monkeypatch, tmp_path, capsys):
    catalogue = Path(__file__).parents[2] / "derive" / "scene" / "catalogue"
    text = (catalogue / "free_body.toml").read_text(encoding="utf-8")
    own = tmp_path / "own.toml"
    own.write_text(text.replace('title  = "', 'title = "\u03c9 '), encoding="utf-8")
    with (tmp_path / "out").open("w", encoding="ascii") as out:
        monkeypatch.setattr(sys, "stdout", out)
        assert main(["equations", "--sympy", str(own)]) == 2
    assert "set PYTHONIOENCODING=utf-8" in capsys.readouterr().err
    assert (tmp_path / "out").read_text(encoding="ascii") == ""


@pytest.mark.long
def test_what_succeeds_says_nothing_in_a_log(tmp_path):
    command = [sys.executable, "-m", "derive", "generate", "attitude", "--samples", "256"]
    done = subprocess.run([*command, "--out", tmp_path], capture_output=True, check=True)
    assert done.stderr == b""
