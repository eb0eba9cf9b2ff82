"""What a sweep costs: members a second a core, what engine and files take of it, memory.

``python -m bench.sweep`` prints the tables of docs/sweep.md, from one run. Times of moving are of
the processor, so that others on the machine disturb them little. Efficiencies of more cores than
there are here are computed from these figures, not measured.
"""

import resource
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import derive

HELD = {"r": 0.05, "l": 0.06, "g": 9.81, "n": 40, "beta": 0, "alpha_dot": 0, "beta_dot": 0}
VARY = {"alpha": "uniform(1deg, 3deg)", "m": "normal(0.5, 0.01)"}
UNTIL, STEP = 0.02, 1e-3
CHUNK = 1 << 17
CORES = (10, 100, 1000)
SECONDS = (1.0, 10.0, 100.0)
TASKS = 200
FILE = 1 << 22
"""Bytes that a task returns: a file of a chunk."""


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
        return (time.perf_counter() - began) / TASKS


def of_disk(folder: Path) -> float:
    """Return the seconds of writing a file of a chunk, forced to the disk."""
    from derive.solve.sweep.store import put_whole

    began = time.perf_counter()
    for k in range(20):
        put_whole(folder, f"part-{k:012d}.parquet", nothing(FILE, k))
    return (time.perf_counter() - began) / 20


def efficiencies(task: float, disk: float) -> Iterator[str]:
    """Yield the table of expected efficiencies: the writer takes one chunk after the other."""
    yield "| seconds a chunk | " + " | ".join(f"{n} cores" for n in CORES) + " |"
    yield "|---" * (1 + len(CORES)) + "|"
    for seconds in SECONDS:
        own = (min(seconds / (seconds + task), seconds / (n * (task + disk))) for n in CORES)
        yield f"| {seconds:g} | " + " | ".join(f"{100 * min(x, 1):.0f} %" for x in own) + " |"


def main() -> None:
    """Print the tables."""
    with TemporaryDirectory() as place:
        print("| members | processes | s | s of processors | members a second a core | MB |")
        print("|---|---|---|---|---|---|")
        for members, workers in ((10**5, 1), (10**6, 1), (10**6, 2), (10**7, 2)):
            command = [sys.executable, "-m", "bench.sweep", place, str(members), str(workers)]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
            wall, spent, memory = map(float, done.stdout.split())
            print(f"| {members:g} | {workers} | {wall:.1f} | {spent:.1f} | "
                  f"{members / spent:.3g} | {memory:.0f} |", flush=True)  # fmt: skip
        task, small, disk = of_cluster(FILE), of_cluster(1), of_disk(Path(place))
        print(f"\na task of Dask: {1e3 * small:.2f} ms, with {FILE} bytes {1e3 * task:.2f} ms;"
              f" a file of these: {1e3 * disk:.2f} ms\n")  # fmt: skip
        print("\n".join(efficiencies(task, disk)))


if __name__ == "__main__":
    if len(sys.argv) > 1:
        folder = Path(sys.argv[1]) / f"{sys.argv[2]}-{sys.argv[3]}"
        print(*moved(folder, int(sys.argv[2]), int(sys.argv[3])))
    else:
        main()
