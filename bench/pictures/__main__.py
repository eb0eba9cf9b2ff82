"""``python -m bench.pictures``: draw the pictures anew, after ``derive generate`` or a report."""

import sys
from pathlib import Path

from bench.pictures.front import SCENE, front
from bench.pictures.palette import PALETTES
from derive.command.terminal import OUT, console
from derive.emit.files import write
from derive.library.library import library
from derive.scene import load

PLACE = Path("docs/pictures")


def main() -> int:
    """Write the picture of the README for light and for dark pages; return the exit code."""
    programs = library(load(SCENE))
    texts = {f"front_{name}.svg": front(programs, OUT, own) for name, own in PALETTES.items()}
    write(PLACE, texts)
    console.print(f"{len(texts)} pictures in {PLACE}/")
    return 0


if __name__ == "__main__":
    sys.exit(main())
