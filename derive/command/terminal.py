"""Where the commands print, and where the files lie that they speak of."""

import sys
from pathlib import Path

from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from derive.scene.escape import visible

OUT = Path("generated")
WIDE = 150  # columns of a table that goes to a file or a pipe
console = Console(width=None if sys.stdout.isatty() else WIDE, markup=False, emoji=False)
error_console = Console(
    stderr=True, width=None if sys.stderr.isatty() else WIDE, markup=False, emoji=False
)


def complain(sentence: str, style: str) -> None:
    """Print a sentence on what is wrong; what a file or its name holds is shown, never obeyed."""
    shown = "\n".join(map(visible, sentence.split("\n")))
    error_console.print(
        shown, style=style, highlight=False, soft_wrap=not error_console.is_terminal
    )


def progress() -> Progress:
    """Return a progress line that vanishes when it is done."""
    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    return Progress(*columns, console=error_console, transient=True)
