"""Steps that turn a quaternion are bounded in two: before it is made of length one, and after."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from derive.program.precision import F32
from derive.verify.proved import lengths, waist
from derive.verify.proved.bounds import WORK, Proof, assumed, bounds_of, cutting
from derive.verify.proved.cut import Cutting
from derive.verify.proved.enclosed import enclosed
from derive.verify.proved.multiples import cone, is_multiple, squares_in
from derive.verify.proved.seen import Search
from derive.verify.proved.sphere import UNIT
from derive.verify.scale import measured_outputs
from tests.made import library_of

STEPS = ("tumbling_disc", "heavy_body", "rigid_body_steps")
"""Whose stages rest on their attitude in different ways: not, by gravity, all of them turned."""


def step_of(name: str, work: int = WORK // 64) -> Cutting:
    """Return what bounds the attitude after a step of RK4."""
    library = library_of(name)
    program = library["step_rk4"]
    spans = {q.name: span for q, span in measured_outputs(program)}
    return cutting(library, program, spans["attitude_next"], F32, work)


@pytest.mark.long
@pytest.mark.parametrize("name", STEPS)
def test_a_turned_quaternion_is_known_to_be_as_long_as_its_turn_and_another_is_not(
    name: str,
) -> None:
    """Whichever sum or difference is turned round, it is none any more."""
    of = step_of(name).traits
    (index,) = of.multiples
    (names,) = of.quaternions
    steps, places = list(of.trace.steps), cone(of.trace.steps, index, names)
    assert is_multiple(steps, places, names)
    turned = [n for n in places if steps[n].operator == "sub"]
    assert turned
    for n in turned:
        mutant = [*steps[:n], replace(steps[n], operator="add"), *steps[n + 1 :]]
        assert not is_multiple(mutant, places, names)


def lengths_at_points(at: Cutting) -> tuple[Any, Any]:
    """Return the squared length of the turned quaternion at points of a box, and its range."""
    (index,) = at.traits.multiples
    ranges = at.ranges(at.box.lows[:, None], at.box.highs[:, None])
    low, high = enclosed(at.traits, ranges, 1).ranges[index]
    dice = np.random.default_rng(3)
    start = at.box.lows[:, None] + (at.box.highs - at.box.lows)[:, None] * dice.random(
        (len(at.box.lows), 2000)
    )
    (places,) = at.box.quaternions
    each = start[list(places)]
    start[list(places)] = each * np.sqrt(dice.choice(UNIT, 2000) / (each**2).sum(axis=0))
    found = enclosed(at.traits, at.ranges(start, start), 2000)
    own = [found.ranges[n] for n in squares_in(at.traits.trace.steps, index)]
    return sum(((a + b) / 2) ** 2 for a, b in own), (low[0], high[0])


@pytest.mark.parametrize("name", STEPS)
def test_the_squared_length_is_where_it_is_told_to_be(monkeypatch: Any, name: str) -> None:
    square, (low, high) = lengths_at_points(step_of(name))
    assert low <= square.min()
    assert square.max() <= high < 1.3
    monkeypatch.setattr(lengths, "UNIT", (2.0, 2.1))
    square, (low, high) = lengths_at_points(step_of(name))
    assert square.max() > high or square.min() < low


def after_and_before(at: Cutting, share: float) -> tuple[Any, Any]:
    """Return bounds at points, of what comes after the waist and of all, a share of it carried."""
    index = waist.waist(at.traits)
    assert index is not None
    head = waist._head(at, index)
    most, ends = waist._carried(head, head.run())
    tail = waist._tail(at, index, [share * x for x in most], ends)
    assert tail is not None
    points = at.peaks.points
    found = enclosed(at.traits, at.ranges(points, points), points.shape[1])
    own = [found.ranges[n] for n in squares_in(at.traits.trace.steps, index)]
    by_name = {f"turned {n}": (a + b) / 2 for n, (a, b) in enumerate(own)}
    return tail._certain(np.array([by_name[n] for n in tail.box.names])), at._certain(points)


@pytest.mark.long
@pytest.mark.parametrize("name", STEPS)
def test_what_comes_after_a_waist_is_off_by_all_that_comes_before(name: str) -> None:
    after, whole = after_and_before(step_of(name), 1.0)
    assert np.all(after >= whole * (1 - 1e-6))
    after, whole = after_and_before(step_of(name), 0.0)
    assert np.any(after < whole)


@pytest.mark.long
def test_a_step_with_a_waist_is_bounded_closely_and_its_divisor_is_not_assumed() -> None:
    library = library_of("tumbling_disc")
    by = Proof(WORK // 8, Search(2048, 24, 512))
    each = [*bounds_of(library, library["step_rk4"], by)]
    for b in each:
        assert b.proved is not None
        assert b.seen <= b.proved <= 4.5 * b.seen
    assert not [s for b in each for s in b.assumed if s.startswith("divisors")]
    assert assumed(step_of("tumbling_disc")) == (
        f"quaternions given with |q|^2 in {UNIT[0]:g} .. {UNIT[1]:g}",
    )


@pytest.mark.long
def test_choices_that_are_made_are_not_cut_again() -> None:
    """A part in which a body's moments have an order has it in all its parts."""
    library = library_of("tumbling_body")
    program = library["step_split2"]
    spans = {q.name: span for q, span in measured_outputs(program)}
    at = cutting(library, program, spans["omega_next"], F32, WORK // 4)
    parts = at.run()
    wide = (parts.highs - parts.lows)[at._free]
    assert parts.shifts.shape[1] > 64
    assert np.all((wide == 0.5) | (wide == 0.0))
