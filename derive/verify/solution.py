"""The lecture's equations solved as they stand, in any arithmetic: values, scales, slopes.

The equations of a ``Problem`` are multiplied out and solved block by block; slopes follow term by
term. Nothing is shared with how programs are arranged, lowered or differentiated. Beside every
value stands its scale: the largest product in the equation that it solves, or itself where it is
larger, the measure of its rounding errors: no sensible order of operations rounds what is much
larger.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial, reduce
from operator import add
from types import MappingProxyType
from typing import Any

from derive.scene.formula import Arithmetic
from derive.verify.equations import Block, Coefficient, Equations, Part, Sum
from derive.verify.operators import SLOPES
from derive.verify.valuation import Atom, raised, value

Slopes = dict[str, tuple[Any, Any]]
Square = Sequence[Sequence[Any]]
NO_SCALES: Mapping[str, Any] = MappingProxyType({})
ONE: Coefficient = (((), Fraction(1)),)


@dataclass(frozen=True)
class Solved:
    """A value, its scale, and its slopes by column, each with its scale."""

    value: Any
    scale: Any
    slopes: Slopes


@dataclass(frozen=True)
class SolvedEquations:
    """Equations solved: what each atom is by its place.

    coefficients : each with its size, None for one: nothing is multiplied by it
    inverses     : of the matrix of every block, the sizes of all entries
    """

    equations: Equations
    known: Mapping[int, Solved]
    coefficients: Sequence[tuple[Any, Any]]
    inverses: Sequence[Square]

    def unknowns(self) -> dict[str, Solved]:
        """Return every unknown by its component's name."""
        places = (atom for block in self.equations.blocks for atom in block.unknowns)
        return {self.equations.names[atom]: self.known[atom] for atom in places}


def solution(
    equations: Equations,
    given: Mapping[str, Any],
    columns: Iterable[str],
    arithmetic: Arithmetic,
    scales: Mapping[str, Any] = NO_SCALES,
) -> SolvedEquations:
    """Return every unknown of equations, with its slopes by the ``columns``.

    scales : of what is given and was itself the sum of larger terms
    """
    known = _given(equations, given, set(columns), arithmetic, scales)
    _apply(equations, known, arithmetic)
    fixed = {place: known[place].value for place in equations.fixed}
    coefficients = [_coefficient(c, fixed, arithmetic) for c in equations.coefficients]
    inverses: list[Square] = []
    for block, sign in zip(equations.blocks, equations.signs, strict=True):
        right = [_summed(s, known, coefficients, arithmetic) for s in block.right]
        if sign:
            inverse, found = _signed(sign, right[0])
        else:
            inverse, found = _solved(block, right, known, coefficients, arithmetic)
        inverses.append(inverse)
        known |= dict(zip(block.unknowns, found, strict=True))
        _apply(equations, known, arithmetic)
    return SolvedEquations(equations, known, coefficients, inverses)


def _coefficient(
    polynomial: Coefficient, fixed: Mapping[int, Any], arithmetic: Arithmetic
) -> tuple[Any, Any]:
    """Return a sum of products of parameters, and its size: that of the largest product."""
    if polynomial == ONE:
        return None, None
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
    coefficients = [(None, None) if c == 1 else (number(c), size(number(c))) for _, c in atom.inner]
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
    coefficients: Sequence[tuple[Any, Any]],
    arithmetic: Arithmetic,
) -> Solved:
    """Return a sum of terms with its largest product, and the same for every slope."""
    most, slopes = arithmetic["most"], Slopes()
    terms = [_term(part, known, coefficients, arithmetic) for part in parts]
    if not terms:
        return Solved(arithmetic["number"](Fraction(0)), 0.0, slopes)
    total, largest = reduce(add, (v for v, _ in terms)), reduce(most, (s for _, s in terms))
    for part in parts:
        for place, (atom, _) in enumerate(part.factors):
            if known[atom].slopes:
                partial = _partial(part, place, known, coefficients)
                _add_slopes(slopes, known[atom].slopes, *partial, most)
    return Solved(*_at_least(total, largest, arithmetic), _all_at_least(slopes, arithmetic))


