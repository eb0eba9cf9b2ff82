"""Sentences of a report that its own figures contradict, found from ``report.json`` alone.

Nothing of what made the advice and the verdicts is used: every sentence is read as a reader reads
it, and held against the worst of all cases, scenes and settings that it speaks of.
"""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from statistics import median
from typing import Any

Data = Mapping[str, Any]
Points = Sequence[Data]
ADVICE = re.compile(
    r"(?P<method>\w+)(?: with steps of (?:\S+ s \()?(?P<step>\S+) rad\)?| to (?P<tolerance>[^:;]+)"
    r"|: one call)?"
)
REACH = re.compile(r": (?:every case|(\d+) of (\d+) cases, not (?:(\d+) others|([^;]+)))")
PRICE = re.compile(r"; (\S+) times the least cost")
PRINTED = 1.0011  # a printed setting has four digits and is cut: the true one is so much larger
ROUGHLY = 0.011  # a figure of three digits, or of two and more, printed
UNITS = {"f64": 2.0**-53, "f32": 2.0**-24}
WORDS = {"double": "f64", "float": "f32"}


def contradictions(report: Data) -> list[str]:
    """Return every sentence of advice and every verdict that the report's figures contradict."""
    return [*_overall(report), *_by_case(report), *_targets(report), *_proposals(report)]


def _error(point: Data) -> float:
    each = [math.inf if point[k] is None else float(point[k]) for k in ("omega", "attitude")]
    return max(each)


def _price(point: Data) -> float:
    return float(point["instructions"] or point["seconds"] * 1e9)


def _of(case: Data, method: str, precision: str) -> dict[str, list[Data]]:
    """Return the points of a method in a case by scene; ours only."""
    found: dict[str, list[Data]] = {}
    for p in case["points"]:
        if p["scene"] and (p["method"], p["precision"]) == (method, precision):
            found.setdefault(p["scene"], []).append(p)
    return found


def _as_fine(points: Points, step: str | None, tolerance: str | None) -> list[Data]:
    """Return the points with a setting at most as large as the one that is named."""
    if step:
        return [p for p in points if p["radians"] <= float(step) * PRINTED]
    if tolerance:
        return [p for p in points if p["value"] <= float(tolerance) * PRINTED]
    return list(points)


def _kept(case: Data, read: re.Match[str], precision: str, error: float) -> bool:
    """Tell whether a method keeps to an error in every scene, with the setting and all finer."""
    scenes = _of(case, read["method"], precision)
    fine = [_as_fine(own, read["step"], read["tolerance"]) for own in scenes.values()]
    named = float(read["step"] or read["tolerance"] or 0)
    reached = all(_coarsest(own, error) * PRINTED >= named for own in scenes.values())
    kept = all(own and all(_error(p) <= error for p in own) for own in fine)
    return bool(fine) and reached and kept


def _coarsest(points: Points, error: float) -> float:
    """Return the coarsest setting up to which all points keep to an error."""
    lost = min((_size(p) for p in points if _error(p) > error), default=math.inf)
    return max((_size(p) for p in points if _size(p) < lost), default=0.0)


def _kind(report: Data, kind: str) -> list[Data]:
    return [c for c in report["cases"] if c["torqued"] == (kind == "with torque")]


def _overall(report: Data) -> Iterator[str]:
    for row in report["recommendations"]["overall"]:
        says = row.get("says") or f"{row['method']}: {row['reached']} of {row['asked']}"
        read, reach = ADVICE.match(says), REACH.search(says)
        cases = _kind(report, row["kind"])
        about = f"{row['kind']}, {row['precision']}, {row['error']:g}: {says}"
        if row["asked"] != len(cases):
            yield f"{about}: there are {len(cases)} cases"
        elif read is None or reach is None:
            yield f"{about}: cannot be read"
        else:
            yield from (f"{about}: {why}" for why in _reach(row, cases, read, reach))
            yield from (f"{about}: {why}" for why in _cost(row, cases, read, says))


def _reach(row: Data, cases: Points, read: re.Match[str], reach: re.Match[str]) -> Iterator[str]:
    """Yield what is wrong with the cases that a sentence speaks of."""
    kept = {c["name"]: _kept(c, read, row["precision"], row["error"]) for c in cases}
    missed = {name for name, own in kept.items() if not own}
    named = set(reach[4].split(", ")) if reach[4] else None
    count = int(reach[1]) if reach[1] else len(cases)
    if named is not None and named != missed:
        yield f"misses {', '.join(sorted(missed))}"
    elif count != len(cases) - len(missed):
        yield f"keeps in {len(cases) - len(missed)} of {len(cases)}"


