"""What every emitted function costs and how wrong it is, by the manifests in ``generated/``.

Operations and errors stand in the JSON of a scene; instructions are counted as in its own report.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from derive import load
from derive.check.callgrind import CallgrindError
from derive.emit.files import manifests
from derive.program.precision import PRECISIONS, Precision
from derive.report.driver import drivers
from derive.report.instructions import instructions
from derive.report.states import begun, fastest

TURN = 1 / 64
"""rad of a step."""


@dataclass(frozen=True)
class Function:
    """One emitted function.

    instructions : of a call, by precision     median, largest : errors in u, by precision; the
        largest over outputs
    """

    scene: str
    name: str
    flops: int
    divisions: int
    instructions: Mapping[str, float]
    median: Mapping[str, float]
    largest: Mapping[str, float]


def functions(generated: Path, folder: Path) -> list[Function]:
    """Return every function of every scene below ``generated``."""
    return [f for path in manifests(generated) for f in _scene(path, folder)]


def _scene(path: Path, folder: Path) -> list[Function]:
    manifest = json.loads(path.read_text(encoding="utf-8"))
    counts = {p.name: _counts(manifest["scene"], p, folder) for p in PRECISIONS}
    return [
        _function(manifest["scene"], f, {p: c[f["name"]] for p, c in counts.items() if c})
        for f in manifest["functions"]
        if _stands_for_itself(f)
    ]


def _stands_for_itself(function: Mapping[str, Any]) -> bool:
    return function["name"] != "setup" and "same_as" not in function


def _function(scene: str, f: Mapping[str, Any], counts: Mapping[str, float]) -> Function:
    errors = {p: list(f["error"][p].values()) for p in ("f32", "f64") if p in f["error"]}
    cost = f["cost"]
    return Function(
        scene,
        f["name"],
        cost["flops"],
        cost.get("div", 0),
        counts,
        {p: max(e["median_ulp"] for e in own) for p, own in errors.items()},
        {p: max(e["largest_ulp"] for e in own) for p, own in errors.items()},
    )


def _counts(name: str, precision: Precision, folder: Path) -> dict[str, float]:
    """Return the instructions of one call of each function, nothing without valgrind.

    They are those of the scene's own report, at states of its ranges.
    """
    library = load(name).library
    start = begun(library, "functions", 1)
    rate = fastest(library)
    place = folder / name
    place.mkdir(parents=True, exist_ok=True)
    (driver,) = drivers(library, (precision,), place)
    own = [p for p in library.printed() if p.name != "setup"]
    try:
        lengths = {program.name: TURN / max(rate, 1.0) for program in own}
        found = instructions(driver, "", own, start, lengths, place)
    except CallgrindError:
        return {}
    return {one.function: round(one.count, 1) for one in found}
