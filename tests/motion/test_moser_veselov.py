"""Ten orders of discrete Moser-Veselov, and every improvement that keeps them in floats."""

from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import derive
from derive.motion import moser_veselov
from derive.program.arithmetic import MANTISSA, working
from derive.program.indexed import Loop
from derive.program.program import Op
from derive.program.run import run
from tests.motion.free import FACTOR, LEAST, Case, cases
from tests.motion.published import series
from tests.motion.stepped import (
    BITS,
    MANY,
    START,
    Stepper,
    apart,
    dmv,
    invariants,
    measured_order,
)

pytestmark = pytest.mark.long

PRECISIONS = (np.float64, np.float32)
# Radians a step: where the method's error is below what rounding of the inputs allows.
ANGLE = 1 / 32
# A flip starts from 2^-20 beside its unstable axis; no stepper ends below what its steps' roundings
# grow to, e^(lambda T) u, and in float the flip comes at another time.
FLIP = {np.float64: 1e-8, np.float32: 4.0}
ROD = (1.0, 1.0, 7e-9, 0.0, 0.0, 0.0)
ROD_START = (1.0, 0.0, 0.0, 0.0, 0.25, 0.5, 3.0)
ROD_BOUND = {np.float64: 5e-14, np.float32: 2e-5}
# After a million steps: energy, length of the angular momentum.
LONG = {np.float64: (1e-14, 5e-15), np.float32: (3e-6, 1e-6)}
# What s is wrong by there: a step that wrong has no order left.
LOST = 1e-6
# Orders are measured between steps of 1/16 s and 1/64 s; the next order's share is below this.
NEXT_ORDER = 0.15


def steps_of(case: Case) -> tuple[float, int]:
    """Return a step that is a power of two of seconds, and how many there are."""
    rate = max(abs(w) for w in case.state[4:7])
    h = 2.0 ** np.floor(np.log2(ANGLE / rate))
    return float(h), round(case.state[7] / h)


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("case", cases(), ids=lambda c: c.name)
@pytest.mark.parametrize("kind", ["principal", "general"])
def test_a_reference_case_ends_within_its_condition(case: Case, dtype: type, kind: str) -> None:
    if case.kind == "general" != kind or (dtype is np.float32 and not case.exact_in_float):
        return
    found = dmv(kind).ran(dtype, case.tensor, case.state[:7], *steps_of(case))
    u = 2.0 ** -MANTISSA[dtype]
    allowed = [max(FACTOR[dtype] * kappa, LEAST) * u for kappa in case.kappa]
    if case.name.startswith("dzhanibekov"):
        allowed = [FLIP[dtype]] * 2
    true = [mp.mpf(x.mid().str(45, radius=False)) for x in case.end]
    assert all(e <= a for e, a in zip(apart(found, true), allowed, strict=True))


@pytest.mark.parametrize("kind", ["principal", "general"])
def test_the_order_is_ten(kind: str) -> None:
    tensor = (1, 2, 3, 0, 0, 0) if kind == "principal" else (2, 3, 4, -0.25, 0.125, -0.5)
    true = dmv(kind).moved(tensor, START, Fraction(1, 256), 128)
    for order in measured_order(dmv(kind), tensor, true, (8, 16, 32)):
        assert abs(order - 10) < NEXT_ORDER


def test_a_series_cut_short_has_its_order_only(monkeypatch: pytest.MonkeyPatch) -> None:
    true = dmv("principal").moved((1, 2, 3, 0, 0, 0), START, Fraction(1, 256), 128)
    for rows in (1, 2, 3):
        monkeypatch.setattr(moser_veselov, "S", moser_veselov.S[:rows])
        monkeypatch.setattr(moser_veselov, "D", moser_veselov.D[:rows])
        cut = dmv.__wrapped__("principal")
        monkeypatch.undo()
        order = measured_order(cut, (1, 2, 3, 0, 0, 0), true, (16, 32))[0]
        assert abs(order - 2 * (rows + 1)) < NEXT_ORDER