def _cost(row: Data, cases: Points, read: re.Match[str], says: str) -> Iterator[str]:
    price, ratios = PRICE.search(says), []
    for case in cases:
        least = _least(case, row["precision"], row["error"], row["kind"])
        if _kept(case, read, row["precision"], row["error"]):
            fine = [_as_fine(own, read["step"], read["tolerance"])
                    for own in _of(case, read["method"], row["precision"]).values()]  # fmt: skip
            each = [max(own, key=_size) for own in fine]
            ratios.append(max(map(_price, each)) / least)
    stated = float(price[1]) if price else 1.0
    if ratios and abs(median(ratios) / stated - 1) > ROUGHLY:
        yield f"its figures say {median(ratios):.3g} times the least cost"


def _size(point: Data) -> float:
    return point["radians"] if point["setting"] == "step" else point["value"] or 0.0


def _least(case: Data, precision: str, error: float, kind: str) -> float:
    """Return the least cost with which any of ours keeps to an error in every scene."""
    methods = {p["method"] for p in case["points"] if p["scene"] and p["precision"] == precision}
    if kind != "with torque":
        methods = {m for m in methods if m.startswith("flow_") == ("at once" in kind)}
    best = math.inf
    for method in methods:
        scenes = list(_of(case, method, precision).values())
        for setting in {_size(p) for own in scenes for p in own}:
            fine = [[p for p in own if _size(p) <= setting] for own in scenes]
            if all(own and all(_error(p) <= error for p in own) for own in fine):
                best = min(best, max(_price(max(own, key=_size)) for own in fine))
    return best


def _by_case(report: Data) -> Iterator[str]:
    known = {c["name"]: c for c in report["cases"]}
    for row in report["recommendations"]["by_case"]:
        case, says = known[row["case"]], row["says"]
        about = f"{row['case']}, {row['precision']}, {row['error']:g}: {says}"
        least = min(_least(case, row["precision"], row["error"], kind)
                    for kind in ("with torque",))  # fmt: skip
        read = ADVICE.match(says)
        if says.startswith("no stepper"):
            if math.isfinite(least):
                yield f"{about}: one does"
        elif read is None or not _kept(case, read, row["precision"], row["error"]):
            yield f"{about}: it does not keep to it in every scene"


def _proposals(report: Data) -> Iterator[str]:
    rows = {(p["case"], p["scene"], p["precision"], p["part"]): p["error"]
            for p in report.get("proposals", ())}  # fmt: skip
    for says in report.get("proposals_say", ()):
        part, nearer, motions, times = map(float, re.findall(r"[\d.e+-]*\d", says)[:4])
        ratios = [
            rows[case, scene, precision, 1.0] / error
            for (case, scene, precision, own), error in rows.items()
            if own == part and error and rows.get((case, scene, precision, 1.0)) is not None
        ]
        told = (float(sum(r > 1 for r in ratios)), float(len(ratios)))
        if told != (nearer, motions) or abs(median(ratios) / times - 1) > 0.06:
            yield f"{says}: {told[0]:g} of {told[1]:g}, {median(ratios):.3g} times"


def _targets(report: Data) -> Iterator[str]:
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
    points = [list(_of(c, "flow_exact", precision).values()) for c in free]
    if not free or not all(points):
        return None
    flat = [(c, p) for c, each in zip(free, points, strict=True) for own in each for p in own]
    if read[2] == "instructions a call":
        counts = [p["instructions"] for _, p in flat]
        return None if None in counts else max(counts) <= _first(limit)
    times, least = (2.0, 16 * u) if precision == "f64" else (4.0, 0.0)
    kappas = [max(filter(None, c["kappa"].values()), default=0.0) for c, _ in flat]
    return all(_error(p) <= max(times * k * u, least)
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
        for own in _of(case, "step_dmv", WORDS[read[1]]).values():
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
        own = [p for p in points if p["scene"] == scene and 0 < _error(p) < math.inf]
        own.sort(key=lambda p: p["value"])
        kept = next((n for n, p in enumerate(own) if _error(p) > error), len(own))
        if not 0 < kept < len(own):
            return None
        fine, coarse = own[kept - 1], own[kept]
        x = [math.log(_error(p)) for p in (fine, coarse)]
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
