"""Parameters at which formulas stand in given ratios: those next to given ones.

Newton's method in long floats, which round alike on every machine. Of the many solutions that
there may be, each step is the least change, relative to where the parameters began.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from flint import arb, arb_mat, ctx

from derive.program.added import added
from derive.scene.declaration import Parameter
from derive.scene.formula import ZERO, Formula, evaluate, symbols
from derive.verify.operators import LONG_FLOATS

BITS = 400
CHANGED = 2**-80
"""Relative change of a parameter that tells a slope: its square is left out."""
EASED = 2**-120
"""Of all the slopes: what is added where formulas say the same, or nothing."""
STIFF = 2**-16
"""How much more a relative change of the size weighs than one of a parameter."""
NOTHING = 2**-100
"""Of a parameter: what is left of it where it is to be 0, for ``EASED`` lets no step be exact."""
STEPS = 24
NEAR = 2**-40
"""Of the largest ratio: how far formulas may be from theirs, far less than any body needs."""

Ratio = tuple[Formula, float]


@dataclass(frozen=True)
class _Sought:
    """Formulas less their ratios times a size, as functions of the size and of parameters."""

    rows: Sequence[Ratio]
    fixed: Mapping[str, Any]
    names: Sequence[str]

    @cached_property
    def largest(self) -> float:
        """Return the largest ratio."""
        return max(abs(ratio) for _, ratio in self.rows)

    def gaps(self, at: Sequence[Any]) -> list[Any]:
        """Return how far each formula is off, from the size and the parameters."""
        values = {**self.fixed, **dict(zip(self.names, at[1:], strict=True))}
        return [evaluate(f, values, LONG_FLOATS) - at[0] * ratio for f, ratio in self.rows]

    def is_met(self, at: Sequence[Any]) -> bool:
        """Tell whether all formulas are as near to their ratios as need be."""
        most = abs(at[0]) * self.largest * NEAR
        return bool(at[0] > 0) and all(abs(gap) <= most for gap in self.gaps(at))

    def step(self, at: Sequence[Any], units: Sequence[Any]) -> list[Any]:
        """Return the size and the parameters after a step, the least one in these units."""
        slopes = list(self._slopes(at, units))
        square = [
            [_dotted(a, b) for b in zip(*slopes, strict=True)] for a in zip(*slopes, strict=True)
        ]
        ease = sum((row[k] for k, row in enumerate(square)), arb(0)) * EASED
        for k, row in enumerate(square):
            row[k] += ease
        right = arb_mat([[-gap] for gap in self.gaps(at)])
        solved = [x.mid() for x in arb_mat(square).solve(right).entries()]
        return [
            (x + unit * _dotted(row, solved)).mid()
            for x, unit, row in zip(at, units, slopes, strict=True)
        ]

    def _slopes(self, at: Sequence[Any], units: Sequence[Any]) -> Iterator[list[Any]]:
        """Yield the slopes of all gaps by the size and by each parameter, times its unit."""
        for k, unit in enumerate(units):
            ahead, behind = ([*at[:k], at[k] + s * unit * CHANGED, *at[k + 1 :]] for s in (1, -1))
            pairs = zip(self.gaps(ahead), self.gaps(behind), strict=True)
            yield [((one - other) / (2 * CHANGED)).mid() for one, other in pairs]


def _dotted(first: Sequence[Any], second: Sequence[Any]) -> Any:
    return sum((a * b for a, b in zip(first, second, strict=True)), arb(0)).mid()


def in_ratios(
    parameters: Sequence[Parameter], rows: Sequence[Ratio], start: Mapping[str, float]
) -> dict[str, Fraction] | None:
    """Return the parameters next to ``start`` at which formulas are in ratios, None if none are.

    rows : of formulas of the parameters, each with a number that it is in a common ratio to
    """
    if any(f == ZERO and ratio for f, ratio in rows):
        return None
    rows = [(f, ratio) for f, ratio in rows if f != ZERO]
    used = {name for f, _ in rows for name in symbols(f)}
    names = [p.name for p in parameters if p.value is None and p.name in used]
    with ctx.workprec(BITS):
        fixed = {p.name: LONG_FLOATS["number"](p.value) for p in parameters if p.value is not None}
        sought = _Sought(rows, fixed, names)
        at = [arb(1), *(arb(start[name]) for name in names)]
        size = sum(
            (abs(x + at[0] * r) for x, (_, r) in zip(sought.gaps(at), rows, strict=True)), arb(0)
        )
        at[0] = size.mid() / added(abs(r) for _, r in rows)
        units = [at[0] * STIFF, *(abs(x) for x in at[1:])]
        try:
            for _ in range(STEPS):
                if sought.is_met(at):
                    found = zip(names, at[1:], units[1:], strict=True)
                    return {n: _fraction(x, unit) for n, x, unit in found}
                at = sought.step(at, units)
        except ZeroDivisionError:
            return None
    return None


def _fraction(x: Any, unit: Any) -> Fraction:
    """Return a long float; what a step leaves of a parameter that it makes 0 is 0."""
    if abs(x) < unit * NOTHING:
        return Fraction(0)
    mantissa, exponent = x.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
