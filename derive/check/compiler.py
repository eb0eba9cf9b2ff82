"""A C compiler, found or explained, and shared libraries made by it with the strictest warnings."""

import ctypes
import hashlib
import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from derive.scene.declaration import DeriveError

WARNINGS = (
    *("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wdouble-promotion", "-Wshadow"),
    *("-Wstrict-prototypes", "-Wfloat-equal", "-Werror"),
)
OPTIMISED = ("-std=c99", "-O2", *WARNINGS)
FLAGS = (*OPTIMISED, "-fPIC", "-shared")
HOW_TO_GET_ONE = (
    "no C compiler: set CC, put gcc, cc or clang on the PATH, or `python -m pip install ziglang`"
)


class CompilerError(DeriveError, RuntimeError):
    """No compiler, or a file that it refuses; the message is the sentence or what it said."""


@dataclass(frozen=True)
class Compiler:
    """A command that compiles C."""

    command: tuple[str, ...]

    @property
    def name(self) -> str:
        """Return the command as one would type it."""
        return "python -m ziglang cc" if "ziglang" in self.command else " ".join(self.command)


def find_compiler() -> Compiler:
    """Return the first of $CC, gcc, cc, clang and the ziglang wheel.

    Raises CompilerError with one sentence that says how to get one.
    """
    named = shlex.split(os.environ.get("CC", ""))
    for command in (named, ["gcc"], ["cc"], ["clang"]):
        if command and shutil.which(command[0]):
            return Compiler(tuple(command))
    if find_spec("ziglang") is not None:
        return Compiler((sys.executable, "-m", "ziglang", "cc"))
    raise CompilerError(HOW_TO_GET_ONE)


def compiled(texts: Mapping[str, str], source: str, folder: Path, with_: Compiler) -> Path:
    """Return a shared library made of one source among ``texts``, headers beside it.

    The same texts are compiled once a folder. Raises CompilerError with the compiler's complaint;
    a warning is one.
    """
    content = "\0".join((*with_.command, source, *(f"{n}\0{t}" for n, t in sorted(texts.items()))))
    place = folder / hashlib.sha256(content.encode()).hexdigest()[:16]
    library = place / f"{Path(source).stem}.so"
    if not library.exists():
        place.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            (place / name).write_text(text, encoding="utf-8")
        answer_of((*with_.command, *FLAGS, source, "-o", library.name, "-lm"), place)
    if not library.exists():
        raise CompilerError(f"`{' '.join(with_.command)}` made no library, and did not say why")
    return library


def program_made(text: str, source: str, folder: Path, with_: Compiler) -> Path:
    """Return a program made of one source, which may open shared libraries.

    It is made once a folder. Raises CompilerError with the compiler's complaint.
    """
    program = folder / Path(source).stem
    if not program.exists():
        (folder / source).write_text(text, encoding="utf-8")
        answer_of((*with_.command, *OPTIMISED, source, "-o", program.name, "-ldl"), folder)
    return program


def callable_library(library: Path) -> ctypes.CDLL:
    """Return a library as this process calls it.

    Raises CompilerError for one that was made for another machine.
    """
    try:
        return ctypes.CDLL(str(library))
    except OSError as error:
        said = str(error).removeprefix(f"{library}: ")
        raise CompilerError(
            f"what the compiler made cannot be called here: {said}; set CC to one for this machine"
        ) from None


def answer_of(command: tuple[str, ...], folder: Path) -> str:
    """Return what a command prints. Raises CompilerError with its complaint."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        said = done.stderr.strip()[-2000:] or f"nothing, and ended with code {done.returncode}"
        raise CompilerError(f"`{' '.join(command)}` said: {said}")
    return done.stdout
