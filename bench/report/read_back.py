"""The points of ``report.json``, read as a reader reads them: nothing that made them is used."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

Data = Mapping[str, Any]
Points = Sequence[Data]


def error_of(point: Data) -> float:
    """Return the larger of a point's two errors, infinite where one is no number."""
    each = [math.inf if point[k] is None else float(point[k]) for k in ("omega", "attitude")]
    return max(each)


def points_of(case: Data, method: str, precision: str) -> dict[str, list[Data]]:
    """Return the points of a method in a case by scene; ours only."""
    found: dict[str, list[Data]] = {}
    for p in case["points"]:
        if p["scene"] and (p["method"], p["precision"]) == (method, precision):
            found.setdefault(p["scene"], []).append(p)
    return found
