"""What a scene's functions should return: the lecture's equations solved in balls of 300 bits."""

from collections.abc import Iterable, Mapping
from functools import reduce
from operator import add
from typing import Any

from flint import arb, arb_mat, ctx

from derive.scene.formula import Arithmetic
from derive.verify.equations import Equations
from derive.verify.operators import IN_BALLS
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


def reference(
    equations: Equations,
    given: Mapping[str, float],
    columns: Iterable[str],
    arithmetic: Arithmetic = BALLS,
) -> dict[str, Solved]:
    """Return every unknown as a ball far narrower than one rounding of its largest product.

    Raises NoValueError where the equations have no solution, or none that can be told.
    """
    wanted, bits = tuple(columns), BITS
    while bits <= MOST_BITS:
        with ctx.workprec(bits):
            try:
                balls = {name: arb(x) for name, x in given.items()}
                found = solution(equations, balls, wanted, arithmetic)
            except ZeroDivisionError:
                found = {}
            if found and all(_tight(known) for known in found.values()):
                return found
        bits *= 2
    raise NoValueError(f"the equations have no solution that {MOST_BITS} bits can tell")


def _tight(known: Solved) -> bool:
    pairs = [(known.value, known.scale), *known.slopes.values()]
    return all(_narrow(ball, scale) for ball, scale in pairs)


def _narrow(ball: Any, scale: float) -> bool:
    radius = ball.rad()
    return bool(radius < arb(scale) * arb(2) ** -SPARE_BITS or radius < arb(2) ** -NOTHING_BITS)
