"""The list of targets rests on nothing that was found, and what lacks a figure is not reached."""

import json
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from bench.build import BuildError, run
from bench.flops import Flops
from bench.motion import ours
from bench.motion.case import cases
from bench.motion.step_jacobian import Entry
from bench.report import workshop
from bench.report.case_run import Found
from bench.report.counts import SPECIAL, Count
from bench.report.gyroscopic import ASPHERICITIES, Gyroscopic
from bench.report.hard import SCALED, Hard, by_precision
from bench.report.hard_spin import NAMES
from bench.report.point import Point
from bench.report.targets import EXACT, Evidence, Target, targets
from derive.scene import SceneError
from tests.bench.report.made_up import CASE, PRECISIONS, curve, point, wrong

ROOT = Path(__file__).parents[3]
FREE = [case.name for case in cases().values() if not case.torqued]


def flow(precision: str, error: float = 0.0, cost: float | None = 1e3) -> Point:
    """Return a point of the exact flow."""
    return replace(point(EXACT, 1.0, error, 0.0, precision), setting="", instructions=cost)


def every_case(points: Sequence[Point]) -> dict[str, Found]:
    return {name: Found(cases()[name], tuple(points), ()) for name in FREE}


def evidence(found: Mapping[str, Found] | None = None, hard: Sequence[Hard] = ()) -> Evidence:
    return Evidence(found or {}, hard, (), (), ())


def by_name(given: Evidence) -> dict[str, Target]:
    return {t.says: t for t in targets(given)}


def row(name: str, figures: Mapping[str, tuple[float, ...]], method: str = EXACT) -> Hard:
    bound = dict.fromkeys(PRECISIONS, 1e-6)
    return Hard(name, "", "", {}, method, figures, bound, "")


def test_a_run_that_found_nothing_has_every_target_and_reaches_none() -> None:
    found = list(targets(evidence()))
    stored = json.loads((ROOT / "generated" / "report.json").read_text(encoding="utf-8"))
    assert [t.says for t in found] == [t["says"] for t in stored["targets"]]
    assert {t.reached for t in found} == {None}
    assert {t.measured.split(":")[0] for t in found} == {"not measured"}


def test_every_torque_free_case_must_have_a_point_in_each_precision() -> None:
    whole = every_case([flow("f64"), flow("f32")])
    says = [f"flow_exact, {p}: error on every torque-free case" for p in ("double", "float")]
    found = by_name(evidence(whole))
    assert [found[s].reached for s in says] == [True, True]
    without = {name: one for name, one in whole.items() if name != CASE}
    found = by_name(evidence(without))
    assert [found[s].measured for s in says] == [f"not measured: {CASE}"] * 2
    halved = whole | {CASE: Found(cases()[CASE], (flow("f64"),), ())}
    found = by_name(evidence(halved))
    assert [found[s].reached for s in says] == [True, None]


def test_one_case_that_is_too_wrong_or_uncounted_is_seen() -> None:
    for bad, what, reached in (
        (flow("f64", error=float("nan")), "error on every torque-free case", False),
        (flow("f64", cost=1e6), "instructions a call", False),
        (flow("f64", cost=None), "instructions a call", None),
    ):
        found = every_case([flow("f64")]) | {CASE: Found(cases()[CASE], (bad,), ())}
        assert by_name(evidence(found))[f"flow_exact, double: {what}"].reached is reached


@pytest.mark.parametrize("name", [*SCALED, *NAMES])
def test_a_hard_case_needs_both_precisions(name: str) -> None:
    for figures, reached in (
        ({"f64": (1e-9,), "f32": (1e-9,)}, True),
        ({"f64": (1e-9,), "f32": (1e-3,)}, False),
        ({"f64": (1e-9,), "f32": (float("nan"),)}, False),
        ({"f64": (1e-9,)}, None),
        ({}, None),
    ):
        found = by_name(evidence(hard=[row(name, figures)]))
        assert found[f"flow_exact, {name}"].reached is reached


def test_a_long_run_without_float_is_not_reached_in_float() -> None:
    name = "1e+06 steps of 0.01 s: energy"
    found = by_name(evidence(hard=[row(name, {"f64": (1e-16,)}, "step_dmv")]))
    assert found[f"step_dmv, double: {name}"].reached is True
    assert found[f"step_dmv, float: {name}"].reached is None


