"""``derive completion``: what a shell needs to complete commands, options, scenes and files."""

import argparse
import sys
from collections.abc import Iterator

import shtab

from derive.command.parsed import word_of
from derive.scene import catalogue

SHELLS = ("bash", "zsh", "tcsh")
_BASH = """\
_derive_scenes() {{
  compgen -W "{names}" -- "$1"
  compgen -f -X '!*.toml' -- "$1"
  compgen -d -S / -- "$1"
}}
"""
_ZSH = """\
_derive_scenes() {{
  _alternative 'scenes:scene of the catalogue:({names})' 'files:TOML file:_files -g "*.toml"'
}}
"""
SCENES = {"bash": "_derive_scenes", "zsh": "_derive_scenes", "tcsh": "f:*.toml"}
"""What completes a scene in each shell."""


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive completion``."""
    command.add_argument(
        "shell", type=word_of(SHELLS), choices=SHELLS, help="whose completion is printed"
    )
    command.set_defaults(run=print_completion)


def print_completion(given: argparse.Namespace) -> int:
    """Print what the shell is to read: ``eval "$(derive completion bash)"``."""
    for action in _scenes(given.parser):
        vars(action)["complete"] = SCENES
    names = " ".join(catalogue())
    known = {"bash": _BASH.format(names=names), "zsh": _ZSH.format(names=names)}
    preamble = known.get(given.shell, "")
    sys.stdout.write(f"{shtab.complete(given.parser, given.shell, preamble=preamble)}\n")
    return 0


def _scenes(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    """Yield the arguments of all commands that are scenes."""
    for action in vars(parser)["_actions"]:
        if isinstance(action.choices, dict):
            for command in action.choices.values():
                yield from _scenes(command)
        if action.metavar == "SCENE":
            yield action
