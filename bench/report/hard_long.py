"""The hard case of a million steps: how energy and momentum drift, and where the attitude ends."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial

import numpy as np

from bench.motion.case import Case
from bench.motion.ours import parameters
from bench.motion.runner import Job, moved
from bench.motion.textbook import RK4
from bench.motion.wrong import ROUNDOFF, angle, invariants
from bench.report.case_run import PRECISIONS, Workshop
from bench.report.hard import Hard, by_precision, program
from derive.verify.measure import exact
from derive.verify.sample import Sample

COUNT, STEP, SEEN = 1_000_000, 0.01, 1000  # steps; s; how often on the way drift is looked at
CASE = "asym_ii_generic"
DRIFTS = ("energy", "|l|")
BOUNDS = {"energy": {"f64": 1e-14, "f32": 3e-6}, "|l|": {"f64": 5e-15, "f32": 1e-6}}
TARGET = "the target: rounding adds up like a random walk when it is carried along"
KAPPAS = 4.0
State = Sequence[float]


def row_name(count: int, what: str) -> str:
    """Return the name of a row of ``count`` steps."""
    return f"{count:.0e} steps of 0.01 s: {what}"


def bounds(case: Case, count: int) -> Mapping[str, Mapping[str, float]]:
    """Return what ``count`` steps of a case must keep to: energy, momentum, attitude."""
    turn = case.rate * STEP * count
    return BOUNDS | {"attitude": {p: KAPPAS * turn * ROUNDOFF[p] for p in PRECISIONS}}


def long_runs(every: Mapping[str, Case], shop: Workshop, count: int) -> Iterator[Hard]:
    """Yield the rows of ``count`` steps of 0.01 s: energy, momentum, attitude."""
    case = replace(every[CASE], time=Fraction(count, 100))
    bound = bounds(case, count)
    found = {m: by_precision(partial(_states, case, m, shop, count)) for m in (RK4, "step_dmv")}
    for place, what in enumerate(DRIFTS):
        naive, ours = (
            {p: (_drift(case, states, place),) for p, states in found[m].items()} for m in found
        )
        yield Hard(row_name(count, what), f"largest drift of {what}", RK4, naive, "step_dmv", ours,
                   bound[what], TARGET)  # fmt: skip
    naive, ours = (
        {p: (_turned_wrongly(case, p, states[-1], shop, count),) for p, states in found[m].items()}
        for m in found
    )
    yield Hard(row_name(count, "attitude"), "angle at the end", RK4, naive, "step_dmv", ours,
               bound["attitude"],
               "4 u times all the angle turned: the rate is known to u")  # fmt: skip


def _states(case: Case, method: str, shop: Workshop, count: int, precision: str) -> Sequence[State]:
    mover, given = program(case, method, shop, precision)
    job = Job(method, STEP, count, every=max(1, count // SEEN))
    (motion,) = moved(mover, case, given, [job])
    return motion.states if motion else ((math.nan,) * 7,)


def _drift(case: Case, states: Sequence[State], place: int) -> float:
    """Return the largest relative drift of energy (place 0) or |l| (place 1) in ``states``."""
    start = invariants(case, case.omega0)
    worst = 0.0
    for state in states:
        if not all(map(math.isfinite, state)):
            return math.nan
        now = invariants(case, [Fraction(x) for x in state[4:]])
        worst = max(worst, abs(float(now[place] / start[place] - 1)))
    return worst


def _turned_wrongly(case: Case, precision: str, state: State, shop: Workshop, count: int) -> float:
    """Return the angle in rad between an attitude and that of the exact flow, in long floats."""
    made = shop.emissions["principal"]
    step = np.float32(STEP) if precision == "f32" else STEP
    names = [q["name"] for q in made.manifest["parameters"]]
    values = dict(zip(names, parameters(made, case), strict=True))
    values |= {f"attitude_{part}": float(x) for part, x in zip("wxyz", case.q0, strict=True)}
    values |= {f"omega_{axis}": float(x) for axis, x in zip("xyz", case.omega0, strict=True)}
    values["time"] = float(step) * count
    true = exact(made.programs, made.programs["flow_exact"], Sample(0, "long run", values))[:4]
    if not all(map(math.isfinite, state)):
        return math.nan
    end = [Fraction(str(x.mid().str(60, radius=False))) for x in true]
    return angle([Fraction(x) for x in state[:4]], end)
