"""Programs of a core run on its emulated board, and what they say, read."""

import subprocess
from dataclasses import dataclass
from pathlib import Path

from derive.check.target.core import Core
from derive.scene.declaration import DeriveError

NOPS = 1000
"""Instructions of the harness's first function."""
PATIENCE = 600  # seconds; the longest of the catalogue takes a few
_ICOUNT = ("-icount", "shift=7,align=off,sleep=off")
_SEMIHOSTING = ("-semihosting-config", "enable=on,target=native")
_QUIET = ("-nographic", "-monitor", "none", "-serial", "none")


class RunError(DeriveError, RuntimeError):
    """A program that did not say what it should; the sentence has what it said."""


@dataclass(frozen=True)
class Heard:
    """What the harness says of one function; ticks are of the board's counter."""

    bits: str
    values: int
    least: int
    most: int
    stack: int


def on_board(core: Core, program: Path) -> list[Heard]:
    """Return what a program says on a core's emulated board, its functions in order.

    Raises RunError if it ends otherwise, or if the function of known length has another.
    """
    first, *found = _lines(core.tools.emulator, said_on_board(core, program))
    if {counted(core, first.least), counted(core, first.most)} != {NOPS}:
        raise RunError(
            f"{core.name}: {NOPS} instructions must be counted as such, but "
            f"{first.least} to {first.most} ticks are {counted(core, first.least)}"
        )
    return found


def said_on_board(core: Core, program: Path) -> str:
    """Return the text of a program on a core's emulated board. Raises RunError if it has no end."""
    command = (core.tools.emulator, *core.machine, *_QUIET, *_SEMIHOSTING, *_ICOUNT)
    return said((*command, "-kernel", str(program)))


def here(program: Path) -> list[Heard]:
    """Return what the program of this machine says."""
    return _lines(str(program), said((str(program),)))[1:]


def counted(core: Core, ticks: int) -> int:
    """Return how many instructions a core has done in so many ticks."""
    return round(ticks / core.ticks)


def said(command: tuple[str, ...]) -> str:
    """Return the text of a command. Raises RunError if it has no end."""
    try:
        done = subprocess.run(command, capture_output=True, check=False, timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        raise RunError(f"{command[0]}: the program must end, but ran {PATIENCE} s") from None
    return (done.stdout + done.stderr).decode(errors="replace")


def _lines(who: str, text: str) -> list[Heard]:
    try:
        return [_line(line.split()) for line in text.splitlines()]
    except (ValueError, IndexError):
        raise RunError(f"{who}: a row of figures must come, but: {text[-300:]!r}") from None


def _line(words: list[str]) -> Heard:
    first, second, *rest = words
    values, least, most, stack = (int(word, 16) for word in rest)
    return Heard(first + second, values, least, most, stack)
