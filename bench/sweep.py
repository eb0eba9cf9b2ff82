"""What a sweep costs: members a second a core, what engine and files take of it, memory.

``python -m bench.sweep`` prints what docs/sweep.md says of it, in its form, from one run. Times
of moving are of the processor, so that others on the machine disturb them little. Efficiencies of
more cores than there are here are computed from these figures, not measured.
"""

import json
import os
import re
import resource
import shlex
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import derive
from derive.solve.sweep.store import MANIFEST

PAGE = Path(__file__).parent.parent / "docs" / "sweep.md"
SEVERAL = re.MULTILINE | re.DOTALL
HELD = {"r": 0.05, "l": 0.06, "g": 9.81, "n": 40, "beta": 0, "alpha_dot": 0, "beta_dot": 0}
VARY = {"alpha": "uniform(1deg, 3deg)", "m": "normal(0.5, 0.01)"}
UNTIL, STEP = 0.02, 1e-3
CHUNK = 1 << 17
CORES = (10, 100, 1000)
SECONDS = (1.0, 10.0, 100.0)
TASKS = 200
BRIEF = 0.5
"""s, in which a scheduler answers a worker that has called it."""
FILE = 1 << 22
"""Bytes that a task returns: a file of a chunk."""
Row = tuple[int, int, float, float, float]
"""Members, processes, s, s of all processors, MB."""


@dataclass(frozen=True)
class ExampleTaken:
    """What a command of the page takes, in s and in s of all processors."""

    scene: str
    members: int
    steps: int
    wall: float
    spent: float


@dataclass(frozen=True)
class SweepFigures:
    """What was measured in one run, in s.

    fixed : that a sweep takes of processors before its first member
    task, task_with_file : of Dask, with nothing in it and with a file      disk : to write that
    """

    examples: tuple[ExampleTaken, ...]
    fixed: float
    rows: tuple[Row, ...]
    task: float
    task_with_file: float
    disk: float


def moved(folder: Path, members: int, workers: int) -> tuple[float, float, float]:
    """Return what a sweep takes: s, s of all processors, and MB of its largest process."""
    before, began = _spent(), time.perf_counter()
    derive.load("sleeping_top").sweep(
        VARY, folder, UNTIL, ["alpha@end", "beta@end"], HELD, members, step=STEP,
        workers=workers, chunk=CHUNK,
    )  # fmt: skip
    wall, spent = time.perf_counter() - began, _spent() - before
    return wall, spent, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def _spent() -> float:
    own, others = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return own.ru_utime + own.ru_stime + others.ru_utime + others.ru_stime


def nothing(size: int, number: int) -> bytes:
    """Return so many bytes, as a chunk that took no time."""
    return bytes([number % 256]) * size


def of_cluster(size: int) -> float:
    """Return the seconds of a task of Dask that does nothing and returns so many bytes."""
    import distributed

    with (
        distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as own,
        distributed.Client(own) as client,
    ):
        client.submit(nothing, size, -1, pure=False).result()
        began = time.perf_counter()
        tasks = [client.submit(nothing, size, k, pure=False) for k in range(TASKS)]
        for done in distributed.as_completed(tasks):
            done.result()
        spent = (time.perf_counter() - began) / TASKS
        client.run(silent)
        time.sleep(BRIEF)
        return spent


def silent(dask_worker: Any) -> None:
    """Have a worker call its scheduler no more: one that is closed then would not answer."""
    dask_worker.periodic_callbacks["heartbeat"].stop()


def of_disk(folder: Path) -> float:
    """Return the seconds of writing a file of a chunk, forced to the disk."""
    from derive.solve.sweep.store import put_whole

    began = time.perf_counter()
    for k in range(20):
        put_whole(folder, f"part-{k:012d}.parquet", nothing(FILE, k))
    return (time.perf_counter() - began) / 20


def examples() -> list[tuple[dict[str, str], list[str]]]:
    """Return the commands of the page, each with the files of scenes that stand before it."""
    text = PAGE.read_text(encoding="utf-8").replace("\\\n", " ")
    found, scenes = list[tuple[dict[str, str], list[str]]](), list[str]()
    for toml, line in re.findall(r"```toml\n(.*?)```|^    derive (sweep .*?)$", text, SEVERAL):
        if toml:
            scenes.append(toml)
        else:
            words = shlex.split(line)
            found.append((dict.fromkeys([words[1]], scenes.pop()) if scenes else {}, words))
    return found


