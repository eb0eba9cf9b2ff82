"""What a scene's functions should return: the lecture's equations solved as they stand.

The equations of a ``Truth`` are multiplied out and solved block by block, in balls of 300 bits for
the reference and in exact fractions for proofs; slopes follow term by term. Nothing is shared with
how programs are arranged, lowered or differentiated. Beside every value stands its scale: the
largest term of the sum that it is, the measure of its rounding errors.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from types import MappingProxyType
from typing import Any

from flint import arb, arb_mat, ctx

from derive.equations import Equations, Part, Sum
from derive.valuation import Arithmetic, Atom, raised, value

BITS = 300
SPARE_BITS = 100  # a ball must be this much narrower than its largest term
MOST_BITS = 10_000
NOTHING_BITS = 1200  # less than 2^-1200 is below half of the smallest double

Slopes = dict[str, tuple[Any, Any]]
NO_SCALES: Mapping[str, Any] = MappingProxyType({})


@dataclass(frozen=True)
class Known:
    """A value, the size of its largest term, what it magnifies, and its slopes by column."""

    value: Any
    scale: Any
    slopes: Slopes
    gain: Any = 1.0


def solution(
    asked: Equations,
    given: Mapping[str, Any],
    columns: Iterable[str],
    arithmetic: Arithmetic,
    scales: Mapping[str, Any] = NO_SCALES,
) -> dict[str, Known]:
    """Return every unknown by its component's name, with its slopes by the ``columns``.

    scales : of what is given and was itself the sum of larger terms
    """
    known = _given(asked, given, set(columns), arithmetic, scales)
    _apply(asked, known, arithmetic)
    fixed = {place: known[place].value for place in asked.fixed}
    values = [value(c, fixed, arithmetic) for c in asked.coefficients]
    coefficients = [(v, arithmetic["size"](v)) for v in values]
    found: dict[str, Known] = {}
    for block in asked.blocks:
        matrix = [
            [_summed(s, known, coefficients, arithmetic) for s in row] for row in block.matrix
        ]
        right = [_summed(s, known, coefficients, arithmetic) for s in block.right]
        for atom, solved in zip(block.unknowns, _solved(matrix, right, arithmetic), strict=True):
            known[atom] = found[asked.names[atom]] = solved
        _apply(asked, known, arithmetic)
    return found


def _given(
    asked: Equations,
    given: Mapping[str, Any],
    columns: set[str],
    arithmetic: Arithmetic,
    scales: Mapping[str, Any],
) -> dict[int, Known]:
    known: dict[int, Known] = {}
    one = arithmetic["number"](Fraction(1))
    for place, name in asked.names.items():
        if name in given:
            slopes: Slopes = {name: (one, 1.0)} if name in columns else {}
            size = scales[name] if name in scales else arithmetic["size"](given[name])
            known[place] = Known(given[name], size, slopes)
    return known


def _apply(asked: Equations, known: dict[int, Known], arithmetic: Arithmetic) -> None:
    """Add the functions that are made of what is known by now."""
    for place, atom in enumerate(asked.atoms):
        made_of = {a for monomial, _ in atom.inner for a, _ in monomial}
        if place not in known and place not in asked.names and made_of <= known.keys():
            known[place] = _applied(atom, known, arithmetic)


def _applied(atom: Atom, known: Mapping[int, Known], arithmetic: Arithmetic) -> Known:
    """Return a function of a polynomial, with its slopes by the chain rule."""
    number, size = arithmetic["number"], arithmetic["size"]
    if atom.kind == "pi":
        return Known(arithmetic["pi"](), size(arithmetic["pi"]()), {})
    coefficients = [(number(c), size(number(c))) for _, c in atom.inner]
    parts = tuple(Part(n, monomial) for n, (monomial, _) in enumerate(atom.inner))
    inner = _summed(parts, known, coefficients, arithmetic)
    x = inner.value
    match atom.kind:
        case "sin":
            here, slope = arithmetic["sin"](x), arithmetic["cos"](x)
        case "cos":
            here, slope = arithmetic["cos"](x), -arithmetic["sin"](x)
        case "root":
            here = arithmetic["sqrt"](x)
            slope = 1 / (2 * here)
        case _:
            here = 1 / x
            slope = -here * here
    exact = len(atom.inner) == 1 and abs(atom.inner[0][1]) == 1 and len(atom.inner[0][0]) == 1
    error = 0.0 if exact else size(slope) * inner.scale
    slopes = {c: (slope * v, size(slope) * s) for c, (v, s) in inner.slopes.items()}
    return Known(here, arithmetic["most"](size(here), error), slopes)


def _summed(
    parts: Sum,
    known: Mapping[int, Known],
    coefficients: Sequence[tuple[Any, float]],
    arithmetic: Arithmetic,
) -> Known:
    """Return a sum of terms with its largest term, and the same for every slope."""
    most, slopes = arithmetic["most"], dict[str, tuple[Any, Any]]()
    total, largest = arithmetic["number"](Fraction(0)), 0.0
    for part in parts:
        product, size = coefficients[part.coefficient]
        for atom, power in part.factors:
            factor = known[atom]
            product = product * raised(factor.value, power)
            size = size * _power_scale(factor, power, arithmetic)
        total, largest = total + product, most(largest, size)
        for place, (atom, _) in enumerate(part.factors):
            if known[atom].slopes:
                partial = _partial(part, place, known, coefficients)
                _add_slopes(slopes, known[atom].slopes, *partial, most)
    return Known(total, largest, slopes)


def _power_scale(factor: Known, power: int, arithmetic: Arithmetic) -> Any:
    """Return the size of a power; a quotient magnifies what its divisor has lost."""
    if power > 0:
        return raised(factor.scale, power)
    size = arithmetic["unless_zero"](arithmetic["size"](factor.value), factor.scale)
    return raised(size, power - 1) * factor.scale


def _partial(
    part: Part, place: int, known: Mapping[int, Known], coefficients: Sequence[tuple[Any, float]]
) -> tuple[Any, float]:
    """Return a term's derivative by its factor at ``place``, and its size."""
    product, size = coefficients[part.coefficient]
    for other, (atom, power) in enumerate(part.factors):
        factor, left = known[atom], power - (other == place)
        if other == place and power != 1:
            product, size = product * power, size * abs(power)
        if left:
            product = product * raised(factor.value, left)
            size = size * raised(factor.scale, left)
    return product, size


