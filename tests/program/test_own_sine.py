"""Sine and cosine of floats are as close as is stated, also next to quarter turns, at any angle."""

from collections.abc import Callable
from fractions import Fraction
from itertools import zip_longest
from math import factorial
from typing import Any

import numpy as np
import pytest
from flint import arb, ctx

from derive.program import own_sine
from derive.program.arithmetic import extended, working
from derive.program.own_sine import FITTED, parts_of_quarter, sine_and_cosine
from derive.program.pair_sine import PI
from derive.program.pairs import MANTISSA

CLOSE = 0.79
"""Units in the last place: of all floats from 1e-4 to 804 the worst sine is off by 0.7833 of one,
the worst cosine by 0.7795."""
FITS = {24: (27.9, 32.9), 53: (57.8, 63.8)}
EIGHTH = 0.7855
"""Of a turn, in rad, with room for the rounding of the number of quarters."""
TYPES = (np.float32, np.float64)


def angles(dtype: type) -> Any:
    """Return angles of all sizes that are served, and floats next to quarter and eighth turns."""
    dice, most = np.random.default_rng(13), FITTED[MANTISSA[dtype]].largest
    eighths = (np.arange(1, 2 * int(most / 1.5708)) * (np.pi / 4)).astype(dtype)
    beside = [np.nextafter(eighths, dtype(side)) for side in (0, np.inf)]
    sizes = np.exp(dice.uniform(np.log(1e-12), np.log(most), 10_000))
    plain = dice.uniform(-4, 4, 10_000)
    wide = dice.uniform(-most, most, 10_000)
    every = np.concatenate([eighths, *beside, sizes, -sizes, plain, wide]).astype(dtype)
    return every[np.abs(every) <= most]


def worst(dtype: type, made: Callable[[Any], tuple[Any, Any]]) -> float:
    """Return the largest error in units in the last place, against pairs of doubles."""
    given = angles(dtype)
    wide, most = given.astype(np.float64), 0.0
    for name, found in zip(("sin", "cos"), made(given), strict=True):
        high, low = extended(np.float64)[name]((wide, wide * 0))
        unit = 2.0 ** (np.frexp(high)[1] - MANTISSA[dtype])
        most = max(most, float(np.max(np.abs((found.astype(np.float64) - high) - low) / unit)))
    return most


@pytest.mark.parametrize("dtype", TYPES)
def test_every_angle_has_its_sine_within_what_is_stated(dtype: type) -> None:
    assert 0.7 < worst(dtype, lambda x: sine_and_cosine(x, dtype)) < CLOSE


@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize("place", [0, 1, 2, 3, 4])
def test_a_constant_that_is_a_little_off_is_noticed(
    dtype: type, place: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = own_sine._constants(dtype)
    changed = [list(x) if isinstance(x, list) else x for x in own]
    if place == 0:
        changed[2][-1] = dtype(0)  # the last part of a quarter turn
    elif place == 1:
        changed[2][0] = np.nextafter(changed[2][0], dtype(0))
    elif place == 4:
        changed[1] = dtype(2 * changed[1])  # the rounder
    else:
        changed[place + 1][-1] *= dtype(1.00001)
    monkeypatch.setattr(own_sine, "_constants", lambda _: tuple(changed))
    assert worst(dtype, lambda x: sine_and_cosine(x, dtype)) > 2 * CLOSE


@pytest.mark.parametrize("bits", FITTED)
def test_parts_times_quarters_are_exact_and_make_a_quarter_turn(bits: int) -> None:
    parts, count = parts_of_quarter(bits), FITTED[bits].count
    assert FITTED[bits].largest * 2 / PI < 2**count + Fraction(1, 2)
    for part in parts[:-1]:
        assert part.numerator.bit_length() + count <= bits
    left = abs(sum(parts) - PI / 2)
    assert left < Fraction(1, 2 ** ((len(parts) - 1) * (bits - count) + bits - 2))


@pytest.mark.parametrize("bits", FITTED)
def test_polynomials_are_as_close_as_is_said_everywhere(bits: int) -> None:
    own, cells, terms = FITTED[bits], 12_000, 12
    for fit, first, said in zip((own.sine, own.cosine), (3, 4), FITS[bits], strict=True):
        with ctx.workprec(200):
            true = [Fraction((-1) ** (n + first), factorial(2 * n + first)) for n in range(terms)]
            gaps = [a - b for a, b in zip_longest(true, fit, fillvalue=Fraction(0))]
            wrong = [arb(0)] * (first // 2) + [arb(g.numerator) / g.denominator for g in gaps]
            slope = [n * g for n, g in enumerate(wrong)][1:]
            for k in range(cells):
                z = (arb(EIGHTH) * (arb(k) + arb(0.5, 0.5)) / cells) ** 2
                most = abs(_sum(wrong, arb(z.mid()))) + z.rad() * abs(_sum(slope, z))
                assert most / (1 - z / (6 if first == 3 else 2)) < arb(2) ** arb(-said)


def _sum(coefficients: list[arb], z: arb) -> arb:
    total = arb(0)
    for c in reversed(coefficients):
        total = total * z + c
    return total


@pytest.mark.parametrize("dtype", TYPES)
def test_larger_angles_are_rounded_correctly_and_no_angle_has_no_sine(dtype: type) -> None:
    given = np.array([1e4, 3e4, -1e9, 1e22, np.nan, np.inf], dtype)
    with ctx.workprec(300):
        true = [dtype(float(arb(float(x)).sin())) for x in given[:4]]
    with np.errstate(invalid="ignore"):
        found = working(dtype)["sin"](given)
    assert found[:4].tolist() == [float(x) for x in true]
    assert np.isnan(found[4:]).all()


@pytest.mark.parametrize("dtype", TYPES)
def test_a_small_angle_is_its_sine_with_its_sign(dtype: type) -> None:
    tiny = np.finfo(dtype).smallest_subnormal
    given = np.array([0.0, -0.0, tiny, -tiny, 1e-30], dtype)
    sine, cosine = sine_and_cosine(given, dtype)
    assert sine.tobytes() == given.tobytes()
    assert cosine.tolist() == [1.0] * 5