def example_taken(place: Path, scenes: Mapping[str, str], words: Sequence[str]) -> ExampleTaken:
    """Return what a command of the page takes, as it is printed there."""
    for name, text in scenes.items():
        (place / name).write_text(text, encoding="utf-8")
    before, began = _spent(), time.perf_counter()
    command = [sys.executable, "-m", "derive", *words]
    subprocess.run(command, cwd=place, check=True, capture_output=True, env=stored(place))
    wall, spent = time.perf_counter() - began, _spent() - before
    told = json.loads((place / words[-1] / MANIFEST).read_text(encoding="utf-8"))
    return ExampleTaken(words[1], told["members"], told["steps"], wall, spent)


def stored(place: Path) -> dict[str, str]:
    """Return an environment in which modules are compiled once, as where they are installed."""
    own = {name: text for name, text in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return own | {"PYTHONPYCACHEPREFIX": str(place / "compiled")}


def told(of: SweepFigures) -> Iterator[str]:
    """Yield what docs/sweep.md says, in its form: whole lines of it."""
    yield "| command | members | steps of each | s | s of processors |"
    yield "|---|---|---|---|---|"
    for e in of.examples:
        many = f"{e.members:,}".replace(",", " ")
        yield f"| `{e.scene}` | {many} | {e.steps} | {e.wall:.0f} | {e.spent:.0f} |"
    members, _, _, most, _ = of.rows[-1]
    own = 1e6 * (most - of.fixed) / members
    yield (f"Deriving the scene, compiling and importing take {of.fixed:.1f} s of these; of the "
           f"rest a member takes {own:.1f} µs of a core. "
           "Memory is of the largest process.")  # fmt: skip
    yield "| members | processes | s | s of processors | members a second a core | MB |"
    yield "|---|---|---|---|---|---|"
    for n, workers, wall, spent, memory in of.rows:
        rate, many = f"{n / spent:,.0f}".replace(",", " "), f"{n:.0e}".replace("e+0", "e")
        yield f"| {many} | {workers} | {wall:.1f} | {spent:.1f} | {rate} | {memory:.0f} |"
    nothing, file, disk = (f"{1e3 * s:.1f} ms" for s in (of.task, of.task_with_file, of.disk))
    each = of.task_with_file + of.disk
    yield (f"A task of Dask takes {nothing} with nothing in it and {file} with a file of 4 MB, and "
           f"writing such a file to this disk {disk}, one after the other. So a chunk of s seconds "
           f"keeps about s / {each:.3f} s cores at work, and more cores want longer chunks: give "
           f"`--chunk` as many members as take cores × {each:.3f} s.")  # fmt: skip
    yield from efficiencies(of.task_with_file, of.disk)


def efficiencies(task: float, disk: float) -> Iterator[str]:
    """Yield the table of expected efficiencies: the writer takes one chunk after the other."""
    yield "| seconds a chunk | " + " | ".join(f"{n} cores" for n in CORES) + " |"
    yield "|---" * (1 + len(CORES)) + "|"
    for seconds in SECONDS:
        own = (min(seconds / (seconds + task), seconds / (n * (task + disk))) for n in CORES)
        yield f"| {seconds:g} | " + " | ".join(f"{100 * min(x, 1):.0f} %" for x in own) + " |"


def main() -> None:
    """Print what the page says."""
    with TemporaryDirectory() as name:
        place, rows = Path(name), list[Row]()
        for members, workers in ((1, 1), (1, 1), (10**5, 1), (10**6, 1), (10**6, 2), (10**7, 2)):
            command = [sys.executable, "-m", "bench.sweep", f"{place / f'run{len(rows)}'}",
                       str(members), str(workers)]  # fmt: skip
            done = subprocess.run(command, capture_output=True, text=True, check=True,
                                  env=stored(place))  # fmt: skip
            wall, spent, memory = map(float, done.stdout.split())
            rows.append((members, workers, wall, spent, memory))
        taken = tuple(example_taken(place, *one) for one in examples())
        figures = SweepFigures(taken, rows[1][3], tuple(rows[2:]), of_cluster(1), of_cluster(FILE),
                               of_disk(place))  # fmt: skip
        print("\n".join(told(figures)))


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(*moved(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])))
    else:
        main()
