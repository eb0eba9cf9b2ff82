"""What is not a number is an infinite error to every checker, wherever among numbers it stands."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from flint import arb
from mpmath import mpf

from bench.motion import step_jacobian
from bench.report.hard import Hard
from bench.report.hard_formulas import worst_of
from bench.report.hard_top import ANSWERS
from derive.check.compiler import find_compiler
from derive.check.emitted import Emitted, Files, loaded
from derive.check.energy import emitted_balance
from derive.check.motion import orders_hold, step_slopes_hold
from derive.check.particles import clouds
from derive.check.turned import turned_axes
from derive.emit.files import scene_files
from derive.library.library import Library
from derive.program.largest import largest
from derive.program.precision import F64
from derive.program.program import Op, Program
from derive.scene import Scene
from derive.verify.cloud import CloudAnswers, answers
from derive.verify.convergence import Order
from derive.verify.draw import with_motion
from derive.verify.measure import Errors
from derive.verify.sample import Sample, samples
from derive.verify.search import Sampling
from derive.verify.stated import figures
from tests.made import library_of

NAN, FEW = math.nan, 3
FEWEST = Sampling(samples=64, rounds=1, batch=16, balls=1, motion_balls=1)


@cache
def drawn(scene: str) -> tuple[Sample, ...]:
    made = library_of(scene)
    return with_motion(made, samples(made.mechanism, F64, FEW, 0).each, F64)


def without_value(program: Program) -> Program:
    """Return a formula that gives 0/0 in its second component, whatever it is given."""
    given = program.inputs[0].components[0]
    nothing = (Op("nothing", "sub", (given, given)), Op("nan", "div", ("nothing", "nothing")))
    first, _, *rest = program.results
    return replace(program, ops=(*program.ops, *nothing), results=(first, "nan", *rest))


def spoilt(whole: Library, *names: str) -> Library:
    """Return the library with some of its motions without a value."""
    motions = [without_value(p) if p.name in names else p for p in whole.motions]
    assert tuple(motions) != whole.motions
    return replace(whole, motions=tuple(motions))


@pytest.mark.parametrize("numbers", [(1.0, NAN), (NAN, 1.0), (arb(1), arb("nan")), (0, math.inf)])
def test_the_largest_of_numbers_is_infinite_if_one_is_none(numbers: Sequence[Any]) -> None:
    assert largest(numbers) == math.inf


@pytest.mark.long
def test_a_formula_without_a_value_has_an_infinite_error() -> None:
    scene, name = "attitude", "quaternion_product"
    found = figures(spoilt(library_of(scene), name), FEWEST)
    assert {m.worst for m in found if m.function == name} == {math.inf}
    assert all(math.isfinite(m.worst) for m in found if m.function != name)


def test_an_error_that_is_no_number_is_measured_as_infinite() -> None:
    assert Errors("f", "x", ((0.5, 0.5), (0.5, NAN))).largest() == [0.5, math.inf]


@pytest.mark.long
def test_a_step_or_flow_without_a_value_is_no_motion() -> None:
    broken = ("step_rk4", "flow_exact")
    verdicts = list(
        orders_hold(spoilt(library_of("tumbling_disc"), *broken), drawn("tumbling_disc"))
    )
    assert {v.function for v in verdicts if v.outcome == "FAILS"} == set(broken)


def test_an_order_of_errors_that_are_no_numbers_does_not_hold() -> None:
    assert not any(Order(4, e, closed=False).holds for e in ((1e-7, NAN), (NAN, 1e-7), (NAN, NAN)))


@pytest.mark.long
def test_a_slope_without_a_value_is_noticed() -> None:
    scene, name = "tumbling_body", "step_rk4_jacobian"
    whole = library_of(scene)
    place = len(next(p for p in whole.motions if p.name == name).results) - 2
    motions = tuple(_without_slope(p, place) if p.name == name else p for p in whole.motions)
    verdicts = list(step_slopes_hold(replace(whole, motions=motions), drawn(scene)))
    assert [v.outcome for v in verdicts if v.function == name] == ["FAILS"]


def _without_slope(program: Program, place: int) -> Program:
    broken = without_value(program)
    results = tuple("nan" if k == place else r for k, r in enumerate(program.results))
    return replace(broken, results=results)


@pytest.mark.long
def test_an_answer_of_the_cloud_without_a_value_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    def spoilt_answers(machine: Scene, given: Mapping[str, float]) -> CloudAnswers:
        found = answers(machine, given)
        found.__dict__["unknowns"] = found.unknowns | {"beta_ddot": mpf("nan")}
        return found

    monkeypatch.setattr("derive.check.particles.answers", spoilt_answers)
    found = {
        v.function: v.outcome for v in clouds(library_of("sleeping_top"), drawn("sleeping_top"))
    }
    assert found["accelerations"] == "FAILS"
    assert found["energy"] == "holds"


def emitted(scene: str, folder: Path) -> Emitted:
    texts = {
        path.partition("/")[2]: text for path, text in scene_files(library_of(scene), ()).items()
    }
    return list(loaded(library_of(scene), Files(texts, "made in memory"), folder, find_compiler()))[
        -1
    ]


def answering(one: Emitted, name: str) -> Emitted:
    """Return emitted files of which one function ends in what is no number, at every call but 1."""
    calls = 0

    def function(given: Mapping[str, Any]) -> dict[str, list[float]]:
        nonlocal calls
        calls += 1
        found = one.functions[name](given)
        return {n: [*x[:-1], NAN] if calls > 1 else x for n, x in found.items()}

    return replace(one, functions={**one.functions, name: function})


@pytest.mark.long
def test_a_rate_without_a_value_breaks_the_laws(tmp_path: Path) -> None:
    one, each = emitted("free_body", tmp_path), drawn("free_body")
    wrong = answering(one, "acceleration")
    assert {v.outcome for v in emitted_balance(one, each)} == {"holds"}
    assert {v.outcome for v in emitted_balance(wrong, each)} == {"FAILS"}
    assert {v.outcome for v in turned_axes(one, each, {})} <= {"holds", "skipped"}
    assert "FAILS" in {v.outcome for v in turned_axes(wrong, each, {})}


def test_a_report_takes_no_figure_that_is_no_number_for_small() -> None:
    figures, bound = {"f64": (1e-16, NAN)}, {"f64": 1.0}
    assert not Hard("n", "m", "", {}, "", figures, bound, "").holds("f64")
    calls = count()

    def form(*_: Any) -> list[float]:
        return [NAN if next(calls) == 1 else 0.0]

    assert math.isnan(worst_of(ANSWERS[1], form, "f64"))
    assert step_jacobian._apart([(1.0,), (NAN,)], [(1.0,), (1.0,)]) == math.inf
