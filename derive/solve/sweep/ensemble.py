"""A sweep from its request to its folder: planned once, chunk by chunk, going on where it was."""

import json
import os
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from derive.library.digest import digest_of_programs
from derive.library.library import Library
from derive.scene import SceneError
from derive.solve.event import answers_along, event
from derive.solve.instrument import Instrument
from derive.solve.simulation import LONGEST_MOTION
from derive.solve.sweep.closing import closing_of, require_middle_near
from derive.solve.sweep.course import ASTRAY, REFUSED
from derive.solve.sweep.design import Design
from derive.solve.sweep.engine import ChunkSpan, on_cluster, on_processes
from derive.solve.sweep.job import Job
from derive.solve.sweep.keep import kept_columns
from derive.solve.sweep.kit import kit_of
from derive.solve.sweep.plan import SweepPlan
from derive.solve.sweep.recommended import as_asked, verified
from derive.solve.sweep.request import (
    ERROR,
    FARTHEST_START,
    MOST_INSTANTS,
    MOST_WORKERS,
    Request,
    above_zero,
    design_of,
    outside_at_start,
    require_installed,
    require_motion,
    resting,
    scheduler_of,
    stop_of,
    whole_number,
)
from derive.solve.sweep.store import (
    MANIFEST,
    manifest_of,
    only_sweep_in,
    part_name,
    parts_of,
    put_whole,
    require_same,
)

NEEDED = ("scipy", "pyarrow")
RULES = 2
"""By which members move: another number where their bits are others."""
SECONDS = 1.0
"""That a chunk is to take: what an engine adds to it, some milliseconds, is then no matter."""
FEWEST, MOST = 2048, 1 << 18
"""Members of a chunk: a block, and what fits into memory many times."""
BYTES = 1 << 26
"""Of a chunk's numbers, at most."""
ToldOfSweep = Callable[[str, int, int], None]
"""Hears what is being done, how many members are done, and how many there are."""


def unheard(_says: str, _done: int, _of: int) -> None:
    """Hear how far a sweep is, and say nothing."""


@dataclass(frozen=True)
class Ensemble:
    """A sweep that is done: where it lies, how its members ended, what is said of it.

    ended : "until", "stop", "not finite", "refused: ..." and how many members each
    halved : by column, the most that half the step changes in members that were tried
    """

    folder: Path
    page: Path
    members: int
    plain: int
    ended: Mapping[str, int]
    says: str
    halved: Mapping[str, float]
    doubts: tuple[str, ...]

    @property
    def unfinished(self) -> int:
        """Return how many members have no end: refused, or no numbers any more."""
        return sum(n for how, n in self.ended.items() if how == ASTRAY or how.startswith(REFUSED))

    def column(self, name: str) -> Any:
        """Return a column of all members in order, as an array; a course as (members, instants).

        Raises SceneError if there is none of that name.
        """
        from pyarrow import parquet

        each = [p for _, p in sorted(parts_of(self.folder).items())]
        if name not in (names := parquet.read_schema(each[0]).names):
            raise SceneError(f"the sweep has no column {name!r} (known: {', '.join(names)})")
        tables = [parquet.read_table(p, columns=[name])[name].combine_chunks() for p in each]
        return np.concatenate([
            t.to_numpy(zero_copy_only=False) if not hasattr(t, "flatten") or t.type.num_fields == 0
            else t.flatten().to_numpy().reshape(len(t), -1) for t in tables
        ])  # fmt: skip


def swept(
    found: Instrument, values: Mapping[str, float], asked: Request, folder: Path, tell: ToldOfSweep
) -> Ensemble:
    """Return a sweep that is done, from where its folder stood.

    Raises SceneError for what makes no sense, and OutputError where the folder takes no more.
    """
    label = f"scene '{found.name}'"
    scheduler = scheduler_of(asked.scheduler)
    require_installed((*NEEDED, *(() if scheduler is None else ("distributed",))))
    design = design_of(found, asked, values)
    until = above_zero(label, "until", asked.until)
    instants = whole_number(f"{label}: instants", asked.instants, MOST_INSTANTS, least=1)
    known = {**values, **{s.name: s.within[0] for s in design.spreads}}
    rest = resting(found, known)
    values, known = {**values, **rest}, {**known, **rest}
    require_motion(found, known)
    error = ERROR if asked.error is None else above_zero(label, "error", asked.error)
    step = None if asked.step is None else above_zero(label, "step", asked.step)
    near = FARTHEST_START if asked.near is None else above_zero(label, "near", asked.near)
    closing = closing_of(found.library, [s.name for s in design.spreads])
    require_middle_near(found, design.spreads, values)
    begun = [f"{name}@0" for name in closing.moved]
    columns = kept_columns(found, known, asked.keep, until, begun)
    stop = None if asked.stop is None else event(found, known, asked.stop)
    workers = min(os.cpu_count() or 1, 64) if asked.workers is None else whole_number(
        f"{label}: workers", asked.workers, MOST_WORKERS, least=1)  # fmt: skip
    size = asked.chunk
    if size is not None:
        size = whole_number(f"{label}: chunk", size, MOST, least=1)
    sought = error if step is None else None
    request = {
        "scene": found.name,
        "rules": RULES,
        "programs": digest_of_programs(found.library),
        "vary": {s.name: [s.kind, *s.ends, s.count] for s in design.spreads},
        "set": dict(sorted(values.items())),
        "samples": design.samples,
        "pairs": design.pairs,
        "seed": design.seed,
        "until": until,
        "instants": instants,
        "keep": [k.column for k in columns],
        "stop": stop_of(asked.stop),
        "step": step,
        "error": sought,
        "near": near,
    }
    onto = tuple(p.name for p in closing.programs)
    answers = answers_along(found, known)
    plan = SweepPlan(
        "step_rk4",
        step or until,
        until,
        instants,
        columns,
        stop,
        answers,
        closing.turned,
        onto,
        near,
    )
    if plan.steps > LONGEST_MOTION:
        rule = f"a member moves by at most {LONGEST_MOTION:,} steps"
        raise SceneError(f"{label}: {rule}; {until:g} s at {plan.length:g} s are {plan.steps:,}")
    library = replace(found.library, motions=(*found.library.motions, *closing.programs))
    with only_sweep_in(folder):
        manifest = manifest_of(folder)
        if manifest is not None:
            require_same(folder, manifest["asked"], request)
        else:
            manifest = _planned(library, design, plan, values, request, sought, size,
                                closing.moved, tell)  # fmt: skip
            put_whole(folder, MANIFEST, json.dumps(manifest, indent=1, sort_keys=True).encode())
        plan = replace(plan, step=manifest["step"], length=manifest["length"])
        told = {name: x for name, x in manifest.items() if name not in ("halved", "chunk")}
        kit = kit_of(library, plan.functions)
        job = Job(kit, design, plan, dict(values), json.dumps(told, sort_keys=True))
        by = _chunks_done(job, folder, manifest["chunk"], workers, scheduler, tell)
    doubts = [f"{name} is not told: members begin at rest in it" for name in rest]
    doubts += [*closing.doubts, *outside_at_start(found, design.spreads, values)]
    if "CasADi" in by:
        doubts.append(f"{by['CasADi']} chunks were moved by CasADi: where they were is no compiler")
    page = page_beside(folder)
    return Ensemble(folder, page, design.members, design.plain, _ended(folder), manifest["says"],
                    manifest["halved"], tuple(doubts))  # fmt: skip


