"""A report as JSON: everything on its page as numbers, and the states that it was measured at."""

import json
from dataclasses import asdict
from math import isfinite
from typing import Any

from derive.emit.on_target import UNKNOWN, OnTarget
from derive.report.courses import StepErrors
from derive.report.price import LIBM_COSTS, PAIR_COSTS
from derive.report.sentence import MARGIN, said_of
from derive.report.whole import SceneReport


def report_json(found: SceneReport, on_target: OnTarget = UNKNOWN) -> str:
    """Return the text of ``<scene>_report.json``; ``on_target`` is what functions cost on cores."""
    scene = found.library.scene
    whole = {
        "scene": scene.name,
        "title": scene.title,
        "digest": found.digest,
        "best": found.best,
        "sentence": found.sentence,
        "motion": None if found.motion is None else _motion(found, found.motion),
        "functions": [asdict(f) for f in found.figures],
        "hard": [asdict(h) for h in found.hard],
        "nanoseconds": [asdict(t) for t in found.times],
        "instructions": [asdict(c) for c in found.instructions],
        "targets": [asdict(c) for c in on_target.each],
        "without": list(found.without),
        "counted_as": {"libm": LIBM_COSTS, "pairs": PAIR_COSTS},
        "machine": asdict(found.machine),
    }
    return json.dumps(_rounded(whole), indent=1, ensure_ascii=False) + "\n"


def _motion(report: SceneReport, found: StepErrors) -> dict[str, Any]:
    said = said_of(found)
    choices = {
        p: None if c is None else
        {
            "step": c.attempt.step,
            "length": c.attempt.length,
            "weighted_operations_per_second": c.operations,
        }
        for p, c in said.choices.items()
    }  # fmt: skip
    return {
        "time": found.time,
        "time_is": "given" if found.given else "of the scene",
        "rate": found.fast,
        "hardest": found.hard,
        "states": [{"values": found.start.values(k)} for k in range(len(found.start))],
        "tried": found.tried,
        "lost": found.lost,
        "aside": dict(found.aside),
        "operations_in_long_floats": found.work,
        "steps": [
            {
                "name": s,
                "wanted": s in report.wished.own,
                "weighted_operations": found.costs[s],
            }
            for s in report.wished.steps
        ],
        "refused": report.wished.refused,
        "said": {"error": said.target, "margin": MARGIN, "choices": choices},
        "floors": {p: list(each) for p, each in found.floors.items()},
        "attempts": [asdict(a) for a in found.attempts],
    }  # fmt: skip


def _rounded(value: Any) -> Any:
    """Return a record without digits of measured numbers that say nothing, nor infinities.

    What motions begin at, and lengths of step, stay as they are.
    """
    if isinstance(value, dict):
        kept = ("values", "time", "length")
        return {k: v if k in kept else _rounded(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(v) for v in value]
    if isinstance(value, float):
        return float(f"{value:.4g}") if isfinite(value) else None
    return value
