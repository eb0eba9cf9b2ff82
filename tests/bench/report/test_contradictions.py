"""No sentence of the report is contradicted by its own figures, and one that is would be found."""

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from bench.report.contradictions import contradictions
from bench.report.recall import read, recalled
from bench.report.record import text
from tests.bench.report.made_up import report
from tests.made import thinned

STORED = Path(__file__).parents[3] / "generated" / "report.json"
Data = dict[str, Any]


@cache
def written() -> str:
    """Return the report as the stored record gives it, its advice and verdicts made anew."""
    return text(recalled(read(STORED.read_text(encoding="utf-8"))))


@cache
def few() -> str:
    """Return it with advice for two errors only."""
    whole = json.loads(written())
    for part in whole["recommendations"].values():
        part[:] = [row for row in part if row["error"] in (1e-5, 1e-9)]
    rate = {"case": "sphere", "scene": "spherical", "precision": "f64", "passes": 9}
    whole["proposals"] = [
        rate | {"part": 1.0, "error": 2e-15},
        rate | {"part": 0.9, "error": 1e-15},
    ]
    says = "0.9 of the proposal: nearer in 1 of 1 motions, in the median 2 times"
    return json.dumps(whole | {"proposals_say": [says]})


def rows(whole: Data, kind: str, precision: str, error: float) -> list[Data]:
    return [r for r in whole["recommendations"]["overall"]
            if (r["kind"], r["precision"], r["error"]) == (kind, precision, error)]  # fmt: skip


def at_once(whole: Data) -> Data:
    (row,) = rows(whole, "without torque, at any time at once", "f32", 1e-5)
    return row


def every_case(whole: Data) -> None:
    at_once(whole)["says"] = "flow_exact: every case"


def those_that_any_serves(whole: Data) -> None:
    row = at_once(whole)
    row["asked"] = row["reached"]


def another_case_is_missed(whole: Data) -> None:
    row = at_once(whole)
    row["says"] = row["says"].replace(row["missed"][0], "thin_rod_f32")


def a_longer_step(whole: Data) -> None:
    row = next(r for r in whole["recommendations"]["overall"] if r["radians"])
    row["says"] = row["says"].replace("steps of ", "steps of 9", 1)


def a_lower_cost(whole: Data) -> None:
    row = next(r for r in whole["recommendations"]["overall"] if "times the least" in r["says"])
    row["says"] = row["says"].split(";")[0]


def a_worse_scene(whole: Data) -> None:
    case = next(c for c in whole["cases"] if c["name"] == "sphere")
    flow = [p for p in case["points"] if p["method"] == "flow_exact"]
    next(p for p in flow if p["scene"] == "spherical")["attitude"] = 1.0


def a_verdict(whole: Data) -> None:
    target = next(t for t in whole["targets"] if t["says"].startswith("gyroscopic"))
    target["reached"] = not target["reached"]


def the_best_scene(whole: Data) -> None:
    for case in whole["cases"]:
        for p in case["points"]:
            if p["method"] == "step_dmv" and p["scene"] == "principal" and p["instructions"]:
                p["instructions"] *= 3


def advice_of_a_case(whole: Data) -> None:
    row = next(r for r in whole["recommendations"]["by_case"] if r["says"].startswith("no stepper"))
    row["error"] = 10.0


def nearer(whole: Data) -> None:
    whole["proposals_say"][0] = whole["proposals_say"][0].replace("nearer in ", "nearer in 1")


@cache
def before() -> frozenset[str]:
    return frozenset(contradictions(json.loads(few())))


@pytest.mark.long
@pytest.mark.parametrize(
    "spoilt",
    thinned([a_verdict, those_that_any_serves, another_case_is_missed, a_longer_step, a_lower_cost,
             a_worse_scene, every_case, the_best_scene, advice_of_a_case, nearer], 10),
    ids=lambda f: f.__name__,
)  # fmt: skip
def test_a_sentence_that_its_figures_contradict_is_found(spoilt: Callable[[Data], None]) -> None:
    whole = json.loads(few())
    spoilt(whole)
    assert set(contradictions(whole)) - before()


@pytest.mark.long
def test_what_follows_from_the_record_is_contradicted_by_it_nowhere() -> None:
    assert contradictions(json.loads(written())) == []


def test_a_target_without_a_rule_is_an_error() -> None:
    with pytest.raises(LookupError, match="no rule judges the target 'what'"):
        contradictions(json.loads(text(report())))


@pytest.mark.long
def test_a_report_that_is_read_back_is_the_same() -> None:
    assert text(recalled(read(written()))) == written()


def test_what_is_recorded_of_a_made_up_report_is_read_back() -> None:
    once = recalled(report())
    assert text(recalled(once)) == text(once)
    assert [f.case.name for f in once.found] == [f.case.name for f in report().found]
