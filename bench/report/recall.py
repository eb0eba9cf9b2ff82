"""A report read back from ``report.json``: advice, targets and page follow from what it records."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from bench.flops import Flops
from bench.motion.case import cases
from bench.motion.step_jacobian import Entry
from bench.motion.wrong import Wrong
from bench.report.case_run import Found
from bench.report.counts import Count
from bench.report.functions import Function
from bench.report.gyroscopic import Gyroscopic
from bench.report.hard import Hard
from bench.report.orders import Order
from bench.report.point import NotRun, Point
from bench.report.proposals import Proposal
from bench.report.record import Report, text
from bench.report.targets import Evidence, targets

ERRORS = ("omega", "attitude", "energy", "momentum")


def recalled(report: Report) -> Report:
    """Return a report as its own JSON gives it, targets judged by these figures."""
    return with_targets(read(text(report)))


def with_targets(report: Report) -> Report:
    """Return a report with its targets judged anew."""
    evidence = Evidence({f.case.name: f for f in report.found}, report.hard, report.tools,
                        report.gyroscopic, report.counts)  # fmt: skip
    return replace(report, targets=tuple(targets(evidence)))


def read(written: str) -> Report:
    """Return the report of a ``report.json``, without targets; null is NaN.

    Raises LookupError or TypeError for a file of another version.
    """
    whole = json.loads(written)
    return Report(
        whole["kind"],
        tuple(_found(c) for c in whole["cases"] if c["name"] in cases()),
        tuple(_hard(h) for h in whole["hard_cases"]),
        tuple(Order(**_only(o, Order)) for o in whole["orders"]),
        tuple(_entry(e) for e in whole["step_and_jacobian"]),
        tuple(Gyroscopic(**_finite(g)) for g in whole["gyroscopic_term"]),
        tuple(Function(**f) for f in whole["functions"]),
        (),
        tuple(Count(**c) for c in whole.get("counts", ())),
        tuple(Proposal(**_finite(p)) for p in whole.get("proposals", ())),
        whole["machine"],
    )


def merged(old: Report, new: Report, only: Sequence[str]) -> Report:
    """Return a recorded report in which what was measured anew takes the place of what it was."""
    fresh = {f.case.name: f for f in new.found}
    kept = [fresh.pop(f.case.name, f) for f in old.found]
    parts = {"hard": "hard", "orders": "orders", "tools": "tools", "gyroscopic": "gyroscopic",
             "functions": "functions", "counts": "counts", "proposals": "proposals"}  # fmt: skip
    changed: dict[str, Any] = {f: getattr(new, f) for p, f in parts.items() if p in only}
    return replace(old, found=(*kept, *fresh.values()), **changed)


def _found(case: Mapping[str, Any]) -> Found:
    points = tuple(_point(p) for p in case["points"])
    return Found(cases()[case["name"]], points, tuple(NotRun(**n) for n in case["not_run"]))


def _point(given: Mapping[str, Any]) -> Point:
    error = Wrong(*(_number(given[name]) for name in ERRORS))
    own = {name: given[name] for name in given if name not in ERRORS}
    return Point(**own | {"value": _number(given["value"]), "wrong": error})


def _hard(given: Mapping[str, Any]) -> Hard:
    figures = {
        name: {p: tuple(map(_number, own)) for p, own in given[name].items()}
        for name in ("naive_found", "ours_found")
    }
    return Hard(**_only(given, Hard) | figures)


def _entry(given: Mapping[str, Any]) -> Entry:
    flops = given["flops"] and Flops(**{k: v for k, v in given["flops"].items() if k != "total"})
    return Entry(**_finite(given) | {"flops": flops, "instructions": given["instructions"]})


def _only(given: Mapping[str, Any], kind: Any) -> dict[str, Any]:
    return {k: v for k, v in _finite(given).items() if k in kind.__dataclass_fields__}


def _finite(given: Mapping[str, Any]) -> dict[str, Any]:
    return {k: _number(v) for k, v in given.items()}


def _number(value: Any) -> Any:
    return math.nan if value is None else value
