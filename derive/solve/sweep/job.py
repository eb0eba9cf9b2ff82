"""What a worker is told once, and what it makes of a chunk: a file of Parquet, as bytes."""

import io
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from derive.solve.sweep.course import Endings, endings
from derive.solve.sweep.design import Design
from derive.solve.sweep.keep import COURSE
from derive.solve.sweep.kit import Kit, ready
from derive.solve.sweep.plan import SweepPlan
from derive.solve.sweep.vary import FloatColumn

MEMBER, ENDED, ENDED_AT = "member", "ended", "ended_at"
OWN_COLUMNS = (MEMBER, ENDED, ENDED_AT)
METADATA = b"derive"
"""The key of a file's metadata under which the whole sweep is told, its seed among it."""


@dataclass(frozen=True)
class Job:
    """A sweep as workers need it.

    values : what is set, by component        told : the sweep as JSON, for the metadata of files
    """

    kit: Kit
    design: Design
    plan: SweepPlan
    values: Mapping[str, float]
    told: str


@dataclass(frozen=True)
class Chunk:
    """So many members from the first on, moved: their file, how they ended, by what, in which time.

    spent : s, of moving them and of writing the file
    """

    first: int
    file: bytes
    ended: Mapping[str, int]
    by: str
    spent: tuple[float, float]


def endings_of(job: Job, drawn: Mapping[str, FloatColumn], plan: SweepPlan) -> Endings:
    """Return what becomes of members, of what varies of each, by a plan."""
    count = len(next(iter(drawn.values())))
    return endings(ready(job.kit).functions, job.kit.library, plan, {**job.values, **drawn}, count)


def chunk_made(job: Job, first: int, count: int) -> Chunk:
    """Return a chunk."""
    import pyarrow as pa
    from pyarrow import parquet

    made, began = ready(job.kit), perf_counter()
    drawn = job.design.values(first, count)
    found = endings_of(job, drawn, job.plan)
    moved = perf_counter()
    columns = {MEMBER: pa.array(np.arange(first, first + count)),
               **{name: pa.array(x) for name, x in drawn.items()},
               ENDED: pa.array(found.ended.tolist(), pa.string()),
               ENDED_AT: pa.array(found.time)}  # fmt: skip
    for k in job.plan.kept:
        values = found.columns[k.column]
        if k.how == COURSE:
            flat = pa.array(values.reshape(-1))
            columns[k.column] = pa.FixedSizeListArray.from_arrays(flat, values.shape[1])
        else:
            columns[k.column] = pa.array(values)
    table = pa.table(columns).replace_schema_metadata({METADATA: job.told.encode()})
    out = io.BytesIO()
    parquet.write_table(table, out, compression="zstd", use_dictionary=[ENDED])
    spent = moved - began, perf_counter() - moved
    return Chunk(first, out.getvalue(), Counter(found.ended.tolist()), made.by, spent)


def same(job: Job) -> Job:
    """Return a job: as a task of a cluster, one that is done again where its worker is gone."""
    return job
