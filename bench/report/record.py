"""A report as data: everything a run found, and the same as JSON."""

import json
import math
import platform
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from bench.build import versions
from bench.motion.peers import PEERS
from bench.motion.step_jacobian import Entry
from bench.report.case_run import PRECISIONS, Found, attainable
from bench.report.counts import Count
from bench.report.functions import Function
from bench.report.gyroscopic import Gyroscopic
from bench.report.hard import Hard
from bench.report.orders import Order
from bench.report.point import Point
from bench.report.proposals import Proposal, proposal_says
from bench.report.recommend import ERRORS, advice, overall, says, sentence
from bench.report.targets import Target
from bench.show import as_data
from derive import __version__

RULES = {
    "error": "larger of the relative error of omega (norm) and the angle in rad between attitudes,"
    " at the end of the case, against 40 digits",
    "attainable": "kappa u: relative change of the end for relative changes of the inputs, times"
    " the unit roundoff (2^-53 double, 2^-24 float)",
    "instructions": "callgrind, gcc -O2: what is done once a motion, plus passes times the mean of"
    " a pass over the first 24 steps of that length (adaptive: over a whole run); packages: mean"
    " pass of a whole run of one case times passes; set-up of a body is not counted",
    "time": "fastest of several runs of the whole motion, without set-up or compilation",
}
FLAT = re.compile(r"\{[^{}\[\]]*\}")  # what holds only numbers and words goes on one line
PACKAGES = ("numpy", *(peer.package for peer in PEERS), "symforce", "sympy")


@dataclass(frozen=True)
class Report:
    """What a run found.

    kind : "small" or "full"; the sections follow in the order of the page
    """

    kind: str
    found: tuple[Found, ...]
    hard: tuple[Hard, ...]
    orders: tuple[Order, ...]
    tools: tuple[Entry, ...]
    gyroscopic: tuple[Gyroscopic, ...]
    functions: tuple[Function, ...]
    targets: tuple[Target, ...]
    counts: tuple[Count, ...] = ()
    proposals: tuple[Proposal, ...] = ()
    machine: Mapping[str, str | None] = field(default_factory=dict)


def data(report: Report) -> dict[str, Any]:
    """Return a report as plain values; what is not finite is null."""
    whole = {
        "generator": f"derive {__version__}",
        "kind": report.kind,
        "machine": dict(report.machine),
        "rules": RULES,
        "targets": [asdict(t) for t in report.targets],
        "recommendations": recommendations(report.found),
        "cases": [_case(f) for f in report.found],
        "hard_cases": [_hard(h) for h in report.hard],
        "orders": [asdict(o) | {"agrees": o.agrees} for o in report.orders],
        "step_and_jacobian": [as_data(e) for e in report.tools],
        "gyroscopic_term": [asdict(g) for g in report.gyroscopic],
        "functions": [asdict(f) for f in report.functions],
        "counts": [asdict(c) for c in report.counts],
        "proposals": [asdict(p) | {"error": _rounded(p.error)} for p in report.proposals],
        "proposals_say": proposal_says(report.proposals),
    }
    plain: dict[str, Any] = _plain(whole)
    return plain


def text(report: Report) -> str:
    """Return ``report.json``."""
    written = json.dumps(data(report), indent=1, ensure_ascii=False, allow_nan=False)
    return FLAT.sub(lambda found: re.sub(r"\s*\n\s*", " ", found.group()), written) + "\n"


def kinds(found: Sequence[Found]) -> dict[str, dict[str, list[Point]]]:
    """Return the points of each case by the kinds of motion that advice is given for."""
    free = [f for f in found if not f.case.torqued]
    at_once = {f.case.name: [p for p in f.points if not p.setting] for f in free}
    by_steps = {f.case.name: [p for p in f.points if p.setting] for f in free}
    every = {
        "without torque, at any time at once": at_once,
        "without torque, step by step": by_steps,
        "with torque": {f.case.name: list(f.points) for f in found if f.case.torqued},
    }
    return {kind: own for kind, own in every.items() if own}


def recommendations(found: Sequence[Found]) -> dict[str, Any]:
    """Return advice for every error, overall and for each case."""
    return {
        "overall": [
            asdict(row) | {"says": says(row)}
            for kind, own in kinds(found).items()
            for precision in PRECISIONS
            for error in ERRORS[precision]
            for row in overall(kind, own, precision, error)
        ],
        "by_case": [
            {"case": f.case.name, "precision": precision, "error": error,
             "says": sentence(one), "method": one.point and one.point.method,
             "value": one.point and one.point.value}
            for f in found
            for precision in PRECISIONS
            for error in ERRORS[precision]
            for one in [advice(f.case.name, f.points, precision, error)]
        ],
    }  # fmt: skip


def best(found: Found, method: str, precision: str) -> float | None:
    """Return the least error of a method on a case, None if it has no finite one."""
    errors = [p.wrong.state for p in found.points if (p.method, p.precision) == (method, precision)]
    return min((e for e in errors if math.isfinite(e)), default=None)


def _case(found: Found) -> dict[str, Any]:
    case = found.case
    return {
        "name": case.name,
        "says": case.says,
        "kind": case.kind,
        "torqued": case.torqued,
        "time": float(case.time),
        "rate": case.rate,
        "kappa": {"omega": case.kappa_omega, "attitude": case.kappa_attitude},
        "attainable": {p: attainable(case, p) for p in PRECISIONS},
        "points": [_point(p) for p in found.points],
        "not_run": [asdict(n) for n in found.not_run],
        "command": f"python -m bench.report --only {case.name}",
    }


def _point(point: Point) -> dict[str, Any]:
    return {k: _rounded(v) for k, v in asdict(point).items() if k != "wrong"} | {
        k: _rounded(v) for k, v in asdict(point.wrong).items()
    }


def _rounded(x: Any) -> Any:
    """Return a number to five digits: more would only make the file long."""
    return float(f"{x:.5g}") if isinstance(x, float) and math.isfinite(x) else x


def _hard(row: Hard) -> dict[str, Any]:
    verdicts = {
        "naive_holds": {p: row.naive_holds(p) for p in row.naive_found},
        "holds": {p: row.holds(p) for p in row.ours_found},
    }
    return asdict(row) | verdicts | {"command": "python -m bench.report --only hard"}


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def machine() -> dict[str, str | None]:
    """Return what a run is made with, by name; None for what is not there."""
    packages = {name: _installed(name) for name in PACKAGES}
    return {"processor": platform.machine(), **versions(), **packages}


def _installed(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None