@pytest.mark.parametrize("kind", ["axisymmetric", "spherical"])
def test_a_body_of_revolution_is_moved_exactly_and_for_less(kind: str) -> None:
    tensor = (2, 2, 3, 0, 0, 0) if kind == "axisymmetric" else (2, 2, 2, 0, 0, 0)
    once = dmv(kind).moved(tensor, START, Fraction(4), 1)
    often = dmv("principal").moved(tensor, START, Fraction(1, 64), 256)
    assert max(apart(once, often)) < 1e-17  # the error of the general step at 1/64 s
    assert len(dmv(kind).step.ops) < 0.5 * operations(dmv("principal"))


def operations(stepper: Stepper) -> int:
    """Return the operations of a step, one pass of its loop counted."""
    return sum(len(line.body) if isinstance(line, Loop) else 1 for line in stepper.step.ops)


@pytest.mark.parametrize("dtype", PRECISIONS)
def test_the_scale_of_inertia_changes_no_bit(dtype: type) -> None:
    stepper, tensor = dmv("principal"), np.array([1.0, 2.0, 3.0, 0, 0, 0])
    plain = stepper.constants(dtype, tensor)
    for bits in (-360, 300) if dtype is np.float64 else (-70, 60):
        assert stepper.constants(dtype, tensor * 2.0**bits) == plain


@cache
def rod_after_two_seconds(dtype: type) -> list[Any]:
    rod = [float(dtype(x)) for x in ROD]
    return dmv("principal").moved(rod, ROD_START, Fraction(1, 128), 256)


@pytest.mark.parametrize("dtype", PRECISIONS)
def test_a_thin_rod_keeps_all_orders(dtype: type) -> None:
    rod = [float(dtype(x)) for x in ROD]
    found = dmv("principal").ran(dtype, rod, ROD_START, 2.0**-6, 128)
    assert max(apart(found, rod_after_two_seconds(dtype))) < ROD_BOUND[dtype]


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize(
    ("tensor", "omega"),
    [
        ((2.0, 3.0, 4.0, -0.25, 0.125, -0.5), (1.0, -0.5, 0.75)),
        ((1.0, 2.0, 3.0, 0, 0, 0), (1.0, 0.5, 2.0)),
        ((3.0, 1.0, 2.0, 0, 0, 0), (0.25, 1.0, 0.125)),
        ((1.0, 1.5, 2.25, 0, 0, 0), (0.5, 1.25, 0.5)),
        ((1.0, 1.0, 0.125, 0, 0, 0), (0.25, 0.5, 3.0)),
    ],
)
def test_a_million_steps_keep_energy_and_momentum(
    dtype: type, tensor: tuple[float, ...], omega: tuple[float, ...]
) -> None:
    start = (1.0, 0.0, 0.0, 0.0, *omega)
    kind = "general" if any(tensor[3:]) else "principal"
    end = dmv(kind).ran(dtype, tensor, start, float(dtype(0.01)), 10**6)
    drift = drifts(tensor, start, end)
    assert all(d <= bound for d, bound in zip(drift, LONG[dtype], strict=True))


def drifts(tensor, start, end) -> list[float]:
    """Return by which part energy and the length of the angular momentum changed."""
    before, after = invariants(tensor, start), invariants(tensor, end)
    return [float(abs(a / b - 1)) for a, b in zip(after, before, strict=True)]


@pytest.mark.parametrize("kind", ["general", "principal", "axisymmetric", "spherical"])
def test_in_no_time_nothing_moves(kind: str) -> None:
    tensor = (2.0, 2.0, 3.0, 0, 0, 0) if kind != "spherical" else (2.0, 2.0, 2.0, 0, 0, 0)
    assert dmv(kind).ran(np.float64, tensor, START, 0.0, 3) == list(START)
    at_rest = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert dmv(kind).ran(np.float64, tensor, at_rest, 0.5, 3) == list(at_rest)


