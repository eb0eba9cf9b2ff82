"""Numbers of a scene: whether masses, lengths and inertias are possible on the declared ranges.

Formulas are evaluated in floating point at the middle of the ranges and at their ends; nothing
computed here leaves the module but a sentence.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import islice, product
from typing import cast

from mpmath import nstr

from derive.scene.declaration import Moving, Parameter, SceneError, Sextuple, Triple
from derive.scene.escape import at_place, brief
from derive.scene.formula import ZERO, Formula, in_floats, symbols
from derive.scene.machine import Entries

MOST_ENDS = 256
"""Enough for every combination of the ends of eight ranges."""
UNIT_LENGTH = 1e-9
"""How far the length of a unit vector may be from 1: nine digits typed by hand."""
ROUNDING = 1e-12
"""Slack of the triangle inequality, relative to the trace: a disc obeys it with equality."""

FractionMatrix = tuple[tuple[Fraction, ...], ...]
Valuation = Mapping[str, float]
Ranges = Mapping[str, tuple[float, float]]


def ends_of(entries: Iterable[Parameter | Moving]) -> Ranges:
    """Return the range of each entry, by its name."""
    return {entry.name: (float(entry.low), float(entry.high)) for entry in entries}


def middle(ranges: Ranges) -> Valuation:
    """Return the middle of every range."""
    return {name: (low + high) / 2 for name, (low, high) in ranges.items()}


def valuations(ranges: Ranges) -> Iterator[Valuation]:
    """Yield the middle of the ranges and combinations of their ends, at most MOST_ENDS."""
    yield middle(ranges)
    for values in islice(product(*map(dict.fromkeys, ranges.values())), MOST_ENDS):
        yield dict(zip(ranges, values, strict=True))


def valuations_of(parameters: Iterable[Parameter], formulas: Iterable[Formula]) -> list[Valuation]:
    """Return the points to try of the parameters that formulas are made of."""
    used = {name for formula in formulas for name in symbols(formula)}
    return [*valuations(ends_of(p for p in parameters if p.name in used))]


def value(formula: Formula, values: Valuation, label: str) -> float:
    """Return a formula's value, finite or refused."""
    exact = in_floats(formula, values)
    found = float(exact)
    if not math.isfinite(found):
        large = f"is {nstr(exact, 3)}, beyond what a double holds,"
        rule = "has no value that a double holds" if math.isnan(found) else large
        raise SceneError(f"{label} = '{brief(formula)}' {rule}{where(values, (formula,))}")
    return found


def positive(formula: Formula, label: str, parameters: tuple[Parameter, ...]) -> Formula:
    """Return a formula that is positive in the middle and at the ends of the ranges."""
    for values in valuations_of(parameters, [formula]):
        found = value(formula, values, label)
        if found <= 0:
            raise SceneError(f"{label} must be positive, not {found:g}{where(values, (formula,))}")
    return formula


def where(values: Valuation, formulas: Iterable[Formula]) -> str:
    """Return the parameter values behind a number, as an error shows them."""
    used = dict.fromkeys(name for formula in formulas for name in symbols(formula))
    return at_place({name: values[name] for name in used if name in values})


def inertia_matrix(inertia: Sextuple, values: Valuation, label: str) -> FractionMatrix:
    """Return the inertia tensor at given parameters; its products enter with a minus sign."""
    xx, yy, zz, xy, xz, yz = (Fraction(value(part, values, label)) for part in inertia)
    return (xx, -xy, -xz), (-xy, yy, -yz), (-xz, -yz, zz)


def definite(matrix: FractionMatrix) -> bool:
    """Return whether a symmetric matrix is positive definite: its leading minors are positive."""
    (a, d, _), (_, b, _), _ = matrix
    return a > 0 and a * b > d * d and _determinant(matrix) > 0


def _determinant(matrix: FractionMatrix) -> Fraction:
    (a, d, e), (_, b, f), (_, _, c) = matrix
    return a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)


def triangle(matrix: FractionMatrix) -> bool:
    """Return whether masses can have this inertia: the tensor of second moments is semi-definite.

    Along principal axes this is the triangle inequality of the three moments.
    """
    return semidefinite(second_moments(matrix), abs(trace(matrix)))


