"""Sentences of a report that its own figures contradict, found from ``report.json`` alone.

Nothing of what made the advice and the verdicts is used: every sentence is read as a reader reads
it, and held against the worst of all cases, scenes and settings that it speaks of.
"""

import math
import re
from collections.abc import Iterator
from statistics import median

from bench.report.read_back import Data, Points, error_of, points_of
from bench.report.targets_read import targets_contradicted

ADVICE = re.compile(
    r"(?P<method>\w+)(?: with steps of (?:\S+ s \()?(?P<step>\S+) rad\)?| to (?P<tolerance>[^:;]+)"
    r"|: one call)?"
)
REACH = re.compile(r": (?:every case|(\d+) of (\d+) cases, not (?:(\d+) others|([^;]+)))")
PRICE = re.compile(r"; (\S+) times the least cost")
PRINTED = 1.0011  # a printed setting has four digits and is cut: the true one is so much larger
ROUGHLY = 0.011  # a figure of three digits, or of two and more, printed


def contradictions(report: Data) -> list[str]:
    """Return every sentence of advice and every verdict that the report's figures contradict."""
    advice = (*_overall(report), *_by_case(report))
    return [*advice, *targets_contradicted(report), *_proposals(report)]


def _price(point: Data) -> float:
    return float(point["instructions"] or point["seconds"] * 1e9)


def _as_fine(points: Points, step: str | None, tolerance: str | None) -> list[Data]:
    """Return the points with a setting at most as large as the one that is named."""
    if step:
        return [p for p in points if p["radians"] <= float(step) * PRINTED]
    if tolerance:
        return [p for p in points if p["value"] <= float(tolerance) * PRINTED]
    return list(points)


def _kept(case: Data, read: re.Match[str], precision: str, error: float) -> bool:
    """Tell whether a method keeps to an error in every scene, with the setting and all finer."""
    scenes = points_of(case, read["method"], precision)
    fine = [_as_fine(own, read["step"], read["tolerance"]) for own in scenes.values()]
    named = float(read["step"] or read["tolerance"] or 0)
    reached = all(_coarsest(own, error) * PRINTED >= named for own in scenes.values())
    kept = all(own and all(error_of(p) <= error for p in own) for own in fine)
    return bool(fine) and reached and kept


def _coarsest(points: Points, error: float) -> float:
    """Return the coarsest setting up to which all points keep to an error."""
    lost = min((_size(p) for p in points if error_of(p) > error), default=math.inf)
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
            scenes = points_of(case, read["method"], row["precision"]).values()
            fine = [_as_fine(own, read["step"], read["tolerance"]) for own in scenes]
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
        scenes = list(points_of(case, method, precision).values())
        for setting in {_size(p) for own in scenes for p in own}:
            fine = [[p for p in own if _size(p) <= setting] for own in scenes]
            if all(own and all(error_of(p) <= error for p in own) for own in fine):
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
