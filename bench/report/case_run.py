"""A case moved by everything there is: our steppers, textbook C, and packages."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from bench.build import BuildError
from bench.motion.case import Case
from bench.motion.glue import ADAPTIVE
from bench.motion.ours import Emission, parameters, scenes_for
from bench.motion.peers import PEERS, Peer, timed
from bench.motion.runner import Job, Motion, Mover, counted, moved
from bench.motion.textbook import DOP853, textbook
from bench.motion.textbook import parameters as textbook_parameters
from bench.motion.wrong import ROUNDOFF, wrong
from bench.report.point import Limits, NotRun, Point
from bench.report.settings import gained, steps, tolerances

PRECISIONS = ("f64", "f32")
COUNTED_STEPS = 24
MOTION = "flow_"
PATIENCE = 4  # times the longest motion of ours that a package may take
ORDINARY = 1e3  # a kappa above which a good stepper may still be better than kappa u
ANY = 0.0  # the setting of a pass that costs the same at every setting


@dataclass(frozen=True)
class Workshop:
    """What a case is run with, and how much a run may take.

    emissions : our scenes by name         movers : programs of theirs by (scene, precision), or
        why there is none                  folder : where the textbook's programs are built
    per_pass  : instructions of a peer's pass by (peer, setting or ANY)
    """

    emissions: Mapping[str, Emission]
    movers: Mapping[tuple[str, str], Mover | str]
    folder: Path
    limits: Limits
    per_pass: Mapping[tuple[str, float], float]


@dataclass(frozen=True)
class Found:
    """All motions of a case, and what was not run."""

    case: Case
    points: tuple[Point, ...]
    not_run: tuple[NotRun, ...]


@dataclass(frozen=True)
class Built:
    """A program for a case and precision."""

    mover: Mover
    case: Case
    given: tuple[float, ...]
    scene: str
    precision: str


def case_run(case: Case, shop: Workshop) -> Found:
    """Run every method on a case, in both precisions where it has both."""
    points: list[Point] = []
    made = [shop.emissions[scene] for scene in scenes_for(case) if scene in shop.emissions]
    missing = [NotRun(m, "", why) for one in made for m, why in one.without.items()]
    for precision in PRECISIONS:
        programs = [
            *(_ours(case, scene, precision, shop) for scene in scenes_for(case)),
            _textbook(case, precision, shop),
        ]
        for program in programs:
            if isinstance(program, NotRun):
                missing.append(program)
            else:
                found, lacking = _program(program, shop)
                points += found
                missing += lacking
    for peer in PEERS:
        try:
            points += _peer(case, peer, shop)
        except Exception as reason:
            missing.append(NotRun(peer.name, "f64", _sentence(reason)))
    return Found(case, tuple(points), tuple(missing))


def _ours(case: Case, scene: str, precision: str, shop: Workshop) -> Built | NotRun:
    mover = shop.movers.get((scene, precision), "the scene was not emitted")
    if isinstance(mover, str):
        return NotRun(f"all steppers of scene '{scene}'", precision, mover)
    given = tuple(parameters(shop.emissions[scene], case))
    return Built(mover, case, given, scene, precision)


def _textbook(case: Case, precision: str, shop: Workshop) -> Built | NotRun:
    folder = shop.folder / f"textbook_{case.name}_{precision}"
    try:
        mover = textbook(case, precision, folder)
    except (ImportError, BuildError) as reason:
        return NotRun("RK4 and DOP853 in C", precision, _sentence(reason))
    return Built(mover, case, tuple(textbook_parameters(case)), "", precision)


def _program(built: Built, shop: Workshop) -> tuple[list[Point], list[NotRun]]:
    points: list[Point] = []
    missing: list[NotRun] = []
    for method in built.mover.methods:
        found = list(_method(built, method, shop.limits))
        points += found
        if not found:
            name = method if built.scene else f"{method}"
            missing.append(NotRun(name, built.precision, "set-up refuses the body"))
    return _with_instructions(built, points), missing


def _method(built: Built, method: str, limits: Limits) -> Iterator[Point]:
    """Yield a method's points, coarse to fine, until nothing is gained or it takes too long."""
    found: list[Point] = []
    floor = least(built.case, built.precision)
    for job in _jobs(built, method, limits):
        (motion,) = moved(built.mover, built.case, built.given, [job])
        if motion is None:
            return
        found.append(_point(built, job, motion))
        yield found[-1]
        if not gained(found, floor) or motion.seconds * limits.ratio > limits.longest:
            return


