"""Programs that move a body by several methods: built, run for end states and time, counted."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from bench import callgrind
from bench.build import BuildError, run
from bench.motion.case import Case

REAL = {"f32": "float", "f64": "double"}
FLAGS = ("-std=gnu99", "-O2", "-fno-lto", "-w")


@dataclass(frozen=True)
class Mover:
    """A program and its methods in order; ``parameters`` says which numbers of a case it takes."""

    path: Path
    methods: tuple[str, ...]
    parameters: int


@dataclass(frozen=True)
class Job:
    """One motion by one method.

    step : step in s, or tolerance of an adaptive method     steps : 1 for those that need none
    every : sample the state after so many steps, 0 only at the end
    """

    method: str
    step: float
    steps: int
    every: int = 0
    rounds: int = 1


@dataclass(frozen=True)
class Motion:
    """What a job gave: passes of its loop, seconds of the fastest round, (q, omega) samples."""

    passes: int
    seconds: float
    states: tuple[tuple[float, ...], ...]


@dataclass(frozen=True)
class Count:
    """Instructions once a motion, and those of all its passes."""

    start: int
    going: int
    passes: int


def built(
    texts: Mapping[str, str],
    methods: Sequence[str],
    parameters: int,
    folder: Path,
    flags: Sequence[str] = (),
) -> Mover:
    """Compile C texts, which define ``methods``, with the driver."""
    folder.mkdir(parents=True, exist_ok=True)
    own = {name: _own(name) for name in ("drive.c", "drive.h")}
    for name, text in (own | dict(texts)).items():
        (folder / name).write_text(text, encoding="utf-8")
    units = [str(folder / name) for name in (own | dict(texts)) if name.endswith(".c")]
    path = folder / "mover"
    run(("gcc", *FLAGS, *flags, f"-I{folder}", *units, "-o", str(path), "-lm"))
    return Mover(path, tuple(methods), parameters)


def methods_header(precision: str, parameters: int) -> str:
    """Return the text of ``methods.h``."""
    real = f"typedef {REAL[precision]} real;\n"
    return f'{real}#define PARAMETERS {parameters}\n#include "drive.h"\n'


def moved(
    mover: Mover, case: Case, parameters: Sequence[float], jobs: Sequence[Job]
) -> list[Motion | None]:
    """Run jobs on a case; None for a body that set-up refuses."""
    said = run((str(mover.path),), _given(mover, case, parameters, jobs)).decode()
    return [_motion(line) for line in said.splitlines()]


def counted(
    mover: Mover, case: Case, parameters: Sequence[float], jobs: Sequence[Job]
) -> list[Count]:
    """Return the instructions of jobs; raises FileNotFoundError without valgrind."""
    given = _given(mover, case, parameters, jobs)
    said, found = callgrind.counted((str(mover.path), "count"), given, mover.path.parent)
    passes = [int(n) for n in said.decode().split()]
    words, dumps = [p.word for p in found[:-1]], [p.instructions for p in found[:-1]]
    if words != ["start", "go"] * len(passes):
        raise BuildError(f"callgrind left other counts than were asked for: {words}")
    pairs = zip(dumps[::2], dumps[1::2], passes, strict=True)
    return [Count(*each) for each in pairs]


def _given(mover: Mover, case: Case, parameters: Sequence[float], jobs: Sequence[Job]) -> bytes:
    numbers = [*parameters, *map(float, case.q0), *map(float, case.omega0)]
    shown = " ".join(float(x).hex() for x in numbers)
    lines = [
        f"{mover.methods.index(j.method)} {j.step!r} {float(case.time)!r} {j.steps} {j.every}"
        f" {j.rounds} {shown}\n"
        for j in jobs
    ]
    return "".join(lines).encode()


def _motion(line: str) -> Motion | None:
    if line == "refused":
        return None
    passes, nanoseconds, *states = line.split()
    values = [float.fromhex(x) if "x" in x else float(x) for x in states]
    rows = tuple(tuple(values[n : n + 7]) for n in range(0, len(values), 7))
    return Motion(int(passes), float(nanoseconds) * 1e-9, rows)


def _own(name: str) -> str:
    return (files("bench.motion") / name).read_text(encoding="utf-8")
