"""Small matrices of numbers: exact zeros and ones fold away, so sparse ones cost what they hold.

Those of quaternions are among them.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from derive.program.tape import Number, number

NumberRow = list[Number]
Matrix = list[NumberRow]


def zeros(rows: int, columns: int) -> Matrix:
    """Return a matrix of exact zeros."""
    return [[number(0)] * columns for _ in range(rows)]


def identity(size: int) -> Matrix:
    """Return the identity."""
    return [[number(int(i == k)) for k in range(size)] for i in range(size)]


def dot(a: Sequence[Number], b: Sequence[Number]) -> Number:
    """Return the sum of the products of two rows of numbers."""
    products = [x * y for x, y in zip(a, b, strict=True)]
    total = number(0)
    for p in products:
        total = total + p
    return total


def product(a: Matrix, b: Matrix) -> Matrix:
    """Return the product of two matrices."""
    columns = list(zip(*b, strict=True))
    return [[dot(row, column) for column in columns] for row in a]


def plus(a: Matrix, b: Matrix) -> Matrix:
    """Return the sum of two matrices."""
    return [[x + y for x, y in zip(p, q, strict=True)] for p, q in zip(a, b, strict=True)]


def minus(a: Matrix, b: Matrix) -> Matrix:
    """Return the difference of two matrices."""
    return [[x - y for x, y in zip(p, q, strict=True)] for p, q in zip(a, b, strict=True)]


def times(factor: Number | int | Fraction, a: Matrix) -> Matrix:
    """Return a matrix times a number."""
    return [[x * factor for x in row] for row in a]


def transposed(a: Matrix) -> Matrix:
    """Return the transpose."""
    return [list(column) for column in zip(*a, strict=True)]


def beside(*parts: Matrix) -> Matrix:
    """Return matrices side by side."""
    return [[x for row in rows for x in row] for rows in zip(*parts, strict=True)]


def sandwich_matrix(c: Sequence[Number], r: Sequence[Number]) -> Matrix:
    """Return the matrix (3, 3) of v -> Im(c v r)."""
    c0, (cx, cy, cz) = c[0], c[1:]
    r0, (rx, ry, rz) = r[0], r[1:]
    tx, ty, tz, t0 = cx * rx, cy * ry, cz * rz, c0 * r0
    first, less = t0 + tx, t0 - tx
    x, y, z = (r0 * u - c0 * v for u, v in zip(c[1:], r[1:], strict=True))
    xy, xz, yz = cx * ry + cy * rx, cx * rz + cz * rx, cy * rz + cz * ry
    return [
        [less + (ty + tz), -z - xy, y - xz],
        [z - xy, first - (ty - tz), -x - yz],
        [-y - xz, x - yz, first + (ty - tz)],
    ]


def right_matrix(p: Sequence[Number]) -> Matrix:
    """Return the matrix (4, 4) of q -> q p."""
    w, x, y, z = p
    return [[w, -x, -y, -z], [x, w, z, -y], [y, -z, w, x], [z, y, -x, w]]


def tangent_matrix(q: Sequence[Number]) -> Matrix:
    """Return the matrix (4, 3) of v -> q (0, v)."""
    w, x, y, z = q
    return [[-x, -y, -z], [w, -z, y], [z, w, -x], [-y, x, w]]


def lifted(q: Sequence[Number], place: slice, rows: Matrix) -> Matrix:
    """Return derivatives by three errors of the attitude q at ``place`` for those by its parts.

    An error delta stands for the attitude q exp(delta / 2): it is in rad, along body axes.
    """
    lift = times(Fraction(1, 2), tangent_matrix(q))
    return [
        [*row[: place.start], *product([row[place]], lift)[0], *row[place.stop :]] for row in rows
    ]
