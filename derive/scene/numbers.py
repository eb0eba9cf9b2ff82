"""Numbers of a scene: whether masses, lengths and inertias are possible on the declared ranges.

Formulas are evaluated in floating point at the middle of the ranges and at their ends; nothing
computed here leaves the module but a sentence.
"""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import islice, product
from typing import TYPE_CHECKING

from derive.formula import FLOATS, ONE, Formula, evaluate, symbols
from derive.scene.declaration import SceneError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from derive.scene.declaration import Body, Coordinate, Parameter, Sextuple, Wheel

MOST_ENDS = 256
"""Enough for every combination of the ends of eight ranges."""
UNIT_LENGTH = 1e-9
"""How far the length of a wheel's axis may be from 1: nine digits typed by hand."""
ROUNDING = 1e-12
"""Slack of the triangle inequality, relative to the trace: a disc obeys it with equality."""

Matrix = tuple[tuple[Fraction, ...], ...]


def middle(parameters: Iterable[Parameter]) -> Mapping[str, float]:
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
        raise SceneError(f"{label} = '{formula}' has no value{_where(values, (formula,))}")
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
    shown = ", ".join(f"{name} = {values[name]:g}" for name in used)
    return f" at {shown}" if shown else ""


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
    trace = matrix[0][0] + matrix[1][1] + matrix[2][2]
    slack = abs(trace) * Fraction(ROUNDING)
    second = tuple(
        tuple((trace / 2 + slack if i == j else 0) - matrix[i][j] for j in range(3))
        for i in range(3)
    )
    pairs = ((0, 1), (0, 2), (1, 2))
    return (
        all(second[i][i] >= 0 for i in range(3))
        and all(second[i][i] * second[j][j] >= second[i][j] ** 2 for i, j in pairs)
        and _determinant(second) >= 0
    )


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
    """Yield a sentence on the first inertia on the ranges that no masses can have."""
    used = [name for part in body.inertia for name in symbols(part)]
    for values in (middle(parameters), *ends(parameters, used)):
        matrix = tensor(body.inertia, values, "body inertia")
        where = _where(values, body.inertia)
        if not _possible(body, matrix):
            yield f"body inertia is not positive definite{where}"
            return
        if not triangle(matrix):
            yield f"body inertia breaks the triangle inequality{where}"
            return


def check_axis(wheel: Wheel, parameters: tuple[Parameter, ...]) -> None:
    """Refuse a wheel whose axis is zero or not of unit length at the middle of the ranges."""
    label = f"wheel '{wheel.name}': axis"
    found = math.hypot(*(value(part, middle(parameters), label) for part in wheel.axis))
    if found == 0:
        raise SceneError(f"{label} is zero; it must be a unit vector")
    if abs(found - 1) > UNIT_LENGTH:
        where = _where(middle(parameters), wheel.axis)
        raise SceneError(f"{label} must be a unit vector, not of length {found:.10g}{where}")


def inexact_axis(wheel: Wheel) -> bool:
    """Return whether an axis of numbers is a unit vector only nearly."""
    if any(part.operator != "number" for part in wheel.axis):
        return False
    x, y, z = wheel.axis
    return x * x + y * y + z * z != ONE


def check_carrier(body: Body, wheels: tuple[Wheel, ...], parameters: tuple[Parameter, ...]) -> None:
    """Refuse wheels that leave the carrier no inertia of its own about some axis."""
    values = middle(parameters)
    matrix = tensor(body.inertia, values, "body inertia")
    for wheel in wheels:
        label = f"wheel '{wheel.name}'"
        axial = Fraction(value(wheel.axial, values, f"{label}: axial"))
        axis = [Fraction(value(part, values, f"{label}: axis")) for part in wheel.axis]
        matrix = tuple(
            tuple(matrix[i][j] - axial * axis[i] * axis[j] for j in range(3)) for i in range(3)
        )
    if wheels and not definite(matrix):
        raise SceneError("body inertia is that of the whole, but the wheels alone exceed it")


def merges(middle_turn: Coordinate, angle: float) -> bool:
    """Return whether the range of a middle turn holds ``angle`` plus a whole number of pi.

    There the first and the third turn are about one line and merge: at 0 for axes as z, x, z,
    at a right angle for axes as z, y, x.
    """
    low, high = ((float(end) - angle) / math.pi for end in (middle_turn.low, middle_turn.high))
    return math.floor(high) >= math.ceil(low)
