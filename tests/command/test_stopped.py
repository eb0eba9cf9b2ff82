"""A run that is killed at any moment leaves what the next one sees, says and mends."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from derive import Generation
from derive.__main__ import run
from derive.command.generate import mended
from derive.emit.files import UNFINISHED, OutputError, abandoned, differences, unfinished, write

OLD = {"page": "old page", "one/a": "old a", "one/b": "old b", "two/c": "old c"}
NEW = {name: text.replace("old", "new") for name, text in OLD.items()}

KILLED = """
import os, sys, tempfile, pathlib
from derive.emit.files import write
from tests.command.test_stopped import NEW, OLD, judge

def killed_at(folder, place):
    calls = 0
    def counted(function):
        def call(*given, **named):
            nonlocal calls
            calls += 1
            if calls == place:
                os._exit(9)
            return function(*given, **named)
        return call
    for owner, name in ((os, "replace"), (os, "chmod"), (os, "fdopen"), (tempfile, "mkstemp"),
                        (pathlib.Path, "unlink"), (pathlib.Path, "mkdir")):
        setattr(owner, name, counted(getattr(owner, name)))
    write(folder, NEW)
    os._exit(0)

def run(folder, place):
    write(folder, OLD)
    child = os.fork()
    if not child:
        killed_at(folder, place)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])

place, states = 1, []
while run(folder := pathlib.Path(sys.argv[1]) / str(place), place) == 9:
    states.append(judge(folder))
    place += 1
print(len(states), *sorted(set(states)))
"""
"""Writes once for every call that changes a file, and ends without a word at that call."""

SHOT = """
import os, signal, sys, time, pathlib
from derive.emit.files import write
from tests.command.test_stopped import judge

folder = pathlib.Path(sys.argv[1])
for number in range(4):
    child = os.fork()
    if not child:
        while True:
            write(folder, {f"{k % 7}/{k}": f"{os.getpid()}" * 999 for k in range(90)})
    time.sleep(0.03 + 0.011 * number)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    write(folder, {f"{k % 7}/{k}": "whole" for k in range(90)})
    files = [p for p in folder.rglob("*") if p.is_file()]
    print(len(files), sum(p.read_text() != "whole" for p in files))
"""


def contents(folder: Path) -> dict[str, str]:
    found = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_text() for path in found}


def judge(folder: Path) -> str:
    """Return what a killed run left; raise if that is not seen, or not mended by the next."""
    found = contents(folder)
    own = {name: text for name, text in found.items() if name in NEW}
    mixed, hidden = own not in (OLD, NEW), len(found) > len(own) + (UNFINISHED in found)
    assert own.keys() == NEW.keys()
    assert all(text in (OLD[name], NEW[name]) for name, text in own.items())
    assert not mixed or unfinished(folder)
    assert hidden == bool(abandoned(folder, NEW))
    assert (found == NEW) == (not list(differences(folder, NEW)))
    write(folder, NEW)
    assert contents(folder) == NEW
    return "mixed" if mixed else "whole"


def ran(code: str, folder: Path) -> str:
    path = {"PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", code, str(folder)]
    done = subprocess.run(command, env=os.environ | path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.long
def test_a_run_that_is_killed_at_any_call_is_mended_by_the_next(tmp_path: Path) -> None:
    count, *states = ran(KILLED, tmp_path).split()
    assert int(count) > 20
    assert states == ["mixed", "whole"]


@pytest.mark.long
def test_a_run_that_is_shot_is_mended_by_the_next(tmp_path: Path) -> None:
    assert ran(SHOT, tmp_path).split("\n") == [*["90 0"] * 4, ""]


def test_what_a_stopped_run_was_replacing_stays_listed_until_it_is_made(tmp_path: Path) -> None:
    write(tmp_path, OLD)
    (tmp_path / UNFINISHED).write_text("page\none/a\n")
    assert [d.name for d in differences(tmp_path, OLD)] == [UNFINISHED]
    write(tmp_path, {"page": "new page"})
    assert unfinished(tmp_path) == ("one/a",)
    write(tmp_path, NEW)
    assert unfinished(tmp_path) == ()


def test_the_temporary_file_of_a_run_that_goes_on_is_left_alone(tmp_path: Path) -> None:
    write(tmp_path, OLD)
    (tmp_path / f".page.derive-{os.getpid()}-x").write_text("half")
    assert abandoned(tmp_path, OLD) == []


def test_a_link_to_another_place_is_not_written_through(tmp_path: Path) -> None:
    out, elsewhere = tmp_path / "out", tmp_path / "elsewhere"
    elsewhere.mkdir()
    out.mkdir()
    (out / "one").symlink_to(elsewhere)
    (tmp_path / "kept").write_text("kept")
    (out / "page").symlink_to(tmp_path / "kept")
    with pytest.raises(OutputError, match="'one' is a link to another place"):
        write(out, NEW)
    assert contents(elsewhere) == {}
    (out / "one").unlink()
    write(out, NEW)
    assert (tmp_path / "kept").read_text() == "kept"
    assert not (out / "page").is_symlink()


@pytest.mark.parametrize("to", ["nowhere", "one"])
def test_a_link_that_leads_nowhere_is_refused_in_one_sentence(tmp_path: Path, to: str) -> None:
    (tmp_path / "one").symlink_to(tmp_path / to)
    with pytest.raises(OutputError, match="must be writable, but: 'one' is a link"):
        write(tmp_path, NEW)
    assert list(differences(tmp_path, {"one/a": "a"}))


def test_what_a_stopped_run_has_left_is_named_by_scene(tmp_path: Path) -> None:
    (tmp_path / UNFINISHED).write_text("rotor/rotor.json\nrotor/rotor.html\ntop/top.json\n")
    left = unfinished(tmp_path)
    says = mended(Generation(tmp_path, (), (), ("rotor/rotor.json",), left))
    assert says.endswith("; 3 are still to be made: generate again rotor, top")


def test_an_interrupt_while_the_commands_are_imported_is_an_exit_code(monkeypatch, capsys) -> None:
    class Interrupted:
        def __getattr__(self, name: str) -> object:
            raise KeyboardInterrupt

    monkeypatch.setitem(sys.modules, "derive.cli", Interrupted())
    assert run() == 130
    assert capsys.readouterr().err == "derive: stopped before it began\n"
