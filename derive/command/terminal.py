"""Where the commands print, and where the files lie that they speak of."""

import sys
from pathlib import Path
from typing import TextIO

from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
from rich.table import Table

from derive.scene.escape import visible

OUT = Path("generated")
WIDE = 150  # columns of a table that goes to a file or a pipe


def _width(stream: TextIO | None) -> int | None:
    """Return the columns of a table, None for those of a terminal; None is a closed stream."""
    return None if stream is not None and stream.isatty() else WIDE


class Output(Console):
    """The console of a library that would end with the code of what differs where a pipe closes."""

    def on_broken_pipe(self) -> None:
        """Let the command line be told: who read has had enough."""
        raise BrokenPipeError


console = Output(width=_width(sys.stdout), markup=False, emoji=False)
error_console = Console(stderr=True, width=_width(sys.stderr), markup=False, emoji=False)


def complain(sentence: str, style: str) -> None:
    """Print a sentence on what is wrong; what a file or its name holds is shown, never obeyed."""
    shown = "\n".join(map(visible, sentence.split("\n")))
    error_console.print(
        shown, style=style, highlight=False, soft_wrap=not error_console.is_terminal
    )


def print_rows(table: Table, width: int | None = None) -> None:
    """Print a table; in a file or a pipe no line ends in blanks."""
    if console.is_terminal:
        console.print(table, width=width, highlight=False)
        return
    with console.capture() as shown:
        console.print(table, width=width, highlight=False)
    lines = [line.rstrip() for line in shown.get().splitlines()]
    console.print("\n".join(lines), highlight=False, soft_wrap=True)


def progress() -> Progress:
    """Return a progress line that vanishes when it is done; none where nobody looks on."""
    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    hidden = not error_console.is_terminal
    return Progress(*columns, console=error_console, transient=True, disable=hidden)
