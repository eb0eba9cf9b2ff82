"""What a scene's functions should return: the lecture's equations solved in balls of 300 bits."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial, reduce
from operator import add
from typing import Any

import numpy as np
from flint import arb, arb_mat, ctx

from derive.scene.formula import Arithmetic
from derive.verify.equations import Equations
from derive.verify.gains import gains
from derive.verify.operators import IN_BALLS, Column
from derive.verify.solution import Solved, solution

BITS = 300
SPARE_BITS = 100  # a ball must be this much narrower than its largest product
MOST_BITS = 10_000
NOTHING_BITS = 1200  # less than 2^-1200 is below half of the smallest double


def _inverse(rows: list[list[Any]]) -> list[list[Any]]:
    if len(rows) == 1:
        return [[1 / rows[0][0]]]
    return [list(row) for row in arb_mat(rows).inv().tolist()]


BALLS: Arithmetic = {
    **IN_BALLS,
    "inverse": _inverse,
    "size": lambda x: abs(float(x.mid())),
    "coefficient": lambda products: max(abs(float(x.mid())) for x in products),
    "most": max,
    "unless_zero": lambda size, other: size or other,
}
DIFFERENCES: Arithmetic = {
    **BALLS,
    "coefficient": lambda products: abs(float(reduce(add, products).mid())),
}
"""Balls, with (I_yy - I_zz) omega_y omega_z one product: a scale for bodies near a sphere."""


class NoValueError(ArithmeticError):
    """Equations without a value at a point of the declared ranges; the sentence says why."""


@dataclass(frozen=True)
class References:
    """Unknowns at many samples, by name, in columns, and how far each magnifies errors."""

    known: Mapping[str, Solved]
    gains: Mapping[str, Column]

    def put(self, where: Column, other: "References") -> None:
        """Take in the unknowns at some of the samples."""
        for name, own in self.known.items():
            new = other.known[name]
            own.value[where], own.scale[where] = new.value, new.scale
            self.gains[name][where] = other.gains[name]
            for column, (slope, scale) in own.slopes.items():
                slope[where], scale[where] = new.slopes[column]


def reference(
    equations: Equations,
    given: Mapping[str, float],
    columns: Iterable[str],
    arithmetic: Arithmetic = BALLS,
) -> dict[str, Solved]:
    """Return every unknown as a ball far narrower than one rounding of its largest product.

    Raises NoValueError where the equations have no solution, or none that can be told.
    """
    found = references(equations, [given], columns, arithmetic).known
    return {
        name: Solved(at.value[0], at.scale[0], {c: (v[0], s[0]) for c, (v, s) in at.slopes.items()})
        for name, at in found.items()
    }


def references(
    equations: Equations,
    each: Sequence[Mapping[str, float]],
    columns: Iterable[str],
    arithmetic: Arithmetic = BALLS,
) -> References:
    """Return the same at many samples, which are solved together."""
    wanted, by = tuple(columns), in_columns(arithmetic)
    found, left, bits = References({}, {}), np.arange(len(each)), BITS
    while bits <= MOST_BITS and len(left):
        with ctx.workprec(bits), np.errstate(all="ignore"):
            own = _at_samples(equations, [each[n] for n in left.tolist()], wanted, by)
            tight = reduce(np.logical_and, map(_tight, own.known.values()))
        if bits == BITS:
            found = own
        else:
            found.put(left, own)
        left, bits = left[~tight], bits * 2
    if len(left):
        raise NoValueError(f"the equations have no solution that {MOST_BITS} bits can tell")
    return found


def _at_samples(
    equations: Equations, each: Sequence[Mapping[str, float]], wanted: Iterable[str], by: Arithmetic
) -> References:
    """Return the unknowns at samples with the digits that are set."""
    given = {c: np.array([arb(at[c]) for at in each], object) for c in each[0]}
    solved = solution(equations, given, wanted, by)
    known = {
        name: Solved(
            *_filled(own.value, own.scale, len(each)),
            {c: _filled(*slope, len(each)) for c, slope in own.slopes.items()},
        )
        for name, own in solved.unknowns().items()
    }
    gained = gains(solved, by, lambda size: (size, size))
    return References(known, {n: _column(g, float, len(each)) for n, g in gained.items()})


def _filled(value: Any, scale: Any, count: int) -> tuple[Column, Column]:
    return _column(value, object, count), _column(scale, float, count)


def _column(x: Any, dtype: type, count: int) -> Column:
    return np.array(np.broadcast_to(np.asarray(x, dtype), (count,)))


def in_columns(arithmetic: Arithmetic) -> Arithmetic:
    """Return an arithmetic of balls for columns of them, sizes in columns of doubles."""

    def sized(operation: Callable[..., Any]) -> Callable[..., Any]:
        return lambda *given: np.asarray(_each(operation)(*given), float)

    own = {name: _each(arithmetic[name]) for name in IN_BALLS if name != "number"}
    return {
        **arithmetic,
        **own,
        "inverse": partial(_inverses, arithmetic["inverse"]),
        "size": sized(arithmetic["size"]),
        "coefficient": lambda several: sized(lambda *x: arithmetic["coefficient"](x))(*several),
        "most": np.maximum,
        "unless_zero": lambda size, other: np.where(size == 0, other, size),
    }


def _each(operation: Callable[..., Any]) -> Callable[..., Any]:
    """Return an operation on numbers for columns of them, or of some of them."""
    return lambda *given: np.frompyfunc(operation, len(given), 1)(*given)


def _inverses(inverse: Callable[..., Any], rows: list[list[Any]]) -> list[list[Any]]:
    """Return the inverses of matrices, entry by entry, no numbers where there is none."""
    if len(rows) == 1:
        return [[1 / rows[0][0]]]
    order, flat = len(rows), np.broadcast_arrays(*(x for row in rows for x in row))
    found = np.full((order, order, *flat[0].shape), arb("nan"), object)
    for place in np.ndindex(flat[0].shape):
        own = [x[place] for x in flat]
        with suppress(ZeroDivisionError):
            found[(..., *place)] = inverse([own[k : k + order] for k in range(0, len(own), order)])
    return [list(row) for row in found]


def _tight(known: Solved) -> Column:
    """Tell at which samples a value and its slopes are narrow enough."""
    pairs = [(known.value, known.scale), *known.slopes.values()]
    return reduce(np.logical_and, (_each(_narrow)(*pair).astype(bool) for pair in pairs))


def _narrow(ball: Any, scale: float) -> bool:
    radius = ball.rad()
    return bool(radius < arb(scale) * arb(2) ** -SPARE_BITS or radius < arb(2) ** -NOTHING_BITS)
