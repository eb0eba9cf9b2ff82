"""The JSON holds every section, only finite numbers, and names what was not run."""

import json
import sys

import pytest

from bench.motion.case import cases
from bench.report.case_run import Workshop, case_run
from bench.report.point import SMALL, Limits
from bench.report.record import data, text
from tests.bench.report.made_up import report

SECTIONS = {
    "generator": {},
    "kind": {},
    "machine": {"gcc", "valgrind", "heyoka", "mujoco", "casadi", "scipy", "symforce"},
    "rules": {"error", "attainable", "instructions", "time"},
    "targets": {"says", "limit", "measured", "reached", "only"},
    "recommendations": {"overall", "by_case"},
    "cases": {"name", "says", "torqued", "time", "rate", "kappa", "attainable", "points", "not_run",
              "command"},
    "hard_cases": {"name", "measure", "naive", "naive_found", "ours", "ours_found", "bound", "why",
                   "holds", "command"},
    "orders": {"method", "case", "claimed", "measured", "points", "agrees"},
    "step_and_jacobian": {"author", "flops", "instructions", "apart", "missing"},
    "gyroscopic_term": {"form", "precision", "asphericity", "median", "largest", "of_terms"},
    "functions": {"scene", "name", "flops", "divisions", "instructions", "median", "largest"},
    "counts": {"scene", "function", "of", "count"},
    "proposals": {"case", "scene", "precision", "part", "passes", "error"},
    "proposals_say": set(),
}  # fmt: skip
POINT = {"method", "scene", "precision", "setting", "value", "passes", "radians", "instructions",
         "seconds", "omega", "attitude", "energy", "momentum"}  # fmt: skip


def test_every_section_is_there_and_complete() -> None:
    whole = data(report())
    assert whole.keys() == SECTIONS.keys()
    for name, keys in SECTIONS.items():
        first = whole[name][0] if isinstance(whole[name], list) else whole[name]
        assert set(keys) <= set(first) if keys else True, name
    assert whole["cases"][0]["points"][0].keys() == POINT


def test_what_is_not_finite_is_null() -> None:
    whole = json.loads(text(report()), parse_constant=lambda word: pytest.fail(word))
    assert whole["orders"][1]["measured"] is None


def test_every_case_and_hard_case_says_how_to_see_it_again() -> None:
    whole = data(report())
    commands = [row["command"] for row in (*whole["cases"], *whole["hard_cases"])]
    assert all(c.startswith("python -m bench.report --only ") for c in commands)


def test_a_peer_that_is_not_installed_is_listed_as_not_run(
    tmp_path: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    for package in ("heyoka", "mujoco", "casadi", "scipy", "scipy.integrate"):
        monkeypatch.setitem(sys.modules, package, None)
    coarse = Limits(finest=1.0, longest=0.01, ratio=4.0, rounds=1)
    shop = Workshop({}, {}, tmp_path, coarse, {})  # type: ignore[arg-type]
    found = case_run(cases()["const_body_torque"], shop)
    missing = {n.method: n.reason for n in found.not_run}
    for name in ("heyoka (Taylor)", "MuJoCo RK4", "CasADi cvodes", "SciPy DOP853"):
        assert "import of" in missing[name] or "No module" in missing[name]
    assert "all steppers of scene 'moment'" in missing
    assert SMALL.rounds > coarse.rounds