def test_what_rounding_leaves_of_an_orthogonal_matrix_is_a_bias() -> None:
    """Without it the length of the momentum of a body with products drifts."""
    tensor, start = (2.0, 3.0, 4.0, -0.25, 0.125, -0.5), (1.0, 0.0, 0.0, 0.0, 1.0, -0.5, 0.75)
    stepper = dmv("general")
    names = {f"plan_back_{x}{a}" for x in "xyz" for a in "abc"}
    blind = [
        replace(op, operands=tuple(Fraction(0) if o in names else o for o in op.operands))
        if isinstance(op, Op)
        else op
        for op in stepper.step.ops
    ]
    without = replace(stepper, step=replace(stepper.step, ops=tuple(blind)))
    kept, lost = (
        s.ran(np.float32, tensor, start, float(np.float32(0.01)), 10**6) for s in (stepper, without)
    )
    assert max(drifts(tensor, start, lost)) > 5 * max(drifts(tensor, start, kept))


@pytest.mark.parametrize("tensor", [(1.0, 2.0, 3.0), (1.0, 1.5, 5.0), (2.0, 1.9, 0.3)])
def test_the_series_is_the_published_one_expanded_anew(tensor: tuple[float, ...]) -> None:
    with mp.workprec(BITS):
        turned = [mp.mpf(x) / 100 for x in (3, -1, 2)]
        theirs = series([mp.mpf(x) / max(tensor) for x in tensor], turned)
        assert max(abs(a - b) for a, b in zip(theirs, ours(tensor, turned), strict=True)) < 1e-40


def ours(tensor, turned):
    """Return s and d in many digits, from the ratios I/It = s + d I of two axes' plans."""
    stepper = dmv("principal")
    constants = run(stepper.setup, MANY, [mp.mpf(x) for x in (*tensor, 0, 0, 0)])
    plan = stepper.planned(MANY, constants, turned, mp.mpf(1))
    names = stepper.plan.outputs[0].components
    first, last = (2 * plan[names.index(f"plan_half_{axis}")] for axis in "xz")
    a, b = tensor[0] / mp.mpf(max(tensor)), tensor[2] / mp.mpf(max(tensor))
    d = (first - last) / (a - b)
    return first - d * a, d


def test_published_moments_lose_their_difference_and_ours_do_not() -> None:
    """Improvement (a): It_j - It_k is a product, not a difference."""
    tensor, omega = (2.0, 2.0 + 2.0**-26, 3.0), (0.5, 0.25, 8.0)
    stepper = dmv("principal")
    names = stepper.plan.outputs[0].components
    place = names.index("plan_couple_z")
    with mp.workprec(BITS):
        constants = run(stepper.setup, MANY, [mp.mpf(x) for x in (*tensor, 0, 0, 0)])
        h = mp.mpf(2) ** -6
        true = stepper.planned(MANY, constants, [mp.mpf(x) for x in omega], h)[place]
    table = working(np.float64)
    constants = stepper.constants(np.float64, (*tensor, 0, 0, 0))
    found = stepper.planned(table, constants, [np.float64(x) for x in omega], np.float64(2.0**-6))
    moments = np.array(tensor) / max(tensor)
    s, d = series(list(moments), [np.float64(x / 64) for x in omega])
    modified = 1 / (s / moments + d)
    naive = (modified[0] - modified[1]) / modified[2]
    assert abs(found[place] / true - 1) < 1e-15
    assert abs(naive / true - 1) > 1e-10


def test_planning_at_every_step_costs_more_than_the_step() -> None:
    """Improvement (b): s and d rest on invariants, and are worked out once a motion."""
    assert len(dmv("principal").plan.ops) > 0.8 * operations(dmv("principal"))


