"""Numbers of a scene: whether masses, lengths and inertias are possible on the declared ranges.

Formulas are evaluated in floating point at the middle of the ranges and at their ends; nothing
computed here leaves the module but a sentence.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from itertools import islice, product
from typing import cast

from derive.scene.declaration import Body, Moving, Parameter, SceneError, Sextuple, Triple, Wheel
from derive.scene.escape import at_place, brief
from derive.scene.formula import FLOATS, ONE, ZERO, Formula, evaluate, symbols
from derive.scene.machine import Entries
from derive.scene.shape import moved

MOST_ENDS = 256
"""Enough for every combination of the ends of eight ranges."""
UNIT_LENGTH = 1e-9
"""How far the length of a unit vector may be from 1: nine digits typed by hand."""
ROUNDING = 1e-12
"""Slack of the triangle inequality, relative to the trace: a disc obeys it with equality."""

Matrix = tuple[tuple[Fraction, ...], ...]


def middle(parameters: Iterable[Parameter | Moving]) -> Mapping[str, float]:
    """Return the middle of every range."""
    return {entry.name: float((entry.low + entry.high) / 2) for entry in parameters}


def ends(parameters: Iterable[Parameter], used: Iterable[str]) -> Iterator[Mapping[str, float]]:
    """Yield combinations of the ends of the ranges of the parameters in use, at most MOST_ENDS."""
    names = set(used)
    involved = [entry for entry in parameters if entry.name in names]
    choices = [dict.fromkeys((float(entry.low), float(entry.high))) for entry in involved]
    for values in islice(product(*choices), MOST_ENDS):
        yield dict(zip((entry.name for entry in involved), values, strict=True))


def value(formula: Formula, values: Mapping[str, float], label: str) -> float:
    """Return a formula's value, finite or refused."""
    try:
        found = float(evaluate(formula, values, FLOATS))
    except (ArithmeticError, ValueError):
        found = math.nan
    if not math.isfinite(found):
        raise SceneError(f"{label} = '{brief(formula)}' has no value{_where(values, (formula,))}")
    return found


def positive(formula: Formula, label: str, parameters: tuple[Parameter, ...]) -> Formula:
    """Return a formula that is positive in the middle and at the ends of the ranges."""
    used = symbols(formula)
    for values in (middle(parameters), *ends(parameters, used)):
        found = value(formula, values, label)
        if found <= 0:
            raise SceneError(f"{label} must be positive, not {found:g}{_where(values, (formula,))}")
    return formula


def _where(values: Mapping[str, float], formulas: Iterable[Formula]) -> str:
    """Return the parameter values behind a number, as an error shows them."""
    used = dict.fromkeys(name for formula in formulas for name in symbols(formula))
    return at_place({name: values[name] for name in used if name in values})


def tensor(inertia: Sextuple, values: Mapping[str, float], label: str) -> Matrix:
    """Return the inertia tensor at given parameters; its products enter with a minus sign."""
    xx, yy, zz, xy, xz, yz = (Fraction(value(part, values, label)) for part in inertia)
    return (xx, -xy, -xz), (-xy, yy, -yz), (-xz, -yz, zz)


def definite(matrix: Matrix) -> bool:
    """Return whether a symmetric matrix is positive definite: its leading minors are positive."""
    (a, d, _), (_, b, _), _ = matrix
    return a > 0 and a * b > d * d and _determinant(matrix) > 0


def _determinant(matrix: Matrix) -> Fraction:
    (a, d, e), (_, b, f), (_, _, c) = matrix
    return a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)


def triangle(matrix: Matrix) -> bool:
    """Return whether masses can have this inertia: the tensor of second moments is semi-definite.

    Along principal axes this is the triangle inequality of the three moments.
    """
    return semidefinite(_second_moments(matrix), abs(_trace(matrix)))


