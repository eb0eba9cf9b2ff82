"""The generated files of scenes: made in memory, written whole, or compared with what is there.

A run may be killed at any moment. What it wrote until then is told by a list of the files that it
was about to replace, and by temporary files whose process is gone: the next run mends both.
"""

import os
import stat
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from difflib import unified_diff
from pathlib import Path

from derive.emit.c.external import external_file
from derive.emit.c.members_file import OVER_MEMBERS, members_files
from derive.emit.c.relations import every_relation
from derive.emit.c.source import c_files
from derive.emit.casadi_text import casadi_file
from derive.emit.manifest import manifest
from derive.emit.on_target import ENDING
from derive.emit.page.scene import scene_page
from derive.emit.reported import NOTHING_BESIDE, Beside
from derive.library.external import StepDerivatives
from derive.library.library import Library
from derive.program.program import Measurement
from derive.scene.declaration import DeriveError
from derive.verify.kept import UNDIGESTED, Digests

MEASURED = ("_report.html", "_report.json", ENDING)
"""How files end that lie beside those of a scene and are measured, not generated."""
UNFINISHED = ".derive-unfinished"
"""Lists the files that a run is about to replace; it lies there until all of them are."""


class OutputError(DeriveError, OSError):
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
    library: Library,
    figures: Sequence[Measurement],
    digest: Digests = UNDIGESTED,
    by: Beside = NOTHING_BESIDE,
    of: StepDerivatives | None = None,
    parts: Sequence[str] = (),
) -> dict[str, str]:
    """Return the path below the output folder and the text of every file of a scene.

    digest : of what errors and bounds depend on      by : what lies beside them
    of     : the derivatives of a step, where C for CasADi is to lie beside the rest
    parts  : with "batch" C of functions over members lies there
    """
    name = library.scene.name
    texts = c_files(library, figures, by.on_target, every_relation(library)) | {
        f"{name}_casadi.py": casadi_file(library, figures, of),
        f"{name}.json": manifest(library, figures, digest, by.on_target, parts),
        f"{name}.html": scene_page(library, figures, by),
    }
    if OVER_MEMBERS in parts:
        texts |= members_files(library, figures)
    if of is not None:
        texts |= dict([external_file(library, of, figures)])
    return {f"{name}/{file}": text for file, text in texts.items()}


def manifests(folder: Path) -> list[Path]:
    """Return the JSON of every scene whose files lie below a folder; reports have another."""
    return sorted(p for p in folder.glob("*/*.json") if p.stem == p.parent.name)


def write(folder: Path, texts: Mapping[str, str]) -> None:
    """Write all ``texts`` below ``folder``, each file replaced as a whole or not at all.

    Raises OutputError, with no file half-written, if a folder or file cannot be written. However
    it ends, nothing temporary is left.
    """
    prepared: list[tuple[Path, Path]] = []
    try:
        with _told(f"output folder '{folder}' must be writable"):
            for temporary in abandoned(folder, texts):
                temporary.unlink(missing_ok=True)
            for name, text in texts.items():
                target = folder / name
                _require_own(folder, target.parent)
                target.parent.mkdir(parents=True, exist_ok=True)
                prepared.append((_temporary(target, text), target))
            before = unfinished(folder)
            _mark(folder, [*before, *texts])
            for temporary, target in prepared:
                os.replace(temporary, target)
            _mark(folder, [name for name in before if name not in texts])
    finally:
        for temporary, _ in prepared:
            temporary.unlink(missing_ok=True)


@contextmanager
def _told(rule: str) -> Iterator[None]:
    """Say which rule is broken where the system refuses something."""
    try:
        yield
    except OSError as error:
        raise OutputError(f"{rule}, but: {_reason(error)}") from error


def _reason(error: OSError) -> str:
    """Return why the system refuses, with the name of a file that lies where a folder is to be."""
    if isinstance(error, NotADirectoryError | FileExistsError) and error.filename:
        place = Path(error.filename)
        for above in (place, *place.parents):
            if above.exists() and not above.is_dir():
                return f"'{above}' is no folder"
    return error.strerror or str(error)


def unfinished(folder: Path) -> tuple[str, ...]:
    """Return the files below ``folder`` that a run was replacing when it was stopped."""
    file = folder / UNFINISHED
    if not file.is_file():
        return ()
    return tuple(dict.fromkeys(_read(file).splitlines())) or (UNFINISHED,)


