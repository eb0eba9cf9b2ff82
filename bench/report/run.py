"""A run of the report: programs are made, then cases are moved one by one, then the rest."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TypeVar

from bench.motion.case import Case, cases
from bench.motion.ours import SCENES, emission
from bench.motion.peers import PEERS
from bench.motion.step_jacobian import SCENE, entries
from bench.report.case_run import Workshop, case_run
from bench.report.counts import counts
from bench.report.functions import functions
from bench.report.gyroscopic import gyroscopic
from bench.report.hard import Hard, motions, scaled
from bench.report.hard_euler import near_lock
from bench.report.hard_formulas import formulas
from bench.report.hard_long import COUNT, long_runs
from bench.report.hard_moment import cancelling
from bench.report.hard_spin import spins
from bench.report.hard_top import tops
from bench.report.orders import orders
from bench.report.point import FULL, SMALL
from bench.report.proposals import proposals
from bench.report.record import Report, machine
from bench.report.targets import Evidence, Target, targets
from bench.report.workshop import workshop
from derive.scene import SceneError

LIMITS = {"small": SMALL, "full": FULL}
WORKERS = 3
CASES = "cases"
PARTS = ("hard", "orders", "tools", "gyroscopic", "functions", "counts", "proposals")
MOVED = ("hard", "orders", "proposals")  # parts for which programs must be made
Tell = Callable[[str], None]
T = TypeVar("T")


@dataclass(frozen=True)
class Ask:
    """What a run is to do.

    kind : "small" or "full"    generated : folder of the scenes whose functions are counted
    only : names of cases and of ``PARTS``, all if empty      tell : is told what is being done
    """

    kind: str
    generated: Path
    only: Sequence[str]
    tell: Tell


def made(ask: Ask) -> Report:
    """Run what is asked for and return the report. Raises SceneError for an unknown name."""
    every = cases()
    known = {CASES, *PARTS, *every}
    for name in ask.only:
        if name not in known:
            raise SceneError(f"--only needs one of {', '.join(sorted(known))}, not '{name}'")
    with TemporaryDirectory() as folder:
        return _made(ask, every, Path(folder))


def _made(ask: Ask, every: dict[str, Case], folder: Path) -> Report:
    ask.tell("emitting and compiling steppers; counting what peers, tools and functions take")
    with ThreadPoolExecutor(WORKERS) as pool:  # nothing here is timed
        peers = PEERS if _wanted(ask, CASES, *every) else ()
        scenes = SCENES if peers or _wanted(ask, *MOVED) else ()
        ready = pool.submit(workshop, scenes, peers, LIMITS[ask.kind], folder)
        counted = pool.submit(_part, ask, "functions", lambda: functions(ask.generated, folder))
        tools = pool.submit(_part, ask, "tools", lambda: entries(emission(SCENE), folder / "tools"))
        shop = ready.result()
        turning = _part(ask, "gyroscopic", lambda: gyroscopic(folder))
    found = []
    for case in every.values():
        if _wanted(ask, case.name, CASES):
            ask.tell(f"case {case.name}")
            found.append(case_run(case, shop))
    ask.tell("hard cases and orders")
    hard = _part(ask, "hard", lambda: _hard(every, shop))
    counted_once = _part(ask, "counts", lambda: counts(folder))
    evidence = Evidence(
        {f.case.name: f for f in found}, hard, tools.result(), turning, counted_once
    )
    return Report(
        ask.kind,
        tuple(found),
        hard,
        _part(ask, "orders", lambda: orders(every, shop)),
        tools.result(),
        turning,
        counted.result(),
        tuple(t for t in targets(evidence) if _shown(ask, t, every)),
        counted_once,
        _part(ask, "proposals", lambda: proposals(every, shop)),
        machine(),
    )


def _hard(every: dict[str, Case], shop: Workshop) -> Iterable[Hard]:
    yield from motions(every, shop)
    yield from scaled(every, shop)
    yield from spins(every["asym_ii_generic"], shop)
    yield from long_runs(every, shop, COUNT)
    yield from near_lock(shop)
    yield from formulas(shop.folder)
    yield from cancelling(shop.folder)
    yield from tops(shop.folder)


def _part(ask: Ask, name: str, make: Callable[[], Iterable[T]]) -> tuple[T, ...]:
    return tuple(make()) if _wanted(ask, name) else ()


def _shown(ask: Ask, target: Target, every: Mapping[str, Case]) -> bool:
    """Tell whether the part of a report that shows a target was asked for."""
    return _wanted(ask, target.only, *([CASES] if target.only in every else []))


def _wanted(ask: Ask, *names: str) -> bool:
    return not ask.only or any(name in ask.only for name in names)