def test_a_curve_that_ends_above_the_error_misses_and_one_without_counts_is_unknown() -> None:
    says = "step_dmv: the generic case to 1e-12"
    ends = [p for p in curve("step_dmv", 10, 430.0) if p.wrong.state > 1e-9]
    for points, reached in (
        (curve("step_dmv", 10, 430.0), True),
        (ends, False),
        ([replace(p, wrong=wrong(float("nan"))) for p in ends], False),
        ([replace(p, instructions=None) for p in curve("step_dmv", 10, 430.0)], None),
    ):
        found = {CASE: Found(cases()[CASE], tuple(points), ())}
        assert by_name(evidence(found))[says].reached is reached


def test_the_gyroscopic_term_needs_every_asphericity() -> None:
    rows = [Gyroscopic("fast", "f64", a, 0.5, 3.0, 2.0) for a in ASPHERICITIES]
    says = "gyroscopic term, form fast, double, any asphericity"
    for own, reached in ((rows, True), (rows[1:], None)):
        given = replace(evidence(), gyroscopic=own)
        assert by_name(given)[says].reached is reached


def test_a_tool_that_was_not_run_or_not_counted_is_not_measured() -> None:
    says = [f"RK4 step with its 7x7 Jacobian: {x}" for x in ("operations", "-O3 -march=native")]
    for entry, reached in (
        (Entry("ours", Flops(add=1), {"O3-native": 10.0}, 0.0), [True, True]),
        (Entry("ours", Flops(add=1), {}, 0.0), [True, None]),
        (Entry("ours", None, {}, 0.0, "not run"), [None, None]),
    ):
        found = by_name(replace(evidence(), tools=[entry]))
        assert [found[s].reached for s in says] == reached


def test_a_missing_program_is_not_run(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(BuildError, match="`no-such-compiler` cannot be run: No such file"):
        run(("no-such-compiler", "-c"))
    real = subprocess.run

    def without_gcc(command: Sequence[str], **rest: object) -> object:
        return real(["no-such-gcc", *command[1:]], **rest)  # type: ignore[call-overload]

    monkeypatch.setattr("bench.build.subprocess.run", without_gcc)
    assert by_precision(lambda _: run(("gcc", "--version"))) == {}


def test_a_bug_of_ours_is_not_listed_as_not_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise ZeroDivisionError("a bug")

    def refused(*_: object) -> None:
        raise SceneError("a rule")

    with monkeypatch.context() as patched:
        patched.setattr(workshop, "emission", broken)
        with pytest.raises(ZeroDivisionError):
            workshop._programs("principal", tmp_path)
        patched.setattr(workshop, "emission", refused)
        assert workshop._programs("principal", tmp_path)[1]["f64"] == "a rule"
    scene = tmp_path / "scene.toml"
    scene.write_text('wanted = [\n    "moment",\n]\n')
    monkeypatch.setattr(ours, "library", broken)
    monkeypatch.setattr(ours, "load", lambda _: None)
    with pytest.raises(ZeroDivisionError):
        ours._unmade(scene)
    monkeypatch.setattr(ours, "library", refused)
    assert ours._unmade(scene) == {"moment": "not emitted: a rule"}


def test_instructions_of_a_step_are_those_of_the_dearest_scene() -> None:
    cheap, dear = curve("step_dmv", 10, 300.0), curve("step_dmv", 10, 700.0)
    found = {
        CASE: Found(cases()[CASE], tuple(cheap), ()),
        "full_tensor": Found(cases()["full_tensor"], tuple(dear), ()),
    }
    says = "step_dmv, double: instructions a step"
    assert by_name(evidence(found))[says].reached is False
    assert by_name(evidence({CASE: found[CASE]}))[says].reached is True


def test_a_lucky_crossing_of_a_curve_is_no_cost() -> None:
    lucky = [replace(p, wrong=wrong(1e-13)) if p.value == 0.5 else p
             for p in curve("step_dmv", 10, 1e4)]  # fmt: skip
    says = "step_dmv: the generic case to 1e-12"
    plain = {CASE: Found(cases()[CASE], tuple(curve("step_dmv", 10, 1e4)), ())}
    found = {CASE: Found(cases()[CASE], tuple(lucky), ())}
    assert by_name(evidence(found))[says].measured == by_name(evidence(plain))[says].measured


def test_counts_that_are_not_falling_are_seen() -> None:
    says = "step_rk4: operations for a principal, axisymmetric, spherical body"
    for third, reached in ((80.0, True), (90.0, False), (None, None)):
        rows = [Count(scene, "step_rk4", "operations", count)
                for scene, count in zip(SPECIAL, (100.0, 90.0, third), strict=True)]  # fmt: skip
        assert by_name(replace(evidence(), counts=rows))[says].reached is reached
