"""How commands are told what to do: bad arguments are refused by one sentence."""

import argparse
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from math import isfinite
from pathlib import Path
from typing import NoReturn

from derive.scene.declaration import SceneError
from derive.scene.escape import brief, visible
from derive.scene.table import nearest

COMMAND = "a command is missing"
HELPS = ("-h", "--help")
MISSING = "the following arguments are required: "


class Parser(argparse.ArgumentParser):
    """The parser of the standard library, which else prints its usage above the sentence."""

    def error(self, message: str) -> NoReturn:
        """Refuse arguments. Raises SceneError with a sentence that begins at the command."""
        if message.startswith(MISSING):
            names = message.removeprefix(MISSING)
            message = f"{names} {'are' if ', ' in names else 'is'} missing"
        raise SceneError(f"{self.prog.removeprefix('derive').strip()}: {message}".lstrip(": "))


def parsed(top: Parser, commands: Iterable[str], arguments: Sequence[str]) -> argparse.Namespace:
    """Return what a command is told. Raises SceneError for what none knows."""
    first = arguments[0] if arguments else ""
    if not first.startswith("-") and first not in commands:
        hint = nearest(first, commands)
        raise SceneError(f"{f'there is no command {typed(first)}' if first else COMMAND}{hint}")
    if first.startswith("-") and (option := first.partition("=")[0]) not in _every_option(top):
        raise SceneError(f"{typed(option)} is no option{nearest(option, _options(top))}")
    told, more = top.parse_known_args(arguments)
    if more:
        option = more[0].partition("=")[0]
        one = "no option" if option.startswith("-") else "one argument too many"
        hint = _hint(option, top, told.parser_of) if option.startswith("-") else ""
        raise SceneError(f"{told.parser_of.prog[7:]}: {typed(option)} is {one}{hint}")
    return told


def _hint(option: str, top: Parser, own: Parser) -> str:
    """Return which other commands have an option, or begin one so; else what resembles it."""
    commands = next(a for a in vars(top)["_actions"] if isinstance(a.choices, Mapping)).choices
    having = [
        name for name, other in commands.items()
        if any(o.startswith(option) for o in _options(other))
    ] if option.strip("-") else []  # fmt: skip
    if having:
        return f" of it (but of {', '.join(having)})"
    return nearest(option, _options(own))


def _every_option(of: Parser) -> list[str]:
    return [*vars(of)["_option_string_actions"]]


def _options(of: Parser) -> list[str]:
    """Return the long options of a parser but for its help, which resembles everything short."""
    known = vars(of)["_option_string_actions"]
    return [o for o in known if o.startswith("--") and o not in HELPS]


def typed(text: str) -> str:
    """Return what was typed as a sentence shows it."""
    return f"'{brief(visible(text))}'"


def word_of(words: Iterable[str]) -> Callable[[str], str]:
    """Return what reads one of a few words."""

    def read(text: str) -> str:
        if text in (known := tuple(words)):
            return text
        raise argparse.ArgumentTypeError(f"must be one of {', '.join(known)}, not {typed(text)}")

    return read


def whole(most: int) -> Callable[[str], int]:
    """Return what reads a number of something."""

    def read(text: str) -> int:
        digits = len(str(most))
        if not text.isdecimal() or len(text) > digits or not 0 < int(text) <= most:
            rule = f"must be a whole number above zero, up to {most}"
            raise argparse.ArgumentTypeError(f"{rule}, not {typed(text)}")
        return int(text)

    return read


def seconds(text: str) -> float:
    """Return a time, which a double can hold."""
    with suppress(ValueError):
        if isfinite(time := float(text)):
            return time
    raise argparse.ArgumentTypeError(f"must be a number of seconds, as 0.5, not {typed(text)}")


def location(text: str) -> Path:
    """Return where a file or folder is."""
    if not text.strip():
        raise argparse.ArgumentTypeError(f"must be a path, not {typed(text)}")
    return Path(text)