def _add_slopes(
    slopes: Slopes, more: Slopes, product: Any, size: Any, most: Callable[[Any, Any], Any]
) -> None:
    """Add ``product`` times the slopes ``more``; a slope's scale is that of its largest term."""
    for column, (slope, scale) in more.items():
        if column in slopes:
            before, largest = slopes[column]
            slopes[column] = before + product * slope, most(largest, size * scale)
        else:
            slopes[column] = product * slope, size * scale


def _solved(matrix: list[list[Known]], right: list[Known], arithmetic: Arithmetic) -> list[Known]:
    """Return the unknowns of a block and their slopes: A u' = b' - A' u."""
    inverse = arithmetic["inverse"]([[entry.value for entry in row] for row in matrix])
    sizes = [[arithmetic["size"](entry) for entry in row] for row in inverse]
    order = range(len(right))
    values = [sum((r[k] * right[k].value for k in order), right[0].value * 0) for r in inverse]
    most = arithmetic["most"]
    scales = [reduce(most, (r[k] * right[k].scale for k in order)) for r in sizes]
    loads: list[Slopes] = []
    for row, load in zip(matrix, right, strict=True):
        slopes = dict(load.slopes)
        for entry, u, scale in zip(row, values, scales, strict=True):
            _add_slopes(slopes, entry.slopes, -u, scale, most)
        loads.append(slopes)
    found = []
    for place in order:
        slopes = {}
        for k in order:
            _add_slopes(slopes, loads[k], inverse[place][k], sizes[place][k], most)
        gain = reduce(most, sizes[place], 1.0)
        found.append(Known(values[place], scales[place], slopes, gain))
    return found


def _inverse(rows: list[list[Any]]) -> list[list[Any]]:
    if len(rows) == 1:
        return [[1 / rows[0][0]]]
    return [list(row) for row in arb_mat(rows).inv().tolist()]


BALLS: Arithmetic = {
    "number": lambda q: (
        arb(q.numerator) / q.denominator if q.denominator != 1 else arb(q.numerator)
    ),
    "sin": lambda x: x.sin(),
    "cos": lambda x: x.cos(),
    "sqrt": lambda x: x.sqrt(),
    "pi": lambda: arb.pi(),
    "inverse": _inverse,
    "size": lambda x: abs(float(x.mid())),
    "most": max,
    "unless_zero": lambda size, other: size or other,
}


class NoValueError(ArithmeticError):
    """Equations without a value at a point of the declared ranges; the sentence says why."""


def reference(
    asked: Equations, given: Mapping[str, float], columns: Iterable[str]
) -> dict[str, Known]:
    """Return every unknown as a ball far narrower than one rounding of its largest term.

    Raises NoValueError where the equations have no solution, or none that can be told.
    """
    wanted, bits = tuple(columns), BITS
    while bits <= MOST_BITS:
        with ctx.workprec(bits):
            try:
                balls = {name: arb(x) for name, x in given.items()}
                found = solution(asked, balls, wanted, BALLS)
            except ZeroDivisionError:
                found = {}
            if found and all(_tight(known) for known in found.values()):
                return found
        bits *= 2
    raise NoValueError(f"the equations have no solution that {MOST_BITS} bits can tell")


def _tight(known: Known) -> bool:
    pairs = [(known.value, known.scale), *known.slopes.values()]
    return all(_narrow(ball, scale) for ball, scale in pairs)


def _narrow(ball: Any, scale: float) -> bool:
    radius = ball.rad()
    return bool(radius < arb(scale) * arb(2) ** -SPARE_BITS or radius < arb(2) ** -NOTHING_BITS)
