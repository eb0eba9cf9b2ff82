"""The folder of a sweep: finished chunks, each a whole file of Parquet, and what the sweep is.

A chunk is written beside its place and put there at once, so what lies there is whole. The folder
tells of one sweep and takes no other; who finds it half full goes on.
"""

import json
import os
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from time import monotonic, sleep
from typing import Any

from derive.emit.files import OutputError
from derive.scene import SceneError
from derive.scene.table import shown

MANIFEST = "_sweep.json"
"""A name that readers of Parquet folders pass over, as all that begin so."""
LOCK = "_lock"
PATIENCE = 2.0
"""s, until processes of a sweep that was killed must have left its folder."""
PART = re.compile(r"part-([0-9]{12})\.parquet")


def part_name(first: int) -> str:
    """Return the name of the file of a chunk, by its first member.

    >>> part_name(4096)
    'part-000000004096.parquet'
    """
    return f"part-{first:012d}.parquet"


@contextmanager
def only_sweep_in(folder: Path) -> Iterator[None]:
    """Keep a folder to one sweep at a time. Raises SceneError if another works in it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = (folder / LOCK).open("wb")
    except OSError as error:
        says = f"folder '{folder}' of the sweep must be writable"
        raise OutputError(f"{says}, but: {error.strerror}") from error
    with file:
        with suppress(ImportError):
            import fcntl

            ends = monotonic() + PATIENCE
            while not _locked(partial(fcntl.flock, file, fcntl.LOCK_EX | fcntl.LOCK_NB)):
                if monotonic() > ends:
                    raise SceneError(f"folder '{folder}': another sweep is at work in it")
                sleep(PATIENCE / 40)
        yield


def _locked(lock: Callable[[], None]) -> bool:
    try:
        lock()
    except OSError:
        return False
    return True


def manifest_of(folder: Path) -> dict[str, Any] | None:
    """Return what a folder tells of its sweep, None where there is none yet.

    Raises SceneError for a folder that holds something else.
    """
    file = folder / MANIFEST
    if file.is_file():
        try:
            found = json.loads(file.read_text(encoding="utf-8"))
        except (ValueError, OSError):
            found = None
        if not isinstance(found, dict) or not isinstance(found.get("asked"), dict):
            raise SceneError(f"'{file}' does not tell of a sweep; name another folder")
        return found
    if folder.exists() and not folder.is_dir():
        raise SceneError(f"'{folder}' is a file; a sweep needs a folder")
    if any(p.name != LOCK and not p.name.startswith(".") for p in _listed(folder)):
        raise SceneError(f"folder '{folder}' holds files that are of no sweep; name another")
    return None


def _listed(folder: Path) -> list[Path]:
    return sorted(folder.iterdir()) if folder.is_dir() else []


def require_same(folder: Path, there: Mapping[str, Any], asked: Mapping[str, Any]) -> None:
    """Raise SceneError if a folder holds another sweep than the one that is asked for."""
    for name in dict.fromkeys((*asked, *there)):
        if there.get(name) != asked.get(name):
            was, now = (_short(own.get(name)) for own in (there, asked))
            says = f"folder '{folder}' holds another sweep: its {name} is {was}, not {now}"
            raise SceneError(f"{says}; name another folder")


def _short(value: Any) -> str:
    return shown(value if isinstance(value, str) else json.dumps(value))


def parts_of(folder: Path) -> dict[int, Path]:
    """Return the finished chunks of a folder by their first members."""
    named = ((PART.fullmatch(p.name), p) for p in _listed(folder))
    return {int(found[1]): p for found, p in named if found}


def put_whole(folder: Path, name: str, content: bytes) -> None:
    """Write a file whole, or not at all. Raises OutputError if there is no room for it."""
    temporary = folder / f".{name}.unfinished"
    try:
        with temporary.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, folder / name)
    except OSError as error:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        says = f"'{folder / name}' could not be written: {error.strerror}"
        mend = "what was finished stays, and the same sweep goes on there once it can"
        raise OutputError(f"{says}; {mend}") from error