def _second_moments(matrix: Matrix) -> Matrix:
    half = _trace(matrix) / 2
    return tuple(tuple((half if i == j else 0) - matrix[i][j] for j in range(3)) for i in range(3))


def semidefinite(matrix: Matrix, size: Fraction) -> bool:
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


def _not_negative(matrix: Matrix) -> bool:
    return semidefinite(matrix, abs(_trace(matrix)))


def _trace(matrix: Matrix) -> Fraction:
    return matrix[0][0] + matrix[1][1] + matrix[2][2]


def check_inertia(body: Body, parameters: tuple[Parameter, ...]) -> None:
    """Refuse an inertia that is not positive definite at the middle of the ranges.

    Of a thin rod only the transverse moment must be positive.
    """
    values = middle(parameters)
    if not _possible(body, tensor(body.inertia, values, "body inertia")):
        where = _where(values, body.inertia)
        raise SceneError(f"body inertia is not positive definite{where}")


def _possible(body: Body, matrix: Matrix) -> bool:
    if body.kind != "rod":
        return definite(matrix)
    return all(matrix[i][i] > 0 for i in range(3) if "xyz"[i] != body.axis)


def doubts(body: Body, parameters: tuple[Parameter, ...]) -> Iterator[str]:
    """Yield what is doubtful about an inertia, and about what it leaves about the mass centre."""
    yield from _doubts("body inertia", body.inertia, parameters, lambda m: _possible(body, m))
    yield from _central_doubts(body, parameters)


def _doubts(
    label: str,
    inertia: Sextuple,
    parameters: tuple[Parameter, ...],
    possible: Callable[[Matrix], bool],
) -> Iterator[str]:
    """Yield a sentence on the first inertia that is not definite, and one on the first triangle."""
    used = [name for part in inertia for name in symbols(part)]
    points = (middle(parameters), *ends(parameters, used))
    tensors = [(values, tensor(inertia, values, label)) for values in points]
    indefinite = [values for values, matrix in tensors if not possible(matrix)]
    broken = [v for v, matrix in tensors if v not in indefinite and not triangle(matrix)]
    for values in indefinite[:1]:
        yield f"{label} is not positive definite{_where(values, inertia)}"
    for values in broken[:1]:
        yield f"{label} breaks the triangle inequality{_where(values, inertia)}"


def _central_doubts(body: Body, parameters: tuple[Parameter, ...]) -> Iterator[str]:
    """Yield a sentence on the first inertia about a point that leaves none about the centre."""
    if body.mass is None or body.centre is None:
        return
    formulas = (*body.inertia, body.mass, *body.centre)
    used = [name for part in formulas for name in symbols(part)]
    for values in (middle(parameters), *ends(parameters, used)):
        about = tensor(body.inertia, values, "body inertia")
        own = tensor(moved(body.inertia, -body.mass, body.centre), values, "body inertia")
        size = abs(_trace(about))
        masses = semidefinite(own, size) and semidefinite(_second_moments(own), size)
        if semidefinite(about, size) and triangle(about) and not masses:
            rule = "body inertia less that of its mass at body.centre is no masses'"
            yield f"{rule}{_where(values, formulas)}"
            return


def check_member(label: str, inertia: Entries, parameters: tuple[Parameter, ...]) -> None:
    """Refuse a machine's body with a negative moment about some axis, as far as it is known.

    A moment may vanish: rods and points are bodies of machines too.
    """
    values = middle(parameters)
    known = [part for part in inertia if part is not None]
    found = [None if part is None else value(part, values, f"{label} inertia") for part in inertia]
    possible = all(x is None or x >= 0 for x in found[:3])
    whole = _whole(inertia)
    if possible and whole is not None:
        possible = _not_negative(tensor(whole, values, f"{label} inertia"))
    if not possible:
        moments, products = (
            ", ".join("unknown" if x is None else f"{x:g}" for x in part)
            for part in (found[:3], found[3:])
        )
        raise SceneError(
            f"{label} inertia must be positive definite, not moments {moments} "
            f"with products {products}{_where(values, known)}"
        )


