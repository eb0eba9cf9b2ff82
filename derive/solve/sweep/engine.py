"""Chunks moved at once: by processes of this machine, or by the workers of a cluster of Dask."""

import os
import pickle
import signal
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from functools import lru_cache
from multiprocessing import parent_process
from threading import Thread
from typing import Any

from derive.scene import SceneError
from derive.solve.sweep.job import Chunk, Job, chunk_made, same

AHEAD = 2
"""Chunks a worker that are given out before others are back: none waits, and memory is flat."""
PATIENCE = 10.0
"""s, until a scheduler must have answered."""
ChunkSpan = tuple[int, int]
"""The first member of a chunk, and how many."""


def _own_chunk(packed: bytes, first: int, count: int) -> Chunk:
    return chunk_made(_unpacked(packed), first, count)


@lru_cache(1)
def _unpacked(packed: bytes) -> Job:
    job: Job = pickle.loads(packed)  # noqa: S301 - what this process was started with
    return job


def _ends_with_its_parent() -> None:
    """Have this process end as soon as the one that started it does, by whatever.

    A key that is to stop that one is not for this one, which is told by it.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=_outlived, daemon=True).start()


def _outlived() -> None:
    if (parent := parent_process()) is not None:
        parent.join()
    os._exit(1)


def on_processes(
    job: Job, spans: Sequence[ChunkSpan], workers: int
) -> Generator[Chunk, None, None]:
    """Yield chunks as they are done, by so many processes of this machine."""
    if workers == 1 or len(spans) <= 1:
        for span in spans:
            yield chunk_made(job, *span)
        return
    packed, most = pickle.dumps(job), AHEAD * workers
    with ProcessPoolExecutor(workers, initializer=_ends_with_its_parent) as pool:
        try:
            yield from _in_turn(lambda span: pool.submit(_own_chunk, packed, *span), spans, most)
        except BrokenProcessPool:
            says = "a process that moved members was killed; the same sweep goes on where it was"
            raise SceneError(says) from None
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _in_turn(
    submit: Callable[[ChunkSpan], "Future[Chunk]"], spans: Sequence[ChunkSpan], most: int
) -> Iterator[Chunk]:
    left, running = iter(spans), set[Future[Chunk]]()
    while True:
        for span in left:
            running.add(submit(span))
            if len(running) >= most:
                break
        if not running:
            return
        done, running = wait(running, return_when=FIRST_COMPLETED)
        for one in done:
            yield one.result()


def on_cluster(
    job: Job, spans: Sequence[ChunkSpan], scheduler: str
) -> Generator[Chunk, None, None]:
    """Yield chunks as they are done by the workers of a scheduler, which sees to those that fail.

    Raises SceneError if there is no scheduler, or if chunks end their workers again and again.
    """
    import distributed
    from distributed.comm import get_address_host_port

    try:
        get_address_host_port(scheduler)
        client = distributed.Client(scheduler, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        says = f"no scheduler of Dask answers at '{scheduler[:100]}'"
        raise SceneError(f"{says}: {str(error)[:100]}") from None
    with client:
        own = client.submit(same, job, pure=False)
        left, running = iter(spans), distributed.as_completed(loop=client.loop)
        for span in _some(left, _room(client)):
            running.add(client.submit(chunk_made, own, *span, pure=False))
        try:
            for one in running:
                yield one.result()
                for span in _some(left, _room(client) - running.count()):
                    running.add(client.submit(chunk_made, own, *span, pure=False))
        except distributed.KilledWorker as error:
            raise SceneError(f"the cluster gave up: {str(error)[:200]}") from None
        finally:
            with suppress(Exception):  # of what is not done yet nobody needs anything
                client.cancel([own])


def _some(left: Iterator[ChunkSpan], count: int) -> Iterator[ChunkSpan]:
    for _ in range(max(count, 0)):
        span = next(left, None)
        if span is None:
            return
        yield span


def _room(client: Any) -> int:
    """Return how many chunks may be out, of workers that may come and go."""
    threads: dict[str, int] = client.nthreads()
    return AHEAD * max(1, sum(threads.values()))