def _jobs(built: Built, method: str, limits: Limits) -> Iterator[Job]:
    time, rounds = float(built.case.time), limits.rounds
    if method.startswith(MOTION):
        yield Job(method, time, 1, rounds=1000)
    elif adaptive(method):
        ratio = limits.ratio**3.3
        yield from (Job(method, e, 1, rounds=rounds) for e in tolerances(built.precision, ratio))
    else:
        counts = steps(built.case, limits)
        yield from (Job(method, time / n, n, rounds=rounds) for n in counts)


def attainable(case: Case, precision: str) -> float | None:
    """Return kappa u: what the rounding of the inputs makes of the end, None if unknown."""
    return None if case.kappa is None else case.kappa * ROUNDOFF[precision]


def least(case: Case, precision: str) -> float:
    """Return an error below which finer steps are of no interest."""
    return min(case.kappa or 0.0, ORDINARY) * ROUNDOFF[precision]


def adaptive(method: str) -> bool:
    """Tell whether a method of the C programs chooses its own steps."""
    return method == DOP853 or method.endswith(ADAPTIVE)


def _point(built: Built, job: Job, motion: Motion) -> Point:
    exact = job.method.startswith(MOTION)
    setting = "" if exact else "tolerance" if adaptive(job.method) else "step"
    turned = built.case.rate * float(built.case.time)
    return Point(
        job.method,
        built.scene,
        built.precision,
        setting,
        math.nan if exact else job.step,
        motion.passes,
        turned / max(motion.passes, 1),
        None,
        motion.seconds,
        wrong(built.case, motion.states[-1]),
    )


def _with_instructions(built: Built, points: Sequence[Point]) -> list[Point]:
    """Return points with their instructions: once a motion, and passes times those of a pass."""
    asked = {_count_key(p): _count_job(built.case, p) for p in points}
    try:
        counts = counted(built.mover, built.case, built.given, list(asked.values()))
    except (FileNotFoundError, BuildError):
        return list(points)
    known = dict(zip(asked, counts, strict=True))

    def instructions(p: Point) -> float:
        count = known[_count_key(p)]
        return count.start + count.going * p.passes / max(count.passes, 1)

    return [replace(p, instructions=instructions(p)) for p in points]


def _count_key(p: Point) -> tuple[str, float]:
    return (p.method, 0.0 if p.setting == "tolerance" else p.value if p.setting else 0.0)


def _count_job(case: Case, p: Point) -> Job:
    """Return the job whose passes are counted: some steps of this length, or a whole coarse run."""
    if p.setting == "tolerance":
        return Job(p.method, 1e-4, 1)
    return Job(p.method, p.value if p.setting else float(case.time), _few(p))


def _few(p: Point) -> int:
    return min(COUNTED_STEPS, p.passes)


def _peer(case: Case, peer: Peer, shop: Workshop) -> Iterator[Point]:
    found: list[Point] = []
    slow = shop.limits.longest * PATIENCE
    turned, time = case.rate * float(case.time), float(case.time)
    if peer.setting == "step":
        values = [time / n for n in steps(case, shop.limits)]
    else:
        values = tolerances("package", shop.limits.ratio**6.6)
    for value in values:
        done = timed(peer.prepare(case, value))
        each = shop.per_pass.get((peer.name, value), shop.per_pass.get((peer.name, ANY)))
        instructions = None if each is None else each * done.passes
        found.append(
            Point(peer.name, "", "f64", peer.setting, value, done.passes,
                  turned / max(done.passes, 1), instructions, done.seconds,
                  wrong(case, done.state))
        )  # fmt: skip
        if not gained(found, least(case, "f64")) or done.seconds > slow:
            break
    yield from found


def _sentence(reason: BaseException) -> str:
    text = " ".join(str(reason).split())
    return text[:200] if text else type(reason).__name__
