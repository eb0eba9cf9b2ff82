"""Linear forms hold what is in boxes, and know that values hang together."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from flint import arb, ctx

from derive.program.precision import F32
from derive.verify.operators import Column
from derive.verify.proved import forms
from derive.verify.proved.forms import Affine, plain_form, side_form
from derive.verify.proved.ranges import Interval, half_unit
from derive.verify.proved.sphere import UNIT, forms_of_sides

BITS = 200
COUNT = 300
MADE: dict[str, tuple[Callable[..., Affine], Callable[..., Any]]] = {
    "sum": (lambda a, b, *_: forms.sum_of_forms(a, b), lambda x, y: x + y),
    "difference": (lambda a, b, *_: forms.difference_of_forms(a, b), lambda x, y: x - y),
    "product": (lambda a, b, *_: forms.product(a, b), lambda x, y: x * y),
    "square": (lambda a, *_: forms.square_form(a), lambda x, _: x * x),
    "quotient": (lambda a, b, _, of: forms.quotient_form(a, b, of), lambda x, y: x / y),
    "root": (lambda _, b, __, of: forms.root_form(b, of), lambda _, y: y.sqrt()),
    "sine": (lambda a, _, of, __: forms.wave_form(a, of, 0), lambda x, _: x.sin()),
    "cosine": (lambda a, _, of, __: forms.wave_form(a, of, 1), lambda x, _: x.cos()),
}
"""Each of a value that is any, and one that is above zero."""


def boxes(dice: np.random.Generator) -> tuple[Interval, Interval]:
    """Return ranges of two values, the second above zero, of all widths."""
    low = dice.uniform(-3, 3, COUNT), dice.uniform(0.1, 3, COUNT)
    wide = 2.0 ** dice.uniform(-20, 1, (2, COUNT))
    return (low[0], low[0] + wide[0]), (low[1], low[1] + wide[1])


def escapes(name: str) -> int:
    """Count the points of boxes at which a form does not hold the value."""
    dice, (made, exactly) = np.random.default_rng(len(name)), MADE[name]
    first, second = boxes(dice)
    a, b = side_form(first, 0, 2), side_form(second, 1, 2)
    found, out = made(a, b, first, second), 0
    for share in (0.0, 1.0, *dice.random((4, 2, COUNT))):
        at = np.broadcast_to(share, (2, COUNT))
        for n in range(COUNT):
            with ctx.workprec(BITS):
                x, y = (
                    arb(float(low[n])) + arb(float(p[n])) * (arb(float(high[n])) - float(low[n]))
                    for (low, high), p in zip((first, second), at, strict=True)
                )
                held = arb(float(found.middle[n]))
                for value, form, part in ((x, a, found.parts[0]), (y, b, found.parts[1])):
                    reach = float(form.spread[n])
                    held += arb(float(part[n])) * (value - float(form.middle[n])) / reach
                out += not bool(abs(exactly(x, y) - held) <= float(found.rest[n]))
    return out


@pytest.mark.parametrize("name", MADE)
def test_a_form_holds_what_is_in_its_boxes_and_with_half_its_rest_does_not(
    monkeypatch: Any, name: str
) -> None:
    assert escapes(name) == 0
    made, exactly = MADE[name]

    def halved(*given: Any) -> Affine:
        form = made(*given)
        return replace(form, rest=form.rest * (0.0 if name in ROUNDED else 0.5))

    monkeypatch.setitem(MADE, name, (halved, exactly))
    assert escapes(name) > 0


ROUNDED = ("sum", "difference")
"""What is linear, and but rounded."""


def test_what_is_the_same_falls_out() -> None:
    of = np.array([1.0]), np.array([2.0])
    x = side_form(of, 0, 1)
    assert forms.difference_of_forms(x, x).size[0] < 1e-12
    assert forms.difference_of_forms(plain_form(of, 1), plain_form(of, 1)).size[0] == pytest.approx(
        1.0
    )


@pytest.mark.parametrize("shell", [UNIT, (0.98, 1.01)])
def test_the_largest_component_of_a_quaternion_follows_from_the_others(
    shell: tuple[float, float],
) -> None:
    """At all points of a box whose length is right: wherever they lie."""
    dice, names = np.random.default_rng(1), ("w", "x", "y", "z")
    ends = {n: (np.array([low]), np.array([low + 0.1]))
            for n, low in zip(names, (0.77, -0.35, 0.3, -0.45), strict=True)}  # fmt: skip
    found = forms_of_sides(ends, [names], shell)
    assert np.any(found["w"].parts[1:] != 0)
    points = np.array([a + (b - a) * dice.random(4000) for a, b in ends.values()])
    square = (points**2).sum(axis=0)
    points = points[:, (square > shell[0]) & (square < shell[1])]
    assert points.shape[1] > 10
    reach = np.array([(b - a) / 2 for a, b in ends.values()])
    middle = np.array([(b + a) / 2 for a, b in ends.values()])
    symbols = (points - middle) / reach
    form = found["w"]
    off = np.abs(points[0] - form.middle - form.parts[:, 0] @ symbols)
    assert off.max() <= form.rest[0] < 0.05


def furthest_rounded(of: Callable[[Column, int, float], Column]) -> float:
    """Return the most that rounding takes, over what is stated of numbers so large."""
    dice = np.random.default_rng(2)
    most = np.ldexp(1.0, dice.integers(-3, 4, 4000)) * (
        1 + np.ldexp(1.0, -dice.integers(1, 30, 4000))
    )
    x = np.concatenate([most, most * dice.random(4000), most - most * 2.0**-26])
    off = np.abs(x.astype(np.float32).astype(float) - x)
    stated = np.tile(of(most, F32.bits, 1e-45), 3)
    return float((off / stated).max())


def test_rounding_moves_no_number_further_than_is_stated() -> None:
    assert 0.9 < furthest_rounded(half_unit) <= 1
    assert furthest_rounded(lambda most, bits, least: half_unit(most, bits, least) / 2) > 1
