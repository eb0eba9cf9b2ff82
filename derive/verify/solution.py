"""The lecture's equations solved as they stand, in any arithmetic: values, scales, slopes.

The equations of a ``Problem`` are multiplied out and solved block by block; slopes follow term by
term. Nothing is shared with how programs are arranged, lowered or differentiated. Beside every
value stands its scale: the largest product in the equation that it solves, or itself where it is
larger, the measure of its rounding errors: no sensible order of operations rounds what is much
larger.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import reduce
from operator import add
from types import MappingProxyType
from typing import Any

from derive.scene.formula import Arithmetic
from derive.verify.equations import Block, Coefficient, Equations, Part, Sum
from derive.verify.operators import SLOPES
from derive.verify.valuation import Atom, raised, value

Slopes = dict[str, tuple[Any, Any]]
NO_SCALES: Mapping[str, Any] = MappingProxyType({})


@dataclass(frozen=True)
class Solved:
    """A value, its scale, and its slopes by column, each with its scale.

    gain : how far an error of what it is made of is magnified in it, at least 1
    """

    value: Any
    scale: Any
    slopes: Slopes
    gain: Any = 1.0


def solution(
    equations: Equations,
    given: Mapping[str, Any],
    columns: Iterable[str],
    arithmetic: Arithmetic,
    scales: Mapping[str, Any] = NO_SCALES,
) -> dict[str, Solved]:
    """Return every unknown by its component's name, with its slopes by the ``columns``.

    scales : of what is given and was itself the sum of larger terms
    """
    known = _given(equations, given, set(columns), arithmetic, scales)
    _apply(equations, known, arithmetic)
    fixed = {place: known[place].value for place in equations.fixed}
    coefficients = [_coefficient(c, fixed, arithmetic) for c in equations.coefficients]
    found: dict[str, Solved] = {}
    for block in equations.blocks:
        matrix = _matrix(block, known, coefficients, arithmetic)
        right = [_summed(s, known, coefficients, arithmetic) for s in block.right]
        for atom, solved in zip(block.unknowns, _solved(matrix, right, arithmetic), strict=True):
            known[atom] = found[equations.names[atom]] = solved
        _apply(equations, known, arithmetic)
    return found


def _coefficient(
    polynomial: Coefficient, fixed: Mapping[int, Any], arithmetic: Arithmetic
) -> tuple[Any, Any]:
    """Return a sum of products of parameters, and its size: that of the largest product."""
    products = [value((term,), fixed, arithmetic) for term in polynomial]
    return reduce(add, products), arithmetic["coefficient"](products)


def _given(
    equations: Equations,
    given: Mapping[str, Any],
    columns: set[str],
    arithmetic: Arithmetic,
    scales: Mapping[str, Any],
) -> dict[int, Solved]:
    known: dict[int, Solved] = {}
    one = arithmetic["number"](Fraction(1))
    for place, name in equations.names.items():
        if name in given:
            slopes: Slopes = {name: (one, 1.0)} if name in columns else {}
            size = scales[name] if name in scales else arithmetic["size"](given[name])
            known[place] = Solved(given[name], size, slopes)
    return known


def _apply(equations: Equations, known: dict[int, Solved], arithmetic: Arithmetic) -> None:
    """Add the functions that are made of what is known by now."""
    for place, made_of in equations.functions.items():
        if place not in known and made_of <= known.keys():
            known[place] = _applied(equations.atoms[place], known, arithmetic)


def _applied(atom: Atom, known: Mapping[int, Solved], arithmetic: Arithmetic) -> Solved:
    """Return a function of a polynomial, with its slopes by the chain rule."""
    number, size = arithmetic["number"], arithmetic["size"]
    if atom.kind == "pi":
        return Solved(arithmetic["pi"](), size(arithmetic["pi"]()), {})
    coefficients = [(number(c), size(number(c))) for _, c in atom.inner]
    parts = tuple(Part(n, monomial) for n, (monomial, _) in enumerate(atom.inner))
    inner = _summed(parts, known, coefficients, arithmetic)
    x = inner.value
    here = 1 / x if atom.kind == "inverse" else arithmetic[atom.kind](x)
    slope = -here * here if atom.kind == "inverse" else SLOPES[atom.kind](arithmetic, x, here)
    exact = len(atom.inner) == 1 and abs(atom.inner[0][1]) == 1 and len(atom.inner[0][0]) == 1
    error = 0.0 if exact else size(slope) * inner.scale
    slopes = {c: (slope * v, size(slope) * s) for c, (v, s) in inner.slopes.items()}
    return Solved(here, arithmetic["most"](size(here), error), slopes)


def _summed(
    parts: Sum,
    known: Mapping[int, Solved],
    coefficients: Sequence[tuple[Any, float]],
    arithmetic: Arithmetic,
) -> Solved:
    """Return a sum of terms with its largest product, and the same for every slope."""
    most, slopes = arithmetic["most"], Slopes()
    total, largest, gain = arithmetic["number"](Fraction(0)), 0.0, 1.0
    for part in parts:
        product, size = coefficients[part.coefficient]
        for atom, power in part.factors:
            factor = known[atom]
            product = product * raised(factor.value, power)
            size = size * _power_scale(factor, power, arithmetic)
        total, largest = total + product, most(largest, size)
        for place, (atom, _) in enumerate(part.factors):
            gain = most(gain, known[atom].gain * _partial(part, place, known, coefficients)[1])
        for place, (atom, _) in enumerate(part.factors):
            if known[atom].slopes:
                partial = _partial(part, place, known, coefficients)
                _add_slopes(slopes, known[atom].slopes, *partial, most)
    return Solved(*_at_least(total, largest, arithmetic), _all_at_least(slopes, arithmetic), gain)


def _at_least(value: Any, scale: Any, arithmetic: Arithmetic) -> tuple[Any, Any]:
    """Return a sum with its scale: its largest product, or itself where that is larger."""
    return value, arithmetic["most"](arithmetic["size"](value), scale)


def _all_at_least(slopes: Slopes, arithmetic: Arithmetic) -> Slopes:
    return {column: _at_least(*slope, arithmetic) for column, slope in slopes.items()}


def _power_scale(factor: Solved, power: int, arithmetic: Arithmetic) -> Any:
    """Return the size of a power; a quotient magnifies what its divisor has lost."""
    if power > 0:
        return raised(factor.scale, power)
    size = arithmetic["unless_zero"](arithmetic["size"](factor.value), factor.scale)
    return raised(size, power - 1) * factor.scale


def _partial(
    part: Part, place: int, known: Mapping[int, Solved], coefficients: Sequence[tuple[Any, float]]
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
    """Add ``product`` times the slopes ``more``; a slope's scale is its largest product."""
    for column, (slope, scale) in more.items():
        if column in slopes:
            before, largest = slopes[column]
            slopes[column] = before + product * slope, most(largest, size * scale)
        else:
            slopes[column] = product * slope, size * scale


