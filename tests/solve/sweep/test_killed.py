"""A sweep that is killed or stopped leaves no process behind and no folder shut, and goes on."""

import os
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path

import pytest

import derive
from derive.cli import main
from derive.solve.sweep.store import parts_of
from tests.solve.sweep.swept_tops import HELD, KEPT, STOP, VARIED, swept_top
from tests.solve.sweep.test_sweep import same

LONGEST = 60.0
"""s, in which what a test waits for must happen."""
BRIEF, SLOW = 0.05, 0.2


def slowly(_says: str, _done: int, _of: int) -> None:
    time.sleep(SLOW)


def to_the_end(folder: Path) -> None:
    os.setsid()
    swept_top(folder, workers=2, chunk=20, told=slowly)


def by_command(folder: Path) -> None:
    os.setsid()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    ways, held = ([f"{n}={x}" for n, x in own.items()] for own in (VARIED, HELD))
    told = ["sweep", "sleeping_top", "--vary", *ways, "--set", *held, "--samples", "4e5",
            "--until", "0.2", "--keep", *KEPT, "--stop", STOP, "--step", "1e-3",
            "--chunk", "2000", "--workers", "2", "--out", str(folder)]  # fmt: skip
    os._exit(main(told))


@contextmanager
def started(work: Callable[[Path], None], folder: Path, parts: int) -> Iterator[int]:
    """Start a sweep apart and wait until so many of its chunks are done; give its group."""
    own = get_context("fork").Process(target=work, args=(folder,))
    own.start()
    ends = time.monotonic() + LONGEST
    while len(parts_of(folder)) < parts and time.monotonic() < ends:
        time.sleep(BRIEF / 5)
    assert own.pid is not None
    yield own.pid
    own.join(LONGEST)
    assert own.exitcode is not None


def is_left(group: int) -> bool:
    """Tell whether a group has a process yet, once there was time to end."""
    ends = time.monotonic() + LONGEST / 10
    while time.monotonic() < ends:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return False
        time.sleep(BRIEF)
    return True


@pytest.mark.long
def test_a_killed_sweep_leaves_no_process_and_goes_on_with_the_same_bits(tmp_path: Path) -> None:
    derive.load("sleeping_top").library.printed()
    folder = tmp_path / "runs"
    for parts in (2, 5, 9):
        with started(to_the_end, folder, parts) as group:
            os.kill(group, signal.SIGKILL)
        before = {p: p.stat().st_mtime_ns for p in parts_of(folder).values()}
        assert parts <= len(before) < 30
        assert not is_left(group)
    again = swept_top(folder, workers=3)
    assert {p: p.stat().st_mtime_ns for p in before} == before
    assert same(again, swept_top(tmp_path / "undisturbed"))


@pytest.mark.long
def test_a_key_stops_a_sweep_in_one_line(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "runs"
    with started(by_command, folder, 2) as group:
        os.killpg(group, signal.SIGINT)
    said = "derive: stopped; every file is whole, some may be new\n"
    out, err = capfd.readouterr()
    assert (out, err.lstrip("\n")) == ("", said)  # older rich ends its progress with a line
    assert not is_left(group)
    assert len(parts_of(folder)) < 200


@pytest.mark.long
def test_a_folder_that_was_moved_and_a_sweep_that_is_at_work(tmp_path: Path) -> None:
    whole = swept_top(tmp_path / "whole")
    with started(to_the_end, tmp_path / "first", 2) as group:
        with pytest.raises(derive.DeriveError, match="another sweep is at work in it"):
            swept_top(tmp_path / "first")
        os.killpg(group, signal.SIGKILL)
    (tmp_path / "first").rename(tmp_path / "second")
    assert same(swept_top(tmp_path / "second"), whole)