def abandoned(folder: Path, texts: Mapping[str, str]) -> list[Path]:
    """Return the temporary files of runs that are gone, beside any of ``texts``."""
    places = sorted({folder, *((folder / name).parent for name in texts)})
    found = [path for place in places for path in sorted(place.glob(".*.derive-*"))]
    return [path for path in found if not path.is_dir() and _is_gone(path)]


def _is_gone(temporary: Path) -> bool:
    process = temporary.name.rpartition(".derive-")[2].partition("-")[0]
    if not process.isdecimal() or os.name != "posix":
        return False
    try:
        os.kill(int(process), 0)
    except (ProcessLookupError, OverflowError):
        return True
    except PermissionError:
        return False
    return False


def _mark(folder: Path, names: Sequence[str]) -> None:
    file = folder / UNFINISHED
    if names:
        temporary = _temporary(file, "".join(f"{name}\n" for name in names))
        try:
            os.replace(temporary, file)
        finally:
            temporary.unlink(missing_ok=True)
    else:
        file.unlink(missing_ok=True)


def _require_own(folder: Path, place: Path) -> None:
    """Refuse a folder of a scene that is a link: its files would be written somewhere else."""
    if place != folder and place.is_symlink():
        raise OSError(0, f"'{place.name}' is a link to another place")


def _read(file: Path) -> str:
    with _told(f"output file '{file}' must be readable"):
        return file.read_bytes().decode(errors="replace")


def require_folder(folder: Path) -> None:
    """Raise OutputError if what lies at ``folder`` is no folder, or nothing can lie there."""
    with _told(f"output folder '{folder}' must be writable"), suppress(FileNotFoundError):
        if not stat.S_ISDIR(os.stat(folder).st_mode):
            raise NotADirectoryError(0, "it is no folder")


def require_writable(file: Path) -> None:
    """Raise OutputError unless ``file`` can be written; leave it as it is."""
    with _told(f"output file '{file}' must be writable"):
        _temporary(file, "").unlink()


def _temporary(target: Path, text: str) -> Path:
    if target.is_dir():
        raise IsADirectoryError(0, f"'{target.name}' is a folder")
    if os.path.lexists(target) and not target.is_file():
        raise OSError(0, f"'{target.name}' is no regular file")
    prefix = f".{target.name}.derive-{os.getpid()}-"
    descriptor, path = tempfile.mkstemp(dir=target.parent, prefix=prefix)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(text.encode())
        os.chmod(path, 0o644)
    except BaseException:
        Path(path).unlink(missing_ok=True)
        raise
    return Path(path)


def differences(folder: Path, texts: Mapping[str, str]) -> Iterator[Difference]:
    """Yield every file below ``folder`` that differs from ``texts``, is missing or left over.

    So does what a run that was stopped has left: ``derive generate`` mends that too.
    """
    if stopped := unfinished(folder):
        says = f"a run was stopped while it replaced {len(stopped)} files: old and new ones may lie"
        yield Difference(UNFINISHED, f"{UNFINISHED}: {says} together\n", left_over=False)
    gone = abandoned(folder, texts)
    for path in gone:
        file = path.relative_to(folder).as_posix()
        yield Difference(file, f"{file}: left by a run that was stopped\n", left_over=False)
    for name, text in texts.items():
        path = folder / name
        found = _read(path) if path.is_file() else ""
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
        for each in _left_over(folder, folder_name, texts):
            if folder / each.name not in gone:
                yield each


def folders_left_over(folder: Path, texts: Mapping[str, str]) -> Iterator[Difference]:
    """Yield the files of folders below ``folder`` that none of ``texts``, a whole catalogue, is in.

    A folder counts that holds a JSON of its own name, as every scene's does; others are no scenes.
    """
    made = {name.split("/")[0] for name in texts}
    for path in sorted(folder.glob("*/")):
        if path.name not in made and (path / f"{path.name}.json").is_file():
            yield from _left_over(folder, path.name, texts)


def _left_over(folder: Path, name: str, texts: Mapping[str, str]) -> Iterator[Difference]:
    made = any(file.startswith(f"{name}/") for file in texts)
    own = {f"{name}{ending}" for ending in MEASURED if made}
    for path in sorted((folder / name).glob("*")):
        file = f"{name}/{path.name}"
        if file not in texts and path.is_file() and path.name not in own:
            yield Difference(file, f"{file}: no scene makes this file; delete it\n", left_over=True)
