"""Every step of the catalogue converges as it claims, to the motion that the lecture gives."""

from dataclasses import replace
from functools import cache

import pytest

from derive.check.motion import orders_hold
from derive.library.library import Library, library
from derive.program.indexed import Loop
from derive.program.precision import F64
from derive.program.program import Line, Op, Program, component_names
from derive.program.recorded import needed
from derive.scene import catalogue, load, parse_scene
from derive.scene.wanted import STEP_DERIVATIVES, moves
from derive.verify.convergence import Order, closed, course, exactness, order
from derive.verify.draw import with_motion
from derive.verify.sample import Sample, samples
from tests.made import library_of, scene_of, thinned

MOVING = [name for name in catalogue() if any(map(moves, scene_of(name).wanted))]
MUTANTS = 12  # of each step, spread over its sums
MUTATED = ("step_split", "step_rk4", "step_dmv")  # an order of two hides too much


@cache
def one_sample(scene: str) -> Sample:
    drawn = samples(library_of(scene).mechanism, F64, 2, 0).each
    return with_motion(library_of(scene), drawn, F64)[0]


@pytest.mark.long
@pytest.mark.parametrize("scene", thinned(MOVING, 8))
def test_every_step_has_its_order_and_every_flow_is_the_motion(scene: str) -> None:
    drawn = samples(library_of(scene).mechanism, F64, 2, 0).each
    verdicts = list(orders_hold(library_of(scene), with_motion(library_of(scene), drawn, F64)))
    assert [v for v in verdicts if v.outcome != "holds"] == []
    steps = {n for n in load(scene).wanted if moves(n) and n not in STEP_DERIVATIVES}
    assert {v.function for v in verdicts} == steps


@pytest.mark.parametrize(
    ("closed", "errors"),
    [
        (False, (1.6e-7, 5e-9)),
        (True, (1e-60, 1e-61)),  # a motion in closed form has no error at all
        (True, (1e-20, 1e-24)),  # or one that rounding covers
    ],
)
def test_two_errors_of_the_claimed_order_pass(*, closed: bool, errors: tuple[float, float]) -> None:
    assert Order(4, errors, closed).holds


@pytest.mark.parametrize(
    ("claimed", "errors"),
    [
        (4, (1.6e-7, 1e-8)),  # order 3
        (4, (1.6e-7, 1e-9)),  # order 6: then it is not the step that it says it is
        (10, (1e-16, 1e-16)),  # rounding, not convergence
        (4, (1e-60, 1e-61)),  # no error where there should be one
        (4, (0.0, 0.0)),
    ],
)
def test_two_errors_of_another_order_fail(claimed: int, errors: tuple[float, float]) -> None:
    assert not Order(claimed, errors, closed=False).holds


def test_a_closed_form_with_an_error_is_no_closed_form() -> None:
    assert not Order(4, (1.6e-7, 5e-9), closed=True).holds


@pytest.mark.long
def test_a_taylor_step_of_the_order_below_is_not_of_the_order_that_it_claims() -> None:
    text = load("tumbling_body").text.replace('"step_taylor"', '"step_taylor", "step_taylor19"')
    whole = library(parse_scene(text, "tumbling_body"))
    for name, claimed in (("step_taylor", 20), ("step_taylor19", 19)):
        found = order(whole, name, course(whole, name, one_sample("tumbling_body").values))
        assert found.claimed == claimed
        assert found.holds
        assert replace(found, claimed=20).holds == (claimed == 20)


COMPENSATED = '"step_rk4_compensated", "step_lie_compensated", "step_split_compensated"'


@pytest.mark.long
@pytest.mark.whole
def test_a_compensated_step_has_the_order_of_its_step() -> None:
    text = load("tumbling_body").text.replace('"step_taylor"', COMPENSATED)
    whole = library(parse_scene(text, "tumbling_body"))
    each = with_motion(whole, (one_sample("tumbling_body"),), F64)
    found = {v.function: v.outcome for v in orders_hold(whole, each)}
    assert {found[name] for name in COMPENSATED.replace('"', "").split(", ")} == {"holds"}
    spoilt = replace(whole, motions=tuple(map(_late, whole.motions)))
    found = {v.function: v.outcome for v in orders_hold(spoilt, each)}
    assert {name for name, outcome in found.items() if outcome == "FAILS"} >= {
        "step_rk4_compensated",
        "step_lie_compensated",
    }


