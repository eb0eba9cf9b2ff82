"""Small matrices of numbers: exact zeros and ones fold away, so sparse ones cost what they hold."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from derive.program.tape import Number, number

Matrix = list[list[Number]]


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
