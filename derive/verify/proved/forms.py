"""Linear forms: a middle, how far each side of a box moves a value from it, and a rest.

Ranges forget that values hang together: x - x is as wide as twice x. A form knows to the first
order what both are made of. Columns are boxes; each side's symbol is between -1 and 1; the rest
holds what is not linear, and what doubles round.
"""

from dataclasses import dataclass

import numpy as np

from derive.verify.operators import Column
from derive.verify.proved.ranges import Interval, greatest, inverse, outward, root_of, wave

LOST = 2.0**-48
"""More than doubles round in an operation on forms, as a part of the product of their sizes."""
LEAST = 1e-290
"""More than underflow leaves, of all that is added up."""


@dataclass(frozen=True)
class Affine:
    """Values, a column a box; ``parts`` by symbol, and how far all of these move it together."""

    middle: Column
    parts: Column
    swing: Column
    rest: Column

    @property
    def spread(self) -> Column:
        """Return how far the symbols and the rest move it at most."""
        return self.swing + self.rest

    @property
    def ends(self) -> Interval:
        """Return its range."""
        by = self.spread
        return outward(self.middle - by * (1 + LOST), self.middle + by * (1 + LOST))

    @property
    def size(self) -> Column:
        """Return the largest that it may be, without its sign."""
        return np.asarray(np.abs(self.middle) + self.spread)


def _formed(middle: Column, parts: Column, rest: Column) -> Affine:
    return Affine(middle, parts, np.add.reduce(np.abs(parts), axis=0), rest)


def plain_form(a: Interval, symbols: int) -> Affine:
    """Return a range, of which nothing is known but its ends."""
    parts, nothing = np.zeros((symbols, *a[0].shape)), np.zeros_like(a[0])
    if a[0] is a[1]:
        return Affine(a[0], parts, nothing, nothing)
    middle, rest = _around(a)
    return Affine(middle, parts, nothing, rest)


def _around(a: Interval) -> tuple[Column, Column]:
    """Return the middle of a range and how far its ends are from there."""
    middle = (a[0] + a[1]) / 2
    rest = np.maximum(a[1] - middle, middle - a[0])
    rest = rest + (np.abs(a[0]) + np.abs(a[1])) * LOST
    return middle, np.where(a[0] == a[1], 0.0, rest)


def side_form(a: Interval, symbol: int, symbols: int) -> Affine:
    """Return the side of a box, which has a symbol of its own."""
    made = plain_form(a, symbols)
    parts = made.parts.copy()
    parts[symbol] = made.rest
    return Affine(made.middle, parts, made.rest, made.swing)


def sum_of_forms(a: Affine, b: Affine) -> Affine:
    """Return a + b."""
    made = _formed(a.middle + b.middle, a.parts + b.parts, a.rest + b.rest)
    return widened_form(made, LOST * made.size)


def opposite(a: Affine) -> Affine:
    """Return -a."""
    return Affine(-a.middle, -a.parts, a.swing, a.rest)


def difference_of_forms(a: Affine, b: Affine) -> Affine:
    """Return a - b."""
    return sum_of_forms(a, opposite(b))


def product(a: Affine, b: Affine) -> Affine:
    """Return a b."""
    over = a.spread, b.spread
    far = np.abs(a.middle), np.abs(b.middle)
    sizes = far[0] + over[0], far[1] + over[1]
    rest = far[0] * b.rest + far[1] * a.rest + over[0] * over[1]
    parts = a.middle * b.parts + b.middle * a.parts
    lost = LOST * sizes[0] * sizes[1] + LEAST * ((sizes[0] > 0) & (sizes[1] > 0))
    return _formed(a.middle * b.middle, parts, rest + lost)


def square_form(a: Affine) -> Affine:
    """Return a^2: what is of the second order is not below zero."""
    over = a.spread
    half = over * over / 2
    rest = 2 * np.abs(a.middle) * a.rest + half + LOST * (np.abs(a.middle) + over) ** 2 + LEAST
    return _formed(a.middle * a.middle + half, 2 * a.middle * a.parts, rest)


def quotient_form(a: Affine, b: Affine, of: Interval) -> Affine:
    """Return a / b, b within a range too: the quotient of middles, and what is left over b."""
    share = np.where(b.middle != 0, a.middle / np.where(b.middle != 0, b.middle, 1.0), 0.0)
    whole = plain_form((share, share), len(a.parts))
    left = difference_of_forms(a, product(whole, b))
    return sum_of_forms(whole, product(left, inverse_form(b, of)))


def inverse_form(a: Affine, of: Interval) -> Affine:
    """Return 1/a, a within a range too; nothing is known of it if that may be zero."""
    low, high = of
    ends = inverse(of)
    with np.errstate(all="ignore"):
        slope = -1.0 / (low * high)
        middle = np.sign(low) * 2.0 / np.sqrt(low * high)
        over = 1.0 / low + 1.0 / high
    return _line(a, slope, middle, over, greatest(ends))


def root_form(a: Affine, of: Interval) -> Affine:
    """Return the root of a, a within a range too that is not below zero."""
    low, high = root_of(of)
    low, high = low * (1 - LOST), high * (1 + LOST)
    with np.errstate(all="ignore"):
        slope = 1.0 / (low + high)
        return _line(a, slope, (low + high) / 4, low * high * slope, high)


def wave_form(a: Affine, of: Interval, which: int) -> Affine:
    """Return sines (0) or cosines (1) of a, a within a range too."""
    middle = (of[0] + of[1]) / 2
    reach = np.maximum(of[1] - middle, middle - of[0])
    here = [wave((middle, middle), w) for w in (which, 1 - which)]
    slope = (here[1][0] + here[1][1]) / 2 * (-1.0 if which else 1.0)
    bent = greatest(wave(of, which)) * reach * reach / 2
    bent = bent + (here[0][1] - here[0][0]) / 2 + (here[1][1] - here[1][0]) / 2 * reach
    base = (here[0][0] + here[0][1]) / 2 - slope * middle
    return _line(a, slope, base - bent, base + bent, 1.0 + np.abs(middle) + reach)


def _line(a: Affine, slope: Column, first: Column, second: Column, size: Column) -> Affine:
    """Return a by a slope, plus anything between two numbers; ``size`` is of all that is met."""
    middle = (first + second) / 2
    rest = np.abs(second - first) / 2 + np.abs(slope) * a.rest
    over = size + np.abs(middle) + np.abs(slope) * a.size
    return _formed(slope * a.middle + middle, slope * a.parts, rest + LOST * over + LEAST)


def widened_form(a: Affine, by: Column | None) -> Affine:
    """Return a with so much more on either side."""
    return a if by is None else Affine(a.middle, a.parts, a.swing, a.rest + by)


def chosen_form(a: Affine, b: Affine, where: Column) -> Affine:
    """Return the first where something is true, elsewhere the second."""
    return Affine(
        np.where(where, a.middle, b.middle),
        np.where(where, a.parts, b.parts),
        np.where(where, a.swing, b.swing),
        np.where(where, a.rest, b.rest),
    )


def fitted_form(a: Affine, of: Interval) -> Affine:
    """Return a, or its range alone where that says more than all that a form leaves open."""
    half = (of[1] - of[0]) / 2
    fits = a.rest <= half
    if fits.all():
        return a
    middle, rest = _around(of)
    parts, swing = np.where(fits, a.parts, 0.0), np.where(fits, a.swing, 0.0)
    return Affine(np.where(fits, a.middle, middle), parts, swing, np.where(fits, a.rest, rest))