def _matrix(
    block: Block,
    known: Mapping[int, Solved],
    coefficients: Sequence[tuple[Any, Any]],
    arithmetic: Arithmetic,
) -> list[list[Solved]]:
    """Return the matrix of a block; one of parameters only is inverted once, and loses nothing."""
    rows = [[_summed(s, known, coefficients, arithmetic) for s in row] for row in block.matrix]
    if any(part.factors for row in block.matrix for entry in row for part in entry):
        return rows
    return [[replace(entry, scale=0.0) for entry in row] for row in rows]


def _solved(
    matrix: list[list[Solved]], right: list[Solved], arithmetic: Arithmetic
) -> list[Solved]:
    """Return the unknowns of a block and their slopes: A u' = b' - A' u."""
    inverse = arithmetic["inverse"]([[entry.value for entry in row] for row in matrix])
    solved = _through(matrix, inverse, [(r.value, r.scale) for r in right], arithmetic)
    loads = [_load(row, load, solved, arithmetic) for row, load in zip(matrix, right, strict=True)]
    columns = dict.fromkeys(c for load in loads for c in load)
    nothing = (right[0].value * 0, 0.0)
    slopes = {
        c: _through(matrix, inverse, [load.get(c, nothing) for load in loads], arithmetic)
        for c in columns
    }
    sizes = [[arithmetic["size"](entry) for entry in row] for row in inverse]
    most = arithmetic["most"]
    gains = [[size * r.gain for size, r in zip(row, right, strict=True)] for row in sizes]
    return [
        Solved(*solved[k], {c: slopes[c][k] for c in columns}, reduce(most, row, 1.0))
        for k, row in enumerate(gains)
    ]


def _load(
    row: Sequence[Solved], load: Solved, solved: Sequence[tuple[Any, Any]], arithmetic: Arithmetic
) -> Slopes:
    """Return the right side of a row's slopes, b' - A' u."""
    slopes = dict(load.slopes)
    for entry, (u, size) in zip(row, solved, strict=True):
        _add_slopes(slopes, entry.slopes, -u, size, arithmetic["most"])
    return _all_at_least(slopes, arithmetic)


def _through(
    matrix: Sequence[Sequence[Solved]],
    inverse: Sequence[Sequence[Any]],
    right: Sequence[tuple[Any, Any]],
    arithmetic: Arithmetic,
) -> list[tuple[Any, Any]]:
    """Return what a matrix makes of a right side, each with its largest product.

    That is the largest of any row, the solution put in, times what the inverse makes of the row.
    """
    most, size, order = arithmetic["most"], arithmetic["size"], range(len(right))
    values = [sum((r[k] * right[k][0] for k in order), right[0][0] * 0) for r in inverse]
    rows = [
        reduce(most, (e.scale * size(u) for e, u in zip(row, values, strict=True)), scale)
        for row, (_, scale) in zip(matrix, right, strict=True)
    ]
    sizes = [reduce(most, (size(r[k]) * rows[k] for k in order)) for r in inverse]
    return [_at_least(*solved, arithmetic) for solved in zip(values, sizes, strict=True)]
