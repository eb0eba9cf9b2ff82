"""Blocks of code on a page of the documents, each with what the page says that it prints."""

import re
from contextlib import chdir, redirect_stdout
from dataclasses import dataclass
from io import BytesIO, TextIOWrapper
from pathlib import Path

from derive.cli import main

NEAR = 1.0  # px: what versions of matplotlib and IPOPT may draw otherwise
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$(?:\n```text\n(.*?)^```$)?", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Block:
    """A block of a language, and the block of text below it: what it prints, None if not said."""

    language: str
    text: str
    shown: str | None


def blocks(page: Path) -> list[Block]:
    """Return the blocks of a page, in their order."""
    return [Block(*found.groups()) for found in BLOCK.finditer(page.read_text(encoding="utf-8"))]


def printed(text: str) -> str:
    """Return what was printed as a page shows it: without blanks at the ends of lines."""
    return "".join(f"{line.rstrip()}\n" for line in text.strip("\n").splitlines())


def told(command: list[str], folder: Path) -> str:
    """Return what a command of ours prints, run in a folder; it must succeed.

    command : its words; behind a "|" the beginning of what is printed may be cut, by head -n
    """
    own, cut = (command[: command.index("|")], command[-1]) if "|" in command else (command, "")
    assert own[0] == "derive"
    assert command[len(own) :] == (["|", "head", "-n", cut] if cut else [])
    out = TextIOWrapper(BytesIO(), "utf-8")
    with chdir(folder), redirect_stdout(out):
        assert main(own[1:]) == 0, command
    out.seek(0)
    lines = out.read().splitlines()
    return printed("\n".join(lines[: int(cut)] if cut else lines))


def standalone(page: str) -> str:
    """Return the first drawing of a scene's page as a file of its own, with the page's colours."""
    (drawn, *_) = re.findall(r'<svg class="drawing".*?</svg>', page, re.DOTALL)
    (style, *_) = re.findall(r"<style>(.*?)</style>", page, re.DOTALL)
    rules = [line for line in style.splitlines() if re.match(r"[@:}]|.*\bdrawing\b", line)]
    colours = "\n".join(line.replace("width: 100%; height: auto; ", "") for line in rules)
    head, rest = drawn.split(">", 1)
    return f'{head} xmlns="http://www.w3.org/2000/svg"><style>\n{colours}\n</style>{rest}\n'


def curves(svg: str) -> list[float]:
    """Return the coordinates of all lines of a picture, but not of letters and marks."""
    bare = re.sub(r"<(defs|style|clipPath)\b.*?</\1>", "", svg, flags=re.DOTALL)
    lines = re.findall(r'(?:points| d)="([^"]*)"', bare)
    return [float(x) for line in lines for x in re.findall(r"-?\d+(?:\.\d+)?", line)]
