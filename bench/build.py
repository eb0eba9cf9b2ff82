"""A candidate compiled with the driver, run for its answers."""

import struct
import subprocess
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from bench.candidate import Candidate

Row = tuple[float, ...]

TOOLS = ("gcc", "valgrind")
SHARED = ("-fno-lto", "-w")
DRIVER = ("-O2", *SHARED)
# Valgrind 3.19 knows no AVX-512; without it both compilers use AVX2 and FMA.
NATIVE = ("-O3", "-march=native", "-mno-avx512f")


@dataclass(frozen=True)
class Column:
    """One way to compile: its name in the table and the compiler's flags."""

    name: str
    flags: tuple[str, ...]


O2 = Column("O2", ("-O2",))
O3_NATIVE = Column("O3-native", (*NATIVE, "-ffp-contract=off"))
O3_CONTRACTED = Column("O3-native, contracted", (*NATIVE, "-DDERIVE_ALLOW_CONTRACTION"))


class BuildError(RuntimeError):
    """A compiler or a built program failed or is missing; the message is what it said."""


def run(command: Sequence[str], given: bytes = b"") -> bytes:
    """Return what a command prints; raise BuildError with its complaint if it fails or is none."""
    try:
        done = subprocess.run(command, input=given, capture_output=True, check=False)
    except OSError as error:
        raise BuildError(f"`{command[0]}` cannot be run: {error.strerror}") from None
    if done.returncode:
        said = done.stderr.decode(errors="replace")[-2000:]
        raise BuildError(f"`{' '.join(command)}` ended with {done.returncode}: {said}")
    return done.stdout


def versions() -> dict[str, str | None]:
    """Return what each of ``TOOLS`` says that it is; None for one that is not there."""
    found: dict[str, str | None] = dict.fromkeys(TOOLS)
    for tool in TOOLS:
        with suppress(BuildError):
            found[tool] = run((tool, "--version")).decode().splitlines()[0]
    return found


def build(candidate: Candidate, column: Column, folder: Path) -> Path:
    """Compile a candidate with a column's flags and the driver with its own; return the program."""
    folder.mkdir(parents=True, exist_ok=True)
    for source in candidate.sources:
        (folder / source.name).write_text(source.text, encoding="utf-8")
    (folder / "glue.h").write_text(candidate.glue, encoding="utf-8")
    units = [s.name for s in candidate.sources if Path(s.name).suffix in {".c", ".cc"}]
    language = "g++" if any(name.endswith(".cc") for name in units) else "gcc"
    driver = folder / ("driver.cc" if language == "g++" else "driver.c")
    text = (files("bench") / "minimum" / "driver.c").read_text(encoding="utf-8")
    driver.write_text(text, encoding="utf-8")
    search = [f"-I{folder}", *(f"-I{place}" for place in candidate.folders)]
    search += [f"-D{macro}" for macro in candidate.macros]
    objects = []
    for name, flags in [*((unit, column.flags) for unit in units), (driver.name, DRIVER)]:
        objects.append(f"{folder / name}.o")
        run((language, *SHARED, *flags, *search, "-c", str(folder / name), "-o", objects[-1]))
    program = folder / "driver"
    run((language, *objects, "-o", str(program), "-lm"))
    return program


def answers(program: Path, rows: Sequence[Row], width: int) -> list[Row]:
    """Return the outputs of a program for rows of parameters and inputs."""
    data = run((str(program),), pack(rows))
    return list(struct.iter_unpack(f"={width}d", data))


def pack(rows: Sequence[Row]) -> bytes:
    """Return rows of doubles as bytes, one after the other.

    >>> len(pack([(1.0, 2.0), (3.0, 4.0)]))
    32
    """
    return b"".join(struct.pack(f"={len(row)}d", *row) for row in rows)
