"""The generated files of scenes: made in memory, written whole, or compared with what is there."""

import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import unified_diff
from pathlib import Path

from derive.casadi_text import casadi_file
from derive.emit import c_files
from derive.library import Library
from derive.manifest import manifest
from derive.page.scene import scene_page
from derive.program import Measurement


class OutputError(OSError):
    """A folder or file that cannot be written; the sentence names it and the reason."""


@dataclass(frozen=True)
class Difference:
    """One file that is not what would be generated, and how it differs.

    left_over : no scene makes the file, so that only deleting it mends the difference
    """

    name: str
    diff: str
    left_over: bool


def scene_files(
    library: Library, figures: Sequence[Measurement], digest: str = ""
) -> dict[str, str]:
    """Return the path below the output folder and the text of every file of a scene."""
    name = library.known.scene.name
    texts = c_files(library, figures) | {
        f"{name}_casadi.py": casadi_file(library),
        f"{name}.json": manifest(library, figures, digest),
        f"{name}.html": scene_page(library, figures),
    }
    return {f"{name}/{file}": text for file, text in texts.items()}


def write(folder: Path, texts: Mapping[str, str]) -> None:
    """Write all ``texts`` below ``folder``, each file replaced as a whole or not at all.

    Raises OutputError, with no file half-written, if a folder or file cannot be written. However
    it ends, nothing temporary is left.
    """
    staged: list[tuple[Path, Path]] = []
    try:
        for name, text in texts.items():
            target = folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            staged.append((_temporary(target, text), target))
        for temporary, target in staged:
            os.replace(temporary, target)
    except OSError as error:
        raise OutputError(
            f"output folder '{folder}' must be writable, but: {error.strerror or error}"
        ) from error
    finally:
        for temporary, _ in staged:
            temporary.unlink(missing_ok=True)


def require_writable(file: Path) -> None:
    """Raise OutputError unless ``file`` can be written; leave it as it is."""
    try:
        _temporary(file, "").unlink()
    except OSError as error:
        raise OutputError(
            f"output file '{file}' must be writable, but: {error.strerror or error}"
        ) from error


def _temporary(target: Path, text: str) -> Path:
    if target.is_dir():
        raise IsADirectoryError(0, f"'{target.name}' is a folder")
    descriptor, path = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(text.encode())
        os.chmod(path, 0o644)
    except BaseException:
        Path(path).unlink(missing_ok=True)
        raise
    return Path(path)


def differences(folder: Path, texts: Mapping[str, str]) -> Iterator[Difference]:
    """Yield every file below ``folder`` that differs from ``texts``, is missing or left over."""
    for name, text in texts.items():
        path = folder / name
        found = path.read_bytes().decode(errors="replace") if path.is_file() else ""
        if not path.is_file():
            yield Difference(name, f"{name}: missing\n", left_over=False)
        elif found != text:
            lines = unified_diff(
                found.splitlines(keepends=True),
                text.splitlines(keepends=True),
                f"{name} (found)",
                f"{name} (generated)",
                n=1,
            )
            yield Difference(name, "".join(lines), left_over=False)
    for folder_name in sorted({name.split("/")[0] for name in texts if "/" in name}):
        yield from _left_over(folder, folder_name, texts)


def folders_left_over(folder: Path, texts: Mapping[str, str]) -> Iterator[Difference]:
    """Yield the files of folders below ``folder`` that none of ``texts``, a whole catalogue, is in.

    A folder counts that holds a JSON of its own name, as every scene's does; others are no scenes.
    """
    made = {name.split("/")[0] for name in texts}
    for path in sorted(folder.glob("*/")):
        if path.name not in made and (path / f"{path.name}.json").is_file():
            yield from _left_over(folder, path.name, texts)


def _left_over(folder: Path, name: str, texts: Mapping[str, str]) -> Iterator[Difference]:
    for path in sorted((folder / name).glob("*")):
        file = f"{name}/{path.name}"
        if file not in texts and path.is_file():
            yield Difference(file, f"{file}: no scene makes this file; delete it\n", left_over=True)