def _whole(inertia: Entries) -> Sextuple | None:
    """Return an inertia of which everything is known, None for any other."""
    return None if None in inertia else cast("Sextuple", inertia)


def member_doubts(label: str, inertia: Entries, parameters: tuple[Parameter, ...]) -> Iterator[str]:
    """Yield a sentence on the first inertia of a machine's body that is indefinite, or no masses'.

    Nothing is said of a wheel with its axial moment alone: its carrier counts the others.
    """
    whole = _whole(inertia)
    if whole is None or [part == ZERO for part in whole[:3]].count(True) == 2:
        return
    yield from _doubts(f"{label} inertia", whole, parameters, _not_negative)


def check_axis(wheel: Wheel, parameters: tuple[Parameter, ...]) -> None:
    """Refuse a wheel whose axis is zero or not of unit length at the middle of the ranges."""
    check_unit(wheel.axis, f"wheel '{wheel.name}': axis", middle(parameters))


def check_unit(vector: Triple, label: str, values: Mapping[str, float]) -> None:
    """Refuse a vector that is zero or not of unit length at these values."""
    found = math.hypot(*(value(part, values, label) for part in vector))
    if found == 0:
        raise SceneError(f"{label} is zero; it must be a unit vector")
    if abs(found - 1) > UNIT_LENGTH:
        where = _where(values, vector)
        raise SceneError(f"{label} must be a unit vector, not of length {found:.10g}{where}")


def inexact_axis(wheel: Wheel) -> bool:
    """Return whether an axis of numbers is a unit vector only nearly."""
    if any(part.operator != "number" for part in wheel.axis):
        return False
    x, y, z = wheel.axis
    return x * x + y * y + z * z != ONE


def check_carrier(body: Body, wheels: tuple[Wheel, ...], parameters: tuple[Parameter, ...]) -> None:
    """Refuse wheels that leave the carrier no inertia of its own about some axis."""
    if wheels and not definite(_without(body, wheels, middle(parameters))):
        raise SceneError("body inertia is that of the whole, but the wheels alone exceed it")


def carrier_doubts(
    body: Body, wheels: tuple[Wheel, ...], parameters: tuple[Parameter, ...]
) -> Iterator[str]:
    """Yield a sentence on the first end of the ranges where the wheels exceed the whole."""
    formulas = (*body.inertia, *(f for wheel in wheels for f in (*wheel.axis, wheel.axial)))
    used = [name for part in formulas for name in symbols(part)]
    for values in ends(parameters, used) if wheels else ():
        if not definite(_without(body, wheels, values)):
            where = _where(values, formulas)
            yield f"body inertia is that of the whole, but the wheels alone exceed it{where}"
            return


def _without(body: Body, wheels: tuple[Wheel, ...], values: Mapping[str, float]) -> Matrix:
    """Return the inertia of the carrier without the axial moments of its wheels."""
    matrix = tensor(body.inertia, values, "body inertia")
    for wheel in wheels:
        label = f"wheel '{wheel.name}'"
        axial = Fraction(value(wheel.axial, values, f"{label}: axial"))
        axis = [Fraction(value(part, values, f"{label}: axis")) for part in wheel.axis]
        matrix = tuple(
            tuple(matrix[i][j] - axial * axis[i] * axis[j] for j in range(3)) for i in range(3)
        )
    return matrix


def merging(middle_turn: Moving, angle: float) -> float | None:
    """Return ``angle`` plus a whole number of pi in the range of a middle turn; None without one.

    There the first and the third turn are about one line and merge: at 0 for axes as z, x, z,
    at a right angle for axes as z, y, x.
    """
    low, high = ((float(end) - angle) / math.pi for end in (middle_turn.low, middle_turn.high))
    return angle + math.ceil(low) * math.pi if math.floor(high) >= math.ceil(low) else None
