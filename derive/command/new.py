"""``derive new``: a commented scene to begin with, and the schema that editors read beside it."""

import argparse
from pathlib import Path

from derive.command.parsed import word_of
from derive.command.terminal import console
from derive.scene import SceneError
from derive.scene.names import file_name
from derive.scene.schema import schema_text

STARTERS = Path(__file__).parents[1] / "scene" / "starters"
SCHEMA = Path("scene.schema.json")


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive new``."""
    words = ("body", "machine")
    command.add_argument(
        "what", type=word_of(words), choices=words, help="a single body, or a machine"
    )
    command.add_argument("name", metavar="NAME", help="what it is called: NAME.toml is written")
    command.set_defaults(run=begin)


def begin(given: argparse.Namespace) -> int:
    """Write a scene that is complete as it stands; nothing that is there already is touched."""
    file = Path(f"{file_name(given.name)}.toml")
    text = (STARTERS / f"{given.what}.toml").read_text(encoding="utf-8")
    try:
        with file.open("x", encoding="utf-8", newline="\n") as new:
            new.write(text.replace("NAME.toml", str(file)))
    except FileExistsError:
        raise SceneError(f"{file} is there already; give another name, or delete it") from None
    if not SCHEMA.exists():
        SCHEMA.write_text(schema_text(), encoding="utf-8")
    console.print(f"{file} written, and {SCHEMA} for editors; next: derive generate {file}")
    return 0