def _late(program: Program) -> Program:
    """Return a compensated step that ends with the omega that it began with."""
    if not program.name.endswith("_compensated"):
        return program
    names = component_names(program)
    kept = dict(zip(names, program.results, strict=True)) | {"omega_x_next": "omega_x"}
    return replace(program, results=tuple(kept[name] for name in names))


SPHERE = """
title  = "Sphere that tumbles"
wanted = ["step_dmv", "step_split", "step_lie", "step_rk4"]

[parameters]
J = { unit = "kg m^2", range = [1, 2], meaning = "moment of inertia" }

[axes]
fixed_in = "body"
attitude = "quaternion"

[body]
kind    = "principal"
moments = ["J", "J", "J"]

[known]
angular_velocity = { range = [-10, 10] }
moment           = [0, 0, 0]

[motion]
time_step = { range = [0, 0.02] }
"""


@pytest.mark.long
def test_only_what_is_in_closed_form_may_be_without_an_order() -> None:
    sphere = library(parse_scene(SPHERE, "sphere"))
    steps = ("step_dmv", "step_split", "step_lie")
    assert [closed(sphere, name) for name in (*steps, "step_rk4")] == [True, True, True, False]
    assert [closed(library_of("tumbling_disc"), n) for n in ("step_dmv", "step_lie")] == [
        True,
        False,
    ]
    assert not any(closed(library_of("tumbling_body"), name) for name in steps)
    assert not closed(library_of("heavy_body"), "step_split")
    each = with_motion(sphere, samples(sphere.mechanism, F64, 1, 0).each, F64)
    assert {v.outcome for v in orders_hold(sphere, each)} == {"holds"}


@pytest.mark.long
@pytest.mark.parametrize("step", MUTATED)
def test_a_sign_turned_in_a_step_is_noticed_unless_it_is_below_the_order(step: str) -> None:
    scene = "tumbling_body"
    whole, program = library_of(scene), library_of(scene)[step]
    true = course(whole, step, one_sample(scene).values)
    own = order(whole, step, true)
    state = needed(program.ops, program.results[:7])  # what is carried besides is checked elsewhere
    sums = [k for k, line in enumerate(program.ops) if line in state and _turned(line) != line]
    turned = sums[:: max(1, len(sums) // MUTANTS)]
    found = {k: order(_with(whole, program, k), step, true) for k in turned}
    passed = [k for k, one in found.items() if one.holds]
    assert [k for k in passed if found[k].errors[0] > 2 * own.errors[0]] == []
    assert len(turned) - len(passed) >= 5


@pytest.mark.long
@pytest.mark.whole
def test_a_sign_turned_in_the_exact_flow_is_noticed() -> None:
    scene = "tumbling_disc"
    whole, program = library_of(scene), library_of(scene)["flow_exact"]
    values = one_sample(scene).values
    assert exactness(whole, values) < 1e-40
    turned = [k for k, line in enumerate(program.ops) if _turned(line) != line][::3]
    missed = [k for k in turned if exactness(_with(whole, program, k), values) < 1e-13]
    assert missed == []


def _with(whole: Library, program: Program, place: int) -> Library:
    """Return the library with one operation of a motion turned."""
    ops = tuple(_turned(line) if k == place else line for k, line in enumerate(program.ops))
    motions = tuple(replace(p, ops=ops) if p == program else p for p in whole.motions)
    return replace(whole, motions=motions)


def _turned(line: Line) -> Line:
    """Return an addition as a subtraction and the other way round; a loop in its last addition."""
    if isinstance(line, Loop):
        return line
    return replace(line, operator={"add": "sub", "sub": "add"}.get(line.operator, line.operator))


def test_only_sums_are_turned() -> None:
    assert _turned(Op("t0", "mul", ("a", "b"))).operator == "mul"
    assert _turned(Op("t0", "sub", ("a", "b"))).operator == "add"
