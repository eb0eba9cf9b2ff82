"""Instructions of a package's motions: a Python of its own under callgrind, with marks around them.

``python -m bench.motion.peer_count PACKAGE MARKS`` is that Python: it reads jobs as JSON
from standard input, [case, setting] each, and makes every motion once before the one it marks.
"""

import ctypes
import json
import os
import sys
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path

from bench import callgrind
from bench.build import BuildError, run
from bench.motion.case import cases
from bench.motion.peers import PEERS, Peer

Asked = tuple[str, float]


def counted(peer: Peer, jobs: Sequence[Asked], folder: Path) -> dict[Asked, float]:
    """Return the instructions of one pass of a peer in each job.

    Raises FileNotFoundError without valgrind, BuildError if the run fails.
    """
    folder.mkdir(parents=True, exist_ok=True)
    marks = folder / "mark.so"
    source = folder / "mark.c"
    source.write_text((files("bench.motion") / "mark.c").read_text(encoding="utf-8"))
    run(("gcc", "-O1", "-fPIC", "-shared", str(source), "-o", str(marks)))
    command = (sys.executable, "-m", "bench.motion.peer_count", peer.package, str(marks))
    said, dumps = callgrind.counted(command, json.dumps(jobs).encode(), folder)
    passes = [int(line) for line in said.split()]
    if len(passes) != len(jobs):
        raise BuildError(f"{peer.name} answered {len(passes)} of {len(jobs)} jobs")
    found = zip(jobs, dumps[: len(jobs)], passes, strict=True)
    return {job: part.instructions / steps for job, part, steps in found if steps}


def marked(package: str, marks: ctypes.CDLL, jobs: Sequence[Asked]) -> list[int]:
    """Make each motion twice, the second one marked; return the passes of each."""
    (peer,) = (p for p in PEERS if p.package == package)
    passes = []
    for name, setting in jobs:
        motion = peer.prepare(cases()[name], setting)
        motion()
        marks.mark_begin()
        _, steps = motion()
        marks.mark_end()
        passes.append(steps)
    return passes


if __name__ == "__main__":
    os.environ["OMP_NUM_THREADS"] = "1"
    asked = [(str(name), float(setting)) for name, setting in json.load(sys.stdin)]
    print("\n".join(map(str, marked(sys.argv[1], ctypes.CDLL(sys.argv[2]), asked))))
