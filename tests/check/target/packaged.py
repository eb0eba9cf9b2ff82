"""The package that is tried in the tools that it is for, and how these are called."""

import shutil
import subprocess
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

import pytest

from derive.emit.c.source import c_files
from derive.emit.files import write
from derive.emit.package.files import package_files
from derive.emit.package.kinds import BUILD_TOOLS
from derive.program.precision import Precision
from tests.made import library_of

NAME = "heavy_top"
"""A scene that calls the library's sines, and so needs it linked."""


def write_package(folder: Path, precisions: Sequence[Precision]) -> None:
    made = library_of(NAME)
    folder.mkdir(parents=True)
    write(folder, package_files(made, c_files(made, ()), (), tuple(BUILD_TOOLS), precisions))


def told(folder: Path, *command: str) -> str:
    """Return what a command says; it must succeed."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def required(*names: str) -> None:
    """Skip a test whose tools are not here: commands, or modules of Python."""
    for name in names:
        if shutil.which(name) is None and find_spec(name) is None:
            pytest.skip(f"{name} is not here")
