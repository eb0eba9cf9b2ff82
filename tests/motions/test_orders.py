"""Every step of the catalogue converges as it claims, to the motion that the lecture gives."""

from dataclasses import replace
from functools import cache

import pytest

from derive.c_text import F64
from derive.check.motion import orders
from derive.convergence import Order, course, exactness, order
from derive.library import Library, library
from derive.motion_error import with_motion
from derive.program import Line, Op, Program, Repeat
from derive.recorded import needed
from derive.sample import Sample, samples
from derive.scene import catalogue, load
from derive.scene.wanted import moves

MOVING = [name for name in catalogue() if any(map(moves, load(name).wanted))]
MUTANTS = 12  # of each step, spread over its sums
MUTATED = ("step_split", "step_rk4", "step_dmv")  # an order of two hides too much


@cache
def made(scene: str) -> Library:
    return library(load(scene))


@cache
def one_sample(scene: str) -> Sample:
    drawn = samples(made(scene).known, F64, 2, 0).each
    return with_motion(made(scene), drawn, F64)[0]


@pytest.mark.parametrize("scene", MOVING)
def test_every_step_has_its_order_and_every_flow_is_the_motion(scene: str) -> None:
    drawn = samples(made(scene).known, F64, 2, 0).each
    verdicts = list(orders(made(scene), with_motion(made(scene), drawn, F64)))
    assert [v for v in verdicts if v.outcome != "holds"] == []
    steps = {step for step in load(scene).wanted if moves(step) and step.count("_") == 1}
    assert {v.function for v in verdicts} == steps


@pytest.mark.parametrize(
    ("claimed", "errors"),
    [
        (4, (1.6e-7, 5e-9)),
        (4, (1e-60, 1e-61)),  # a motion in closed form has no error at all
        (4, (1e-20, 1e-24)),  # or one that rounding covers
    ],
)
def test_two_errors_of_the_claimed_order_pass(claimed: int, errors: tuple[float, float]) -> None:
    assert Order(claimed, errors).holds


@pytest.mark.parametrize(
    ("claimed", "errors"),
    [
        (4, (1.6e-7, 1e-8)),  # order 3
        (4, (1.6e-7, 1e-9)),  # order 6: then it is not the step that it says it is
        (10, (1e-16, 1e-16)),  # rounding, not convergence
    ],
)
def test_two_errors_of_another_order_fail(claimed: int, errors: tuple[float, float]) -> None:
    assert not Order(claimed, errors).holds


@pytest.mark.parametrize("step", MUTATED)
def test_a_sign_turned_in_a_step_is_noticed_unless_it_is_below_the_order(step: str) -> None:
    scene = "tumbling_body"
    whole, program = made(scene), made(scene)[step]
    true = course(whole, step, one_sample(scene).values)
    own = order(whole, step, true)
    state = needed(program.ops, program.results[:7])  # what is carried besides is checked elsewhere
    sums = [k for k, line in enumerate(program.ops) if line in state and _turned(line) != line]
    turned = sums[:: max(1, len(sums) // MUTANTS)]
    found = {k: order(_with(whole, program, k), step, true) for k in turned}
    passed = [k for k, one in found.items() if one.holds]
    assert [k for k in passed if found[k].errors[0] > 2 * own.errors[0]] == []
    assert len(turned) - len(passed) >= 5


def test_a_sign_turned_in_the_exact_flow_is_noticed() -> None:
    scene = "tumbling_disc"
    whole, program = made(scene), made(scene)["flow_exact"]
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
    if isinstance(line, Repeat):
        return line
    return replace(line, operator={"add": "sub", "sub": "add"}.get(line.operator, line.operator))


def test_only_sums_are_turned() -> None:
    assert _turned(Op("t0", "mul", ("a", "b"))).operator == "mul"
    assert _turned(Op("t0", "sub", ("a", "b"))).operator == "add"