def second_moments(matrix: FractionMatrix) -> FractionMatrix:
    """Return the tensor of second moments, half the trace on its diagonal less the inertia."""
    half = trace(matrix) / 2
    return tuple(tuple((half if i == j else 0) - matrix[i][j] for j in range(3)) for i in range(3))


def semidefinite(matrix: FractionMatrix, size: Fraction) -> bool:
    """Return whether no principal minor is negative, but for rounding beside ``size``."""
    slack = size * Fraction(ROUNDING)
    grown = tuple(
        tuple(matrix[i][j] + (slack if i == j else 0) for j in range(3)) for i in range(3)
    )
    pairs = ((0, 1), (0, 2), (1, 2))
    return (
        all(grown[i][i] >= 0 for i in range(3))
        and all(grown[i][i] * grown[j][j] >= grown[i][j] ** 2 for i, j in pairs)
        and _determinant(grown) >= 0
    )


def trace(matrix: FractionMatrix) -> Fraction:
    """Return the sum of the moments of inertia."""
    return matrix[0][0] + matrix[1][1] + matrix[2][2]


def first_wrong(
    says: str,
    each: Iterable[Valuation],
    formulas: Sequence[Formula],
    wrong: Callable[[Valuation], bool],
) -> Iterator[str]:
    """Yield a sentence with the first values at which something is wrong, if there are any."""
    yield from islice((f"{says}{where(v, formulas)}" for v in each if wrong(v)), 1)


def tensor_doubts(
    label: str,
    inertia: Sextuple,
    parameters: tuple[Parameter, ...],
    possible: Callable[[FractionMatrix], bool],
) -> Iterator[str]:
    """Yield a sentence on the first inertia that is not definite, and one on the first triangle."""
    every = [(v, inertia_matrix(inertia, v, label)) for v in valuations_of(parameters, inertia)]
    indefinite = [v for v, matrix in every if not possible(matrix)]
    broken = [v for v, matrix in every if possible(matrix) and not triangle(matrix)]
    for values in indefinite[:1]:
        yield f"{label} is not positive definite{where(values, inertia)}"
    for values in broken[:1]:
        yield f"{label} breaks the triangle inequality{where(values, inertia)}"


def check_member(label: str, inertia: Entries, parameters: tuple[Parameter, ...]) -> None:
    """Refuse a machine's body with a negative moment about some axis, as far as it is known.

    A moment may vanish: rods and points are bodies of machines too.
    """
    values = middle(ends_of(parameters))
    found = [None if part is None else value(part, values, f"{label} inertia") for part in inertia]
    possible = all(x is None or x >= 0 for x in found[:3])
    if possible and None not in inertia:
        whole = cast("Sextuple", inertia)
        possible = _not_negative(inertia_matrix(whole, values, f"{label} inertia"))
    if not possible:
        raise SceneError(not_definite(f"{label} inertia", inertia, values))


def not_definite(label: str, inertia: Entries, values: Valuation) -> str:
    """Return the sentence on an inertia that no body has, with what was found at these values."""
    known = [part for part in inertia if part is not None]
    said = ["unknown" if p is None else f"{value(p, values, label):g}" for p in inertia]
    found = f"moments {', '.join(said[:3])} with products {', '.join(said[3:])}"
    return f"{label} must be positive definite, not {found}{where(values, known)}"


def _not_negative(matrix: FractionMatrix) -> bool:
    return semidefinite(matrix, abs(trace(matrix)))


def member_doubts(label: str, inertia: Entries, parameters: tuple[Parameter, ...]) -> Iterator[str]:
    """Yield a sentence on the first inertia of a machine's body that is indefinite, or no masses'.

    Nothing is said of one that is not known whole, and of a wheel with its axial moment alone: its
    carrier counts the others.
    """
    if None not in inertia and inertia[:3].count(ZERO) != 2:
        whole = cast("Sextuple", inertia)
        yield from tensor_doubts(f"{label} inertia", whole, parameters, _not_negative)


def check_unit(vector: Triple, label: str, values: Valuation) -> None:
    """Refuse a vector that is zero or not of unit length at these values."""
    found = math.hypot(*(value(part, values, label) for part in vector))
    if found == 0:
        raise SceneError(f"{label} is zero; it must be a unit vector")
    if abs(found - 1) > UNIT_LENGTH:
        rule = f"must be a unit vector, not of length {found:.10g}"
        raise SceneError(f"{label} {rule}{where(values, vector)}")
