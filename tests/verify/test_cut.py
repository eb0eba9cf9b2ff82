"""Boxes of bounds are cut along what an output rests on; none of their parts is lost."""

from typing import Any

import numpy as np
import pytest

from derive.program.precision import F32
from derive.verify.proved import cut
from derive.verify.proved.bounds import WORK, Proof, bounds_of, cutting
from derive.verify.proved.cells import Cells
from derive.verify.proved.cut import Cutting
from derive.verify.proved.seen import Search
from derive.verify.proved.sphere import UNIT, of_about_unit_length
from derive.verify.scale import measured_outputs
from tests.made import library_of

QUICK = Proof(WORK // 64, Search(2048, 24, 512))


def cut_of(name: str, function: str, output: str, work: int = QUICK.work) -> Cutting:
    """Return what bounds an output of a function, in float."""
    library = library_of(name)
    spans = {q.name: span for q, span in measured_outputs(library[function])}
    return cutting(library, library[function], spans[output], F32, work)


def test_an_output_is_cut_along_what_it_rests_on_alone() -> None:
    """A turn does not change how a body is turned: parts of all turns would be wasted on it."""
    names = cut_of("rigid_body", "state_rate", "omega_dot").box.names
    assert "omega_x" in names
    assert "moment_x" in names
    assert not [n for n in names if n.startswith(("attitude", "velocity", "force"))]


@pytest.mark.parametrize("which", [
    ("heavy_body", "step_rk4", "omega_next"), ("attitude", "quaternion_rotate", "vector_N"),
    ("heavy_body", "step_split2", "attitude_next"),
])  # fmt: skip
def test_a_bound_over_parts_is_no_less_than_at_any_point(which: tuple[str, str, str]) -> None:
    """Points of the ranges found by a climb, and others; a choice turns out as it does there."""
    at = cut_of(*which)
    most = at.run().shifts.max()
    assert 0 < at.peaks.most <= most
    dice = np.random.default_rng(5)
    low, high = at.box.lows[:, None], at.box.highs[:, None]
    points = at._at(low + (high - low) * dice.random((len(low), 200)))
    assert at._certain(points).max() <= most


def test_parts_that_are_lost_are_missed(monkeypatch: Any) -> None:
    """A cut that forgets one of its halves leaves a bound below that at points."""
    halved, which = Cutting._halved, ("wheel_pendulum", "state_rate", "theta_dot_rate")
    whole = cut_of(*which)
    assert whole.peaks.most <= whole.run().shifts.max()
    monkeypatch.setattr(Cutting, "_halved", lambda at, parts: first_half(halved(at, parts)))
    at = cut_of(*which)
    assert at.peaks.most > at.run().shifts.max(initial=0.0)


def first_half(parts: Cells) -> Cells:
    """Return the first half of some parts."""
    return parts.of(np.arange(parts.shifts.shape[1] // 2))


def test_what_is_seen_keeps_to_lengths_that_bounds_assume() -> None:
    """A quaternion as long as its components' ranges let it be would be off by more."""
    library = library_of("attitude")
    (bound, _) = bounds_of(library, library["quaternion_to_matrix"], QUICK)
    assert bound.proved is not None
    assert bound.seen <= bound.proved <= 2 * bound.seen
    each = np.array([[3.0, 0.9996, 0.1], [4.0, 0.0, 0.0]])
    size = np.hypot(*of_about_unit_length(each))
    assert np.all((size**2 > UNIT[0]) & (size**2 < UNIT[1]))
    assert size[1] == pytest.approx(0.9996, abs=1e-12)


def test_twice_a_number_is_exact() -> None:
    """Its sum with itself, as steps have it: no rounding of its own, and none passed on."""
    at = cut_of("attitude", "quaternion_to_matrix", "matrix")
    steps, exact = at.traits.trace.steps, at.traits.exact
    twice = [n for n, s in enumerate(steps) if s.operator == "add" and len({*s.operands}) == 1]
    assert twice
    assert all(exact[n] for n in twice)
    sums = [n for n, s in enumerate(steps) if s.operator == "add" and n not in twice]
    assert not any(exact[n] for n in sums)


@pytest.mark.long
def test_what_most_of_a_box_has_no_bound_of_is_not_cut_to_the_end(monkeypatch: Any) -> None:
    """The mass matrix of two links is never singular, but ranges do not tell that."""
    at = cut_of("acrobot", "state_rate", "q_1_dot_rate")
    assert not np.isfinite(at.run().shifts.max())
    monkeypatch.setattr(cut, "HOPE", 1.0)
    whole = cut_of("acrobot", "state_rate", "q_1_dot_rate")
    whole.run()
    assert 3 * at.spent < whole.spent
