"""A sweep on a cluster: a real scheduler, and workers that die, come late or are slow."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest

import derive
from derive.solve.sweep.store import parts_of
from tests.solve.sweep.swept_tops import swept_top
from tests.solve.sweep.test_sweep import same

pytestmark = pytest.mark.long
SLEPT = 3.0
"""s that a slow worker does nothing."""


@dataclass
class Cluster:
    """A scheduler and its workers, processes of this machine."""

    file: Path
    processes: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def start(self, kind: str, *more: str, **also: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", f"distributed.cli.dask_{kind}", "--no-dashboard"]
        own = subprocess.Popen(
            [*command, "--scheduler-file", str(self.file), *more],
            cwd=self.file.parent, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env=os.environ | also,
        )  # fmt: skip
        self.processes.append(own)
        return own

    def worker(self, **also: str) -> subprocess.Popen[bytes]:
        own = ("--no-nanny", "--nthreads", "1", "--host", "127.0.0.1")
        return self.start("worker", *own, **also)

    def worker_without_compiler(self, and_does: str = "") -> subprocess.Popen[bytes]:
        """Start a worker with nothing on its PATH, to which no wheel brings a compiler either."""
        place = self.file.parent / "bare"
        place.mkdir()
        text = f"import sys\nsys.modules['ziglang'] = None\n{and_does}"
        (place / "sitecustomize.py").write_text(text)
        return self.worker(PATH=str(place), CC="", PYTHONPATH=str(place))

    @property
    def address(self) -> str:
        while not self.file.is_file():
            time.sleep(0.05)
        time.sleep(0.2)
        found: str = json.loads(self.file.read_text())["address"]
        return found


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    own = Cluster(tmp_path / "scheduler.json")
    own.start("scheduler", "--host", "127.0.0.1", "--port", "0")
    yield own
    for process in own.processes:
        process.send_signal(signal.SIGCONT)
        process.kill()
        process.wait()


def files(of: derive.Ensemble) -> dict[str, bytes]:
    return {p.name: p.read_bytes() for p in parts_of(of.folder).values()}


def test_workers_that_die_or_come_late_or_are_slow_change_no_bit(
    cluster: Cluster, tmp_path: Path
) -> None:
    undisturbed = swept_top(tmp_path / "here", samples=2000, chunk=50)
    first, second = cluster.worker(), cluster.worker()
    seen: list[int] = []

    def disturb(says: str, count: int, _of: int) -> None:
        seen.append(count)
        if says == "moving" and len(seen) == 8:
            first.kill()
            cluster.worker()
        if says == "moving" and len(seen) == 20:
            second.send_signal(signal.SIGSTOP)
            time.sleep(SLEPT)
            second.send_signal(signal.SIGCONT)

    found = swept_top(
        tmp_path / "there", samples=2000, chunk=50, scheduler=cluster.address, told=disturb
    )
    assert first.poll() is not None
    assert files(found) == files(undisturbed)
    assert seen == sorted(seen)
    assert found.doubts == undisturbed.doubts


def test_a_full_disk_ends_a_sweep_of_a_cluster_that_then_goes_on(
    cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(file: int) -> None:
        if len(parts_of(tmp_path / "there")) == 3:
            raise OSError(28, "No space left on device")

    cluster.worker()
    with monkeypatch.context() as patch:
        patch.setattr("derive.solve.sweep.store.os.fsync", full)
        with pytest.raises(derive.DeriveError, match="No space left on device"):
            swept_top(tmp_path / "there", scheduler=cluster.address)
    assert len(parts_of(tmp_path / "there")) == 3
    found = swept_top(tmp_path / "there", scheduler=cluster.address)
    assert files(found) == files(swept_top(tmp_path / "here"))


def test_a_worker_without_compiler_gives_the_same_bits_and_says_so(
    cluster: Cluster, tmp_path: Path
) -> None:
    undisturbed = swept_top(tmp_path / "here")
    says = "chunks were moved by CasADi: where they were is no compiler"
    cluster.worker_without_compiler()
    alone = swept_top(tmp_path / "alone", scheduler=cluster.address)
    assert alone.doubts == (*undisturbed.doubts, f"6 {says}")
    assert files(alone) == files(undisturbed)
    cluster.worker()
    seen: list[int] = []

    def second_is_there(says: str, count: int, _of: int) -> None:
        seen.append(count)
        time.sleep(SLEPT if len(seen) == 2 else 0)

    both = swept_top(tmp_path / "both", chunk=20, scheduler=cluster.address, told=second_is_there)
    (told,) = (d for d in both.doubts if says in d)
    assert 0 < int(told.split()[0]) < 30
    assert same(both, undisturbed)


OTHER_BITS = """
from derive.solve.sweep import kit

called = kit.ByCasadi.call

def longer(*given):
    made = called(*given)
    return lambda length: made(length * (1 + 2.0**-40))

kit.ByCasadi.call = longer
"""


def test_a_worker_that_has_other_bits_is_seen(cluster: Cluster, tmp_path: Path) -> None:
    undisturbed = swept_top(tmp_path / "here")
    cluster.worker_without_compiler(OTHER_BITS)
    assert files(swept_top(tmp_path / "there", scheduler=cluster.address)) != files(undisturbed)


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "127.0.0.1", "carrier://pigeon:8786"])
def test_a_scheduler_that_is_not_there_is_told_in_a_sentence(address: str, tmp_path: Path) -> None:
    with pytest.raises(derive.DeriveError, match="no scheduler of Dask answers at"):
        swept_top(tmp_path / "runs", scheduler=address)
