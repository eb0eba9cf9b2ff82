"""Instructions that parts of a program take, counted by Valgrind's callgrind.

A program that is counted tells where a part ends: by a request of valgrind/callgrind.h, or by a
call of the function ``MARKING``. What starts and ends a program belongs to no part.
"""

import re
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from derive.scene.declaration import DeriveError

MARKING = "callgrind_mark"
TOTAL = re.compile(r"^(?:summary|totals):\s*(\d+)\s*$", re.MULTILINE)
REQUEST = re.compile(r"^desc: Trigger: Client Request: (\w+)$", re.MULTILINE)


class CallgrindError(DeriveError, RuntimeError):
    """A program that cannot be counted; the message is what it or valgrind said."""


@dataclass(frozen=True)
class Stretch:
    """Instructions since the part before, and the word that the program's request gave to it."""

    word: str
    instructions: int


def is_there() -> bool:
    """Tell whether there is a valgrind."""
    return shutil.which("valgrind") is not None


def total(text: str) -> int:
    """Return the instruction total of a callgrind output file.

    >>> total("version: 1\\nevents: Ir\\nsummary: 4711\\n")
    4711
    """
    found = TOTAL.findall(text)
    if not found or "events: Ir" not in text:
        raise CallgrindError("a callgrind file without 'events: Ir' or without a total")
    return int(found[-1])


def stretches(command: Sequence[str], given: bytes, folder: Path) -> tuple[bytes, list[Stretch]]:
    """Run a program; return what it prints and its parts in order, the last one to its end.

    Raises FileNotFoundError without valgrind, CallgrindError if the run fails.
    """
    if not is_there():
        raise FileNotFoundError("no valgrind")
    for old in folder.glob("callgrind.out*"):
        old.unlink()
    tool = ("valgrind", "--tool=callgrind", "-q", f"--dump-before={MARKING}",
            f"--callgrind-out-file={folder / 'callgrind.out'}")  # fmt: skip
    done = subprocess.run((*tool, *command), input=given, capture_output=True, check=False)
    if done.returncode:
        said = done.stderr.decode(errors="replace")[-2000:]
        raise CallgrindError(f"`{' '.join(command)}` ended with {done.returncode}: {said}")
    numbered = sorted(folder.glob("callgrind.out.*"), key=lambda path: int(path.suffix[1:]))
    files = [*numbered, folder / "callgrind.out"]
    return done.stdout, [_stretch(path.read_text(errors="replace")) for path in files]


def _stretch(text: str) -> Stretch:
    return Stretch(next(iter(REQUEST.findall(text)), ""), total(text))
