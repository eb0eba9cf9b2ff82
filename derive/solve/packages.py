"""A scene's C as a package for firmware: proved and measured as all files, written as a whole."""

from collections.abc import Callable, Sequence
from pathlib import Path

from derive.emit.files import OutputError, require_folder, unfinished, write
from derive.emit.package.files import package_files
from derive.emit.package.kinds import BUILD_TOOLS, OURS
from derive.program.precision import PRECISIONS
from derive.scene.table import one_of
from derive.solve.generation import STATED, FigureSource, Generation
from derive.solve.handle import Handle, silent
from derive.solve.several import made_of
from derive.solve.told import path

TOOLS = tuple(BUILD_TOOLS)
"""The build tools that a package can be for."""
TYPES_OF_C = {p.scalar: (p,) for p in PRECISIONS} | {"both": PRECISIONS}
"""In which types of C a package computes, by word."""
ROOMS = ("*", "src/*", "single/*", "test/*", "examples/*", "examples/*/*", "zephyr/*")
"""Where files of packages lie."""


def package(
    scene: Handle,
    folder: str | Path,
    tools: Sequence[str] = TOOLS,
    precision: str = "both",
    kept_in: str | Path = "generated",
    samples: int = STATED,
    figures: FigureSource = "kept",
    told: Callable[[str], None] = silent,
) -> Generation:
    """Write a scene's C, a test, examples and what build tools read to a folder of their own.

    tools   : those that it is for, of TOOLS          precision : "float", "double" or "both"
    kept_in : the folder of generated files, from which figures are taken over
    Raises DeriveError for a folder that holds files of others by the names that are needed.
    """
    into = path("package", folder)
    kinds = [one_of(tool, "for", TOOLS) for tool in tools]
    precisions = TYPES_OF_C[one_of(precision, "precision", TYPES_OF_C)]
    require_folder(into)
    (made,) = made_of([scene], kept_in, samples, figures, "costs", told)
    own = {name.partition("/")[2]: text for name, text in made.texts.items()}
    texts = package_files(scene.library, own, made.figures, kinds, precisions)
    _require_ours(into, texts)
    stopped = unfinished(into)
    write(into, texts)
    return Generation(into, tuple(texts), (made,), stopped, unfinished(into))


def _require_ours(folder: Path, texts: dict[str, str]) -> None:
    """Refuse to write over a file that no package left there, or beside those of another one."""
    rule = f"package '{folder}' must be a folder of its own, but holds"
    for name, text in texts.items():
        if (folder / name).is_file() and not _marks(folder / name) & {m for m in OURS if m in text}:
            raise OutputError(f"{rule} another '{name}'")
    for file in sorted(f for own in ROOMS for f in folder.glob(own)):
        name = file.relative_to(folder).as_posix()
        if name not in texts and file.is_file() and _marks(file):
            raise OutputError(f"{rule} '{name}' of another package, or of other options; remove it")


def _marks(file: Path) -> set[str]:
    there = file.read_bytes().decode(errors="replace")
    return {mark for mark in OURS if mark in there}