def _term(
    part: Part,
    known: Mapping[int, Solved],
    coefficients: Sequence[tuple[Any, Any]],
    arithmetic: Arithmetic,
) -> tuple[Any, Any]:
    """Return a term and its size."""
    product, size = coefficients[part.coefficient]
    for atom, power in part.factors:
        factor = known[atom]
        product = times(product, raised(factor.value, power))
        size = times(size, _power_scale(factor, power, arithmetic))
    return (arithmetic["number"](Fraction(1)), 1.0) if product is None else (product, size)


def times(one: Any, other: Any) -> Any:
    """Return a product; None is one."""
    return other if one is None else one * other


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
    part: Part, place: int, known: Mapping[int, Solved], coefficients: Sequence[tuple[Any, Any]]
) -> tuple[Any, Any]:
    """Return a term's derivative by its factor at ``place``, and its size."""
    product, size = coefficients[part.coefficient]
    for atom, count, left in differentiated(part, place):
        factor = known[atom]
        if count != 1:
            product, size = times(product, count), times(size, float(abs(count)))
        if left:
            product = times(product, raised(factor.value, left))
            size = times(size, raised(factor.scale, left))
    return product, size


def differentiated(part: Part, place: int) -> Iterator[tuple[int, int, int]]:
    """Yield of a term's derivative each atom, what it is multiplied by, and the power left."""
    for other, (atom, power) in enumerate(part.factors):
        yield (atom, power, power - 1) if other == place else (atom, 1, power)


def _add_slopes(
    slopes: Slopes, more: Slopes, product: Any, size: Any, most: Callable[[Any, Any], Any]
) -> None:
    """Add ``product`` times the slopes ``more``; a slope's scale is its largest product."""
    for column, (slope, scale) in more.items():
        own, its = times(product, slope), times(size, scale)
        if column in slopes:
            before, largest = slopes[column]
            slopes[column] = before + own, most(largest, its)
        else:
            slopes[column] = own, its


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


def _signed(sign: int, right: Solved) -> tuple[Square, list[Solved]]:
    """Return the size of a matrix of 1 or -1 inverted, and the unknown that it stands before."""
    if sign > 0:
        return ((1.0,),), [right]
    slopes = {c: (-value, scale) for c, (value, scale) in right.slopes.items()}
    return ((1.0,),), [Solved(-right.value, right.scale, slopes)]


def _solved(
    block: Block,
    right: list[Solved],
    known: Mapping[int, Solved],
    coefficients: Sequence[tuple[Any, Any]],
    arithmetic: Arithmetic,
) -> tuple[Square, list[Solved]]:
    """Return the sizes of a block's inverse, its unknowns and their slopes: A u' = b' - A' u."""
    matrix = _matrix(block, known, coefficients, arithmetic)
    inverse = arithmetic["inverse"]([[entry.value for entry in row] for row in matrix])
    sizes = [[arithmetic["size"](entry) for entry in row] for row in inverse]
    through = partial(_through, matrix, inverse, sizes, arithmetic)
    solved = through([(r.value, r.scale) for r in right])
    loads = [_load(row, load, solved, arithmetic) for row, load in zip(matrix, right, strict=True)]
    columns = dict.fromkeys(c for load in loads for c in load)
    nothing = (right[0].value * 0, 0.0)
    slopes = {c: through([load.get(c, nothing) for load in loads]) for c in columns}
    each = [Solved(*own, {c: slopes[c][k] for c in columns}) for k, own in enumerate(solved)]
    return sizes, each


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
    inverse: Square,
    inverse_sizes: Square,
    arithmetic: Arithmetic,
    right: Sequence[tuple[Any, Any]],
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
    sizes = [reduce(most, (r[k] * rows[k] for k in order)) for r in inverse_sizes]
    return [_at_least(*solved, arithmetic) for solved in zip(values, sizes, strict=True)]
