"""Verdicts on targets that a report's own figures contradict, a rule for each sentence."""

import math
import re
from collections.abc import Iterator
from typing import Any

from bench.report.read_back import Data, error_of, points_of

UNITS = {"f64": 2.0**-53, "f32": 2.0**-24}
WORDS = {"double": "f64", "float": "f32"}


def targets_contradicted(report: Data) -> Iterator[str]:
    """Yield every target whose verdict is not what the figures say."""
    for target in report["targets"]:
        verdict = _verdict(report, target["says"], target["limit"])
        if verdict is not target["reached"]:
            yield f"{target['says']}, {target['limit']}: reached is {target['reached']}: {verdict}"


def _verdict(report: Data, says: str, limit: str) -> bool | None:
    """Return whether the figures reach a target; None if one that it speaks of is not there."""
    for pattern, rule in RULES.items():
        read = re.search(pattern, says)
        if read:
            reached: bool | None = rule(report, read, limit)
            return reached
    raise LookupError(f"no rule judges the target '{says}'")


def _first(limit: str) -> float:
    return float(re.findall(r"\d[\d.e+-]*", limit)[0]) * (1e6 if " M " in limit else 1.0)


def _exact(report: Data, read: re.Match[str], limit: str) -> bool | None:
    precision = WORDS[read[1]]
    u, free = UNITS[precision], [c for c in report["cases"] if not c["torqued"]]
    points = [list(points_of(c, "flow_exact", precision).values()) for c in free]
    if not free or not all(points):
        return None
    flat = [(c, p) for c, each in zip(free, points, strict=True) for own in each for p in own]
    if read[2] == "instructions a call":
        counts = [p["instructions"] for _, p in flat]
        return None if None in counts else max(counts) <= _first(limit)
    times, least = (2.0, 16 * u) if precision == "f64" else (4.0, 0.0)
    kappas = [max(filter(None, c["kappa"].values()), default=0.0) for c, _ in flat]
    return all(error_of(p) <= max(times * k * u, least)
               for (_, p), k in zip(flat, kappas, strict=True))  # fmt: skip


def _hard(report: Data, read: re.Match[str], _: str) -> bool | None:
    asked = [WORDS[read[2]]] if read[2] else ["f64", "f32"]
    name = "rod with I3/I1 = 7e-9" if read[3].startswith("thin rod") else read[3]
    rows = [h for h in report["hard_cases"] if (h["ours"], h["name"]) == (read[1], name)]
    if not rows or not all(p in h["ours_found"] for h in rows for p in asked):
        return None
    return all(x is not None and x <= h["bound"][p]
               for h in rows for p in asked for x in h["ours_found"][p])  # fmt: skip


def _each_step(report: Data, read: re.Match[str], limit: str) -> bool | None:
    most = []
    for case in report["cases"]:
        for own in points_of(case, "step_dmv", WORDS[read[1]]).values():
            counted = [p for p in own if p["instructions"] is not None]
            if counted:
                near = min(counted, key=lambda p: abs(math.log(p["radians"] / 0.1)))
                most.append(near["instructions"] / near["passes"])
    return max(most) <= _first(limit) if most else None


def _cheapest(report: Data, case: str, method: str, error: float, by: str) -> float | None:
    """Return the cost of an error by straight lines between points, in the dearest scene."""
    points = [p for c in report["cases"] if c["name"] == case for p in c["points"]
              if (p["method"], p["precision"]) == (method, "f64") and p[by]]  # fmt: skip
    dearest = []
    for scene in {p["scene"] for p in points}:
        own = [p for p in points if p["scene"] == scene and 0 < error_of(p) < math.inf]
        own.sort(key=lambda p: p["value"])
        kept = next((n for n, p in enumerate(own) if error_of(p) > error), len(own))
        if not 0 < kept < len(own):
            return None
        fine, coarse = own[kept - 1], own[kept]
        x = [math.log(error_of(p)) for p in (fine, coarse)]
        y = [math.log(p[by]) for p in (fine, coarse)]
        dearest.append(math.exp(y[0] + (math.log(error) - x[0]) / (x[1] - x[0]) * (y[1] - y[0])))
    return max(dearest, default=None)


def _generic(report: Data, read: re.Match[str], limit: str) -> bool | None:
    ours = _cheapest(report, "asym_ii_generic", "step_dmv", 1e-12, "instructions")
    if read[1].startswith("the generic"):
        return None if ours is None else ours <= _first(limit)
    peer = _cheapest(report, "asym_ii_generic", "DOP853, C", 1e-12, "instructions")
    return None if ours is None or peer is None else peer / ours >= _first(limit)


def _faster(report: Data, read: re.Match[str], limit: str) -> bool | None:
    names = [read[1], f"{read[1]}_adaptive"]
    each = [_cheapest(report, read[2], m, float(read[3]), "seconds") for m in names]
    ours = min((c for c in each if c is not None), default=None)
    peer = _cheapest(report, read[2], "heyoka (Taylor)", float(read[3]), "seconds")
    return None if ours is None or peer is None else ours / peer <= _first(limit)


def _gyroscopic(report: Data, read: re.Match[str], _: str) -> bool | None:
    rows = [g for g in report["gyroscopic_term"]
            if (g["form"], g["precision"]) == (read[1], WORDS[read[2]])]  # fmt: skip
    if len(rows) < 13:
        return None
    return all(g["median"] is not None and g["largest"] is not None and g["median"] <= 1
               and g["largest"] <= 16 for g in rows)  # fmt: skip


def _tool(report: Data, read: re.Match[str], limit: str) -> bool | None:
    ours = next((e for e in report["step_and_jacobian"] if e["author"] == "ours"), None)
    if ours is None:
        return None
    operations = ours["flops"] and ours["flops"]["total"]
    found = operations if read[1] == "operations" else ours["instructions"].get("O3-native")
    return None if found is None else found <= _first(limit)


def _counted(report: Data, read: re.Match[str], limit: str) -> bool | None:
    scene = "thirteen" if "13 states" in read[0] else "compact"
    rows = [c["count"] for c in report.get("counts", ()) if c["scene"] == scene]
    if not rows or None in rows:
        return None
    most = _first(limit.split("'s ")[1]) / 2 if "half" in limit else _first(limit)
    return bool(max(rows) <= most)


def _falling(report: Data, read: re.Match[str], _: str) -> bool | None:
    known = {(c["scene"], c["function"]): c["count"] for c in report.get("counts", ())}
    each: list[Any] = [known.get((s, read[1])) for s in ("principal", "axisymmetric", "spherical")]
    return None if None in each else bool(each[0] > each[1] > each[2])


RULES = {
    r"^flow_exact, (double|float): (error on every|instructions a call)": _exact,
    r"^step_dmv, (double|float): instructions a step": _each_step,
    r"^step_dmv: (the generic case|below DOP853)": _generic,
    r"^(\w+): (\w+) to (\S+), same run": _faster,
    r"^gyroscopic term, form (\w+), (double|float)": _gyroscopic,
    r"7x7 Jacobian: (operations|-O3)": _tool,
    r"RK4 step of 13 states|^the same as loops": _counted,
    r"^(\w+): operations for a principal": _falling,
    r"^(flow_exact|step_dmv), (?:(double|float): )?(.+)$": _hard,
}