@pytest.mark.parametrize("dtype", PRECISIONS)
def test_steps_that_forget_their_remainder_drift(dtype: type) -> None:
    """Improvement (c): sums carry their remainder from call to call."""
    given = (1.0, 2.0, 3.0, 0, 0, 0), START, float(dtype(0.01)), 10**5
    kept = dmv("principal").ran(dtype, *given)
    forgot = dmv("principal").ran_forgetting(dtype, *given)
    assert max(drifts(given[0], START, forgot)) > 10 * max(drifts(given[0], START, kept))


def test_the_published_series_is_lost_on_a_thin_rod() -> None:
    """Improvement (d): the series is expanded about the largest moment."""
    turned = [0.004, 0.008, 0.05]
    with mp.workprec(BITS):
        true = series([mp.mpf(x) for x in ROD[:3]], [mp.mpf(x) for x in turned])
    naive = series([np.float64(x) for x in ROD[:3]], [np.float64(x) for x in turned])
    assert abs(naive[0] - true[0]) > LOST
    stepper = dmv("principal")
    constants = stepper.constants(np.float64, ROD)
    plan = stepper.planned(working(np.float64), constants, turned, np.float64(1))
    ratio = 2 * plan[stepper.plan.outputs[0].components.index("plan_half_z")]
    assert abs(ratio - (true[0] + true[1] * ROD[2])) < 1e-15


def test_the_published_series_overflows_and_ours_has_no_scale() -> None:
    """Improvement (e): moments are measured in the largest one."""
    with np.errstate(all="ignore"):
        naive = series([np.float64(x * 2.0**300) for x in (1, 2, 3)], [np.float64(0.01)] * 3)
    assert not np.isfinite(naive[0])
    assert all(np.isfinite(dmv("principal").constants(np.float64, np.array(ROD) * 2.0**300)))


NOTHING = (*(f"s{i}" for i in range(7, 14)), *(f"plan_couple_low_{axis}" for axis in "xyz"))
"""Inputs that hold what rounding left: nothing in many digits."""


def after_the_loop() -> list[int]:
    """Return the places of sums behind the loop, which only starts what follows, of two terms."""
    ops, nothing = dmv("principal").step.ops, set(NOTHING)
    loop = next(i for i, line in enumerate(ops) if isinstance(line, Loop))
    places = []
    for i, line in enumerate(ops):
        if not isinstance(line, Op):
            continue
        empty = nothing & {*line.operands}
        if line.operator == "add" and i > loop and not empty:
            places.append(i)
        if empty and (line.operator == "mul" or nothing >= {*line.operands}):
            nothing.add(line.result)
    return places


@pytest.mark.parametrize("place", after_the_loop())
def test_a_step_with_one_sign_changed_is_noticed(place: int) -> None:
    stepper, tensor = dmv("principal"), (1, 2, 3, 0, 0, 0)
    ops = list(stepper.step.ops)
    ops[place] = replace(ops[place], operator="sub")
    mutant = replace(stepper, step=replace(stepper.step, ops=tuple(ops)))
    ends = [s.moved(tensor, START, Fraction(1, 16), 2) for s in (stepper, mutant)]
    assert max(apart(*ends)) > 1e-9  # many times the error of two steps


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("step", [5e-324, 1e-45, 1e-36, 2.0**-96, 2.0**-95, 1e-20])
def test_a_plan_for_hardly_any_time_is_finite_and_its_step_stays(step: float, dtype: type) -> None:
    scene = derive.load("tumbling_body")
    precision: Any = "float" if dtype is np.float32 else "double"
    plan, going = (scene.function(f"{n}_dmv", precision=precision) for n in ("plan", "step"))
    moments = {"I_xx": 0.5, "I_yy": 0.75, "I_zz": 1.0}
    attitude, omega = np.array([0.6, 0.0, 0.8, 0.0]), np.array([3.0, -2.0, 1.0])
    planned = plan(omega=omega, time_step=step, **moments)
    assert np.isfinite(planned).all()
    after = going(plan=planned, attitude=attitude, omega=omega, remainder=np.zeros(7))
    assert np.allclose(after[0], attitude, rtol=0, atol=1e-7)
    assert np.allclose(after[1], omega, rtol=1e-6)