def page_beside(folder: Path) -> Path:
    """Return where the page of a folder lies: beside it, and never where it lies itself.

    >>> [page_beside(Path(text)).name for text in ("runs.parquet", "runs", "runs.html")]
    ['runs.html', 'runs.html', 'runs.html.html']
    """
    named = folder if folder.name not in ("", "..") else folder.resolve()
    if named.suffix == ".html":
        return named.with_name(f"{named.name}.html")
    return named.with_suffix(".html")


def _planned(
    library: Library, design: Design, plan: SweepPlan, values: Mapping[str, float],
    request: Mapping[str, Any], error: float | None, size: int | None, moved: Sequence[str],
    tell: ToldOfSweep,
) -> dict[str, Any]:  # fmt: skip
    """Return what a folder tells of its sweep: what was asked for, and what was found for it.

    error : that a step is sought for, None for that of the plan
    """
    tell("trying half the step", 0, design.members)
    job = Job(kit_of(library, plan.functions), design, plan, values, "")
    of = as_asked(job) if error is None else verified(
        library, job, error, lambda says: tell(says, 0, design.members))  # fmt: skip
    plan, width = of.plan, 8 * (4 + sum(len(plan.instants) for _ in plan.kept))
    if size is None:
        size = chunk_size(of.spent, width)
    return {
        "asked": request, "step": plan.step, "length": plan.length, "steps": plan.steps,
        "says": of.says, "halved": of.halved, "chunk": size, "members": design.members,
        "plain": design.plain, "title": library.scene.title,
        "units": {k.column: k.unit for k in plan.kept}, "moved": moved,
    }  # fmt: skip


def chunk_size(seconds: float, width: int) -> int:
    """Return how many members make a chunk, a power of two.

    seconds : of a core, for a member        width : bytes of a member in memory

    >>> chunk_size(1e-5, 100), chunk_size(1.0, 100), chunk_size(1e-9, 100)
    (65536, 2048, 262144)
    """
    most = min(MOST, SECONDS / max(seconds, 1e-12), BYTES / width)
    return max(FEWEST, 1 << max(0, int(np.log2(max(most, 1.0)))))


def _chunks_done(
    job: Job, folder: Path, size: int, workers: int, scheduler: str | None, tell: ToldOfSweep
) -> Counter[str]:
    """Move all members that are not done yet; return by what how many chunks were moved."""
    members = job.design.members
    spans = [*_spans(members, size)]
    done = {*parts_of(folder)}
    left = [span for span in spans if span[0] not in done]
    count = sum(n for first, n in spans if first in done)
    tell("moving", count, members)
    by: Counter[str] = Counter()
    sizes = dict(spans)
    chunks = on_processes(job, left, workers)
    if scheduler is not None:
        chunks = on_cluster(job, left, scheduler)
    with closing(chunks):
        for chunk in chunks:
            put_whole(folder, part_name(chunk.first), chunk.file)
            by[chunk.by] += 1
            count += sizes[chunk.first]
            tell("moving", count, members)
    return by


def _spans(members: int, size: int) -> Iterator[ChunkSpan]:
    for first in range(0, members, size):
        yield first, min(size, members - first)


def _ended(folder: Path) -> dict[str, int]:
    """Return how members ended, from the files: those of runs before among them."""
    from pyarrow import parquet

    found: Counter[str] = Counter()
    for _, part in sorted(parts_of(folder).items()):
        counts = parquet.read_table(part, columns=["ended"])["ended"].value_counts()
        found.update({str(c["values"]): int(c["counts"].as_py()) for c in counts})
    return dict(sorted(found.items()))
